//! The bits of a JPEG's compressed data, and its Huffman codes (T.81, annexes C and F).

/// What shows that compressed data are damaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Damage {
    /// A marker or the file's end stands where the data should go on.
    Early,
    /// Bits that are no code of their table, or a code without a meaning there.
    Code,
    /// More than 64 numbers in a block.
    Block,
    /// A block brighter or darker than any that an encoder makes.
    Range,
    /// Data behind the last block, or in front of a restart marker.
    Leftover,
    /// Another restart marker than the next.
    Restart,
}

impl Damage {
    /// In the words of an error.
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::Early => "its compressed data end too early",
            Self::Code => "its compressed data hold a code that does not exist",
            Self::Block => "a block has more than 64 numbers",
            Self::Range => "a block is brighter or darker than can be",
            Self::Leftover => "its compressed data go on behind the last block",
            Self::Restart => "a restart marker is missing",
        }
    }
}

/// A Huffman table: for each 16 bits the length of the code that they begin with (0: none) and its
/// symbol.
#[derive(Debug, Clone)]
pub(super) struct Codes(Vec<[u8; 2]>);

impl Codes {
    /// From how many codes of each length there are, 1 to 16 bits, and their symbols in that order.
    /// `None` where there are more than fit.
    pub(super) fn new(counts: &[u8; 16], symbols: &[u8]) -> Option<Self> {
        let mut all = Vec::with_capacity(1 << 16);
        let mut symbols = symbols.iter();
        for (length, &count) in (1_u8..).zip(counts) {
            for _ in 0..count {
                let symbol = *symbols.next()?;
                all.resize(all.len() + (1 << (16 - length)), [length, symbol]);
                if all.len() > 1 << 16 {
                    return None;
                }
            }
        }
        all.resize(1 << 16, [0, 0]);
        Some(Self(all))
    }
}

/// Compressed data from a scan's begin on.
pub(super) struct Bits<'a> {
    data: &'a [u8],
    at: usize,
    /// The next bits, the lowest `count` of it.
    buffer: u64,
    count: u32,
}

impl<'a> Bits<'a> {
    pub(super) fn new(data: &'a [u8], at: usize) -> Self {
        Self {
            data,
            at,
            buffer: 0,
            count: 0,
        }
    }

    /// Where the reading has come to: behind the data, once they are used up.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Takes bytes up to the next marker.
    fn fill(&mut self) {
        while self.count <= 56 {
            let byte = match self.data.get(self.at..) {
                Some([0xff, 0, ..]) => {
                    self.at += 2;
                    0xff
                }
                Some([0xff, ..] | []) | None => return,
                Some([byte, ..]) => {
                    self.at += 1;
                    *byte
                }
            };
            self.buffer = self.buffer << 8 | u64::from(byte);
            self.count += 8;
        }
    }

    /// The symbol of the next code.
    pub(super) fn symbol(&mut self, codes: &Codes) -> Result<u8, Damage> {
        if self.count < 16 {
            self.fill();
        }
        // Behind the end ones, which are the begin of no code.
        let next = match self.count {
            count @ 0..16 => (self.buffer << (16 - count)) | ((1 << (16 - count)) - 1),
            count => self.buffer >> (count - 16),
        };
        let [length, symbol] = codes.0[(next & 0xffff) as usize];
        if u32::from(length) > self.count {
            return Err(Damage::Early);
        }
        if length == 0 {
            return Err(if self.count < 16 {
                Damage::Early
            } else {
                Damage::Code
            });
        }
        self.count -= u32::from(length);
        Ok(symbol)
    }

    /// The next `count` bits, at most 16.
    pub(super) fn bits(&mut self, count: u8) -> Result<i32, Damage> {
        let count = u32::from(count.min(16));
        if self.count < count {
            self.fill();
        }
        if self.count < count {
            return Err(Damage::Early);
        }
        self.count -= count;
        Ok((self.buffer >> self.count) as i32 & ((1 << count) - 1))
    }

    /// A number of so many bits, of which the lower half is negative (T.81, F.12).
    pub(super) fn signed(&mut self, count: u8) -> Result<i32, Damage> {
        let value = self.bits(count)?;
        Ok(match count {
            0 => 0,
            _ if value < 1 << (count - 1) => value + 1 - (1 << count),
            _ => value,
        })
    }

    /// Goes to the marker that follows. In front of it only the rest of a byte may be left, all ones or
    /// all zeros (encoders differ), and whole bytes of either.
    pub(super) fn finish(&mut self) -> Result<(), Damage> {
        self.fill();
        let rest = self.count % 8;
        self.count -= rest;
        // Of 64 bits, which a shift by 64 would be of, none is a rest.
        let padding = self.buffer.checked_shr(self.count).unwrap_or(0) & ((1 << rest) - 1);
        if padding != 0 && padding != (1 << rest) - 1 {
            return Err(Damage::Leftover);
        }
        while self.count > 0 {
            self.count -= 8;
            if !matches!(self.buffer >> self.count & 0xff, 0 | 0xff) {
                return Err(Damage::Leftover);
            }
            self.fill();
        }
        Ok(())
    }

    /// Passes the restart marker of this number.
    pub(super) fn restart(&mut self, number: u8) -> Result<(), Damage> {
        self.finish()?;
        while let Some([0xff, 0xff, ..]) = self.data.get(self.at..) {
            self.at += 1;
        }
        match self.data.get(self.at..) {
            Some([0xff, marker, ..]) if *marker == 0xd0 + number % 8 => {
                self.at += 2;
                Ok(())
            }
            Some([0xff, 0xd0..=0xd7, ..]) => Err(Damage::Restart),
            _ => Err(Damage::Early),
        }
    }
}
