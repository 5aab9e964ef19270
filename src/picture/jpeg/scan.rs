//! The blocks of a scan, walked without being decoded (T.81, annexes F and G).

use super::codes::{Bits, Codes, Damage};

/// Numbers of a block.
const NUMBERS: usize = 64;

/// A component of the frame.
#[derive(Debug, Clone, Default)]
pub(super) struct Component {
    pub id: u8,
    pub across: u32,
    pub down: u32,
    /// Its quantisation table.
    pub table: usize,
    /// Blocks in a row and in a column that hold pixels.
    pub own: (u32, u32),
    /// Blocks in a row and in a column, those included that fill up the last MCU.
    pub padded: (u32, u32),
    /// Of each block, which of its numbers are not zero: a bit each, in zigzag order. Progressive
    /// frames alone have it.
    pub set: Vec<u64>,
    /// Of each number the lowest bit that was stored; `None` where nothing was.
    pub stored: Vec<Option<u8>>,
}

impl Component {
    /// Whether every number is there to its last bit.
    pub(super) fn is_whole(&self) -> bool {
        self.stored.iter().all(|low| *low == Some(0))
    }
}

/// A component in a scan.
pub(super) struct Part<'a> {
    /// In the frame.
    pub component: usize,
    pub dc: Option<&'a Codes>,
    pub ac: Option<&'a Codes>,
    /// How far a block's mean is from a step of it.
    pub step: i32,
}

/// What a scan holds.
pub(super) struct Scan<'a> {
    pub parts: Vec<Part<'a>>,
    pub progressive: bool,
    /// First and last number, in zigzag order.
    pub first: usize,
    pub last: usize,
    /// The bit that was stored before (0: none), and the lowest that is now.
    pub high: u8,
    pub low: u8,
    /// MCUs between restart markers; 0 where there are none.
    pub restart: u32,
    /// Of an interleaved scan.
    pub mcus: (u32, u32),
}

/// Where in the scan damage was found: MCUs before it, of all.
pub(super) type Place = (u64, u64);

