//! The watershed of a relief: Meyer's flooding (1991) from its minima, with a queue for each of 256 levels.

/// The basin of pixels that are left out.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// The basin of each pixel, from 0, and how many there are. `left_out` pixels belong to none.
///
/// Every regional minimum is a basin (pixels of one level that share sides, none beside them lower); water
/// rises from all of them at once, and a pixel belongs to the basin that reaches it first, the lowest way.
/// Of pixels that are reached at one level the nearer is first, so that plateaus are halved.
pub(crate) fn basins(
    width: usize,
    height: usize,
    relief: &[u8],
    left_out: &[bool],
) -> (Vec<u32>, usize) {
    let pixels = width * height;
    assert!(relief.len() == pixels && left_out.len() == pixels);
    let frame = Frame::new(width, height, relief, left_out);
    let mut basin = frame.basin.clone();
    let mut count = 0;
    let mut queues: Vec<Vec<u32>> = vec![Vec::new(); 256];
    frame.minima(|members| {
        for &pixel in members {
            basin[pixel as usize] = count;
        }
        for &pixel in members {
            let level = frame.relief[pixel as usize];
            let is_rim = |beside: usize| frame.relief[beside] > level;
            if frame.around(pixel).into_iter().any(is_rim) {
                queues[level as usize].push(pixel);
            }
        }
        count += 1;
    });
    for level in 0..256 {
        // What is pushed while a level is worked on comes behind it: first in, first out.
        let mut next = 0;
        let mut queue = std::mem::take(&mut queues[level]);
        while let Some(&pixel) = queue.get(next) {
            next += 1;
            let here = basin[pixel as usize];
            for beside in frame.around(pixel) {
                if basin[beside] == NOWHERE {
                    basin[beside] = here;
                    let its = frame.relief[beside] as usize;
                    if its <= level {
                        queue.push(beside as u32);
                    } else {
                        queues[its].push(beside as u32);
                    }
                }
            }
        }
    }
    let rows = basin.chunks_exact(frame.stride).skip(1).take(height);
    let of = |basin: &u32| match *basin {
        OUTSIDE => NOWHERE,
        basin => basin,
    };
    let all = rows.flat_map(|row| row[1..=width].iter().map(of));
    (all.collect(), count as usize)
}

/// The basin of pixels that no water reaches: left out, or beyond the image.
const OUTSIDE: u32 = u32::MAX - 1;

/// The relief with a pixel more at each side, so that every pixel of the image has four neighbours.
struct Frame {
    stride: usize,
    /// As high as can be outside of the image and where pixels are left out.
    relief: Vec<u8>,
    /// [`OUTSIDE`] there, else [`NOWHERE`] so far.
    basin: Vec<u32>,
}

impl Frame {
    fn new(width: usize, height: usize, relief: &[u8], left_out: &[bool]) -> Self {
        let stride = width + 2;
        let size = stride * (height + 2);
        let mut frame = Self {
            stride,
            relief: vec![u8::MAX; size],
            basin: vec![OUTSIDE; size],
        };
        for (pixel, (level, is_out)) in relief.iter().zip(left_out).enumerate() {
            if !is_out {
                let place = (pixel / width + 1) * stride + pixel % width + 1;
                frame.relief[place] = *level;
                frame.basin[place] = NOWHERE;
            }
        }
        frame
    }

    /// The four places that share a side with one.
    fn around(&self, place: u32) -> [usize; 4] {
        let place = place as usize;
        [
            place - self.stride,
            place - 1,
            place + 1,
            place + self.stride,
        ]
    }

    /// Calls `found` for each regional minimum with its places.
    fn minima(&self, mut found: impl FnMut(&[u32])) {
        let mut seen: Vec<bool> = self.basin.iter().map(|basin| *basin == OUTSIDE).collect();
        let mut members: Vec<u32> = Vec::new();
        for start in 0..seen.len() as u32 {
            if seen[start as usize] {
                continue;
            }
            let level = self.relief[start as usize];
            let is_lower = |beside: usize| self.relief[beside] < level;
            // Mostly something beside it is lower, and that is the end of it.
            if self.around(start).into_iter().any(is_lower) {
                continue;
            }
            members.clear();
            members.push(start);
            seen[start as usize] = true;
            let (mut next, mut is_minimum) = (0, true);
            while let Some(&place) = members.get(next) {
                next += 1;
                for beside in self.around(place) {
                    if self.relief[beside] < level {
                        is_minimum = false;
                    } else if self.relief[beside] == level && !seen[beside] {
                        seen[beside] = true;
                        members.push(beside as u32);
                    }
                }
            }
            if is_minimum {
                found(&members);
            }
        }
    }
}

/// The pixels that share a side with one.
pub(crate) fn around(width: usize, height: usize, pixel: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (pixel % width, pixel / width);
    let left = (x > 0).then(|| pixel - 1);
    let right = (x + 1 < width).then_some(pixel + 1);
    let above = (y > 0).then(|| pixel - width);
    let below = (y + 1 < height).then_some(pixel + width);
    [above, left, right, below].into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two valleys: the ridge between them belongs to the one that reaches it first, a plateau is halved.
    #[test]
    fn valleys_by_hand() {
        let relief = [1, 0, 2, 9, 3, 1, 1, 5];
        let (basin, count) = basins(8, 1, &relief, &[false; 8]);
        assert_eq!(count, 2);
        assert_eq!(basin[..3], [0, 0, 0]);
        assert_eq!(basin[4..], [1, 1, 1, 1]);
        let flat = [0, 5, 5, 5, 5, 0];
        let (basin, _) = basins(6, 1, &flat, &[false; 6]);
        assert_eq!(basin, [0, 0, 0, 1, 1, 1]);
        let left_out = [false, false, true, false, false, false];
        let (basin, _) = basins(6, 1, &flat, &left_out);
        assert_eq!(basin, [0, 0, NOWHERE, 1, 1, 1]);
    }

    /// Every basin hangs together, and has a minimum of its own that nothing lower of it surrounds.
    #[test]
    fn basins_of_noise() {
        let (width, height) = (61, 47);
        let mut random = fragscale_core::split_mix::SplitMix(5);
        let relief: Vec<u8> = (0..width * height)
            .map(|_| (random.next() % 7) as u8)
            .collect();
        let (basin, count) = basins(width, height, &relief, &vec![false; width * height]);
        assert!(count > 50);
        let mut seen = vec![false; width * height];
        let mut pieces = 0;
        for start in 0..width * height {
            assert!(basin[start] < count as u32);
            if seen[start] {
                continue;
            }
            pieces += 1;
            let mut open = vec![start];
            seen[start] = true;
            while let Some(pixel) = open.pop() {
                for beside in around(width, height, pixel) {
                    if !seen[beside] && basin[beside] == basin[start] {
                        seen[beside] = true;
                        open.push(beside);
                    }
                }
            }
        }
        assert_eq!(pieces, count);
    }
}