impl Scan<'_> {
    /// Walks all blocks; `bits` is behind them then.
    pub(super) fn walk(
        &self,
        components: &mut [Component],
        bits: &mut Bits<'_>,
    ) -> Result<(), (Damage, Place)> {
        // A component alone is stored without the blocks that fill up MCUs.
        let alone = match &self.parts[..] {
            [part] => components.get(part.component).map(|c| c.own),
            _ => None,
        };
        let (across, down) = alone.unwrap_or(self.mcus);
        let all = u64::from(across) * u64::from(down);
        let mut state = State::default();
        for row in 0..down {
            for column in 0..across {
                let done = u64::from(row) * u64::from(across) + u64::from(column);
                let at_place = |damage| (damage, (done, all));
                if self.restart > 0 && done > 0 && done.is_multiple_of(self.restart.into()) {
                    let number = (done / u64::from(self.restart) - 1) % 8;
                    // Below 8.
                    bits.restart(number as u8).map_err(at_place)?;
                    state = State::default();
                }
                for (place, part) in self.parts.iter().enumerate() {
                    let Some(component) = components.get_mut(part.component) else {
                        continue;
                    };
                    let (h, v) = match alone {
                        Some(_) => (1, 1),
                        None => (component.across, component.down),
                    };
                    for y in row * v..row * v + v {
                        for x in column * h..column * h + h {
                            let index = y as usize * component.padded.0 as usize + x as usize;
                            let set = component.set.get_mut(index);
                            self.block(part, place, set, &mut state, bits)
                                .map_err(at_place)?;
                        }
                    }
                }
            }
        }
        if state.run > 0 {
            return Err((Damage::Leftover, (all, all)));
        }
        bits.finish().map_err(|damage| (damage, (all, all)))
    }

    fn block(
        &self,
        part: &Part<'_>,
        place: usize,
        set: Option<&mut u64>,
        state: &mut State,
        bits: &mut Bits<'_>,
    ) -> Result<(), Damage> {
        let Some(set) = set.filter(|_| self.progressive) else {
            self.mean(part, place, state, bits)?;
            return sequential(part, bits);
        };
        match (self.first, self.high) {
            (0, 0) => self.mean(part, place, state, bits),
            (0, _) => bits.bits(1).map(|_| ()),
            (_, 0) => self.numbers(part, set, state, bits),
            _ => self.refined(part, set, state, bits),
        }
    }

    /// The block's mean, as its difference to the block before.
    fn mean(
        &self,
        part: &Part<'_>,
        place: usize,
        state: &mut State,
        bits: &mut Bits<'_>,
    ) -> Result<(), Damage> {
        let size = bits.symbol(part.dc.ok_or(Damage::Code)?)?;
        if size > 11 {
            return Err(Damage::Code);
        }
        let mean = &mut state.means[place.min(3)];
        *mean += bits.signed(size)?;
        // Pixels are -128 to 127, so that eight times their mean is -1024 to 1016, give or take half
        // a step.
        if (*mean << self.low).saturating_mul(part.step).abs() > 1024 + part.step {
            return Err(Damage::Range);
        }
        Ok(())
    }

    /// A progressive block's numbers, their higher bits (T.81, G.1.2.2).
    fn numbers(
        &self,
        part: &Part<'_>,
        set: &mut u64,
        state: &mut State,
        bits: &mut Bits<'_>,
    ) -> Result<(), Damage> {
        if state.run > 0 {
            state.run -= 1;
            return Ok(());
        }
        let codes = part.ac.ok_or(Damage::Code)?;
        let mut at = self.first;
        while at <= self.last {
            let symbol = bits.symbol(codes)?;
            let (zeros, size) = (symbol >> 4, symbol & 15);
            match (zeros, size) {
                (15, 0) => at += 16,
                (_, 0) => {
                    state.run = (1 << zeros) + bits.bits(zeros)? - 1;
                    return Ok(());
                }
                _ => {
                    at += usize::from(zeros);
                    if at > self.last || size > 11 {
                        return Err(Damage::Block);
                    }
                    bits.bits(size)?;
                    *set |= 1 << at;
                    at += 1;
                }
            }
        }
        if at > self.last + 1 {
            return Err(Damage::Block);
        }
        Ok(())
    }

    /// One more bit of a progressive block's numbers (T.81, G.1.2.3).
    fn refined(
        &self,
        part: &Part<'_>,
        set: &mut u64,
        state: &mut State,
        bits: &mut Bits<'_>,
    ) -> Result<(), Damage> {
        let codes = part.ac.ok_or(Damage::Code)?;
        let before = *set;
        let is_set = |at: usize| before >> at & 1 == 1;
        let mut at = self.first;
        while state.run == 0 && at <= self.last {
            let symbol = bits.symbol(codes)?;
            let (mut zeros, size) = (symbol >> 4, symbol & 15);
            match (zeros, size) {
                (15, 0) | (_, 1) => {}
                (_, 0) => {
                    state.run = (1 << zeros) + bits.bits(zeros)?;
                    break;
                }
                _ => return Err(Damage::Code),
            }
            bits.bits(size)?;
            // Passes so many numbers that are zero; those that are not get a bit each.
            while at <= self.last {
                if is_set(at) {
                    bits.bits(1)?;
                } else if zeros == 0 {
                    break;
                } else {
                    zeros -= 1;
                }
                at += 1;
            }
            if at > self.last {
                // A run of 16 zeros may end the block, a new number cannot lie behind it.
                if size == 1 || zeros > 0 {
                    return Err(Damage::Block);
                }
                break;
            }
            if size == 1 {
                *set |= 1 << at;
            }
            at += 1;
        }
        if state.run > 0 {
            for at in at..=self.last {
                if is_set(at) {
                    bits.bits(1)?;
                }
            }
            state.run -= 1;
        }
        Ok(())
    }
}

/// The numbers behind the mean (T.81, F.2.2.2).
fn sequential(part: &Part<'_>, bits: &mut Bits<'_>) -> Result<(), Damage> {
    let codes = part.ac.ok_or(Damage::Code)?;
    let mut at = 1;
    while at < NUMBERS {
        let symbol = bits.symbol(codes)?;
        match (symbol >> 4, symbol & 15) {
            (0, 0) => return Ok(()),
            (15, 0) => at += 16,
            (_, 0 | 12..) => return Err(Damage::Code),
            (zeros, size) => {
                at += usize::from(zeros);
                if at >= NUMBERS {
                    return Err(Damage::Block);
                }
                bits.bits(size)?;
                at += 1;
            }
        }
    }
    if at > NUMBERS {
        return Err(Damage::Block);
    }
    Ok(())
}

/// What goes on from block to block, until a restart.
#[derive(Default)]
struct State {
    /// The last mean of each component.
    means: [i32; 4],
    /// Blocks that follow without numbers of their own.
    run: i32,
}
