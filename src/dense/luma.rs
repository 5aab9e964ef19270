//! Brightness alone, in whole grey levels, at sizes that halve from one to the next.
//!
//! Halving takes the mean of two by two pixels; pixel (u, v) of an image is (u/2, v/2) of the half one
//! exactly, odd sizes keep their last column and row, doubled.

use image::RgbImage;

/// Grey levels, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Luma {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) levels: Vec<u8>,
}

impl Luma {
    /// The brightness of ITU-R BT.601, rounded.
    pub(crate) fn of(photo: &RgbImage) -> Self {
        let levels = photo.pixels().map(|pixel| {
            let [red, green, blue] = pixel.0.map(u32::from);
            let sum = 299 * red + 587 * green + 114 * blue + 500;
            u8::try_from(sum / 1000).unwrap_or(u8::MAX)
        });
        Self {
            width: photo.width() as usize,
            height: photo.height() as usize,
            levels: levels.collect(),
        }
    }

    pub(crate) fn half(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut levels = Vec::with_capacity(width * height);
        for y in 0..height {
            let row = |y: usize| {
                let begin = y.min(self.height - 1) * self.width;
                &self.levels[begin..begin + self.width]
            };
            let (above, below) = (row(2 * y), row(2 * y + 1));
            for x in 0..width {
                let (left, right) = (2 * x, (2 * x + 1).min(self.width - 1));
                let four = [above[left], above[right], below[left], below[right]];
                let sum: u32 = four.into_iter().map(u32::from).sum();
                levels.push(u8::try_from((sum + 2) / 4).unwrap_or(u8::MAX));
            }
        }
        Self {
            width,
            height,
            levels,
        }
    }

    /// Each pixel with its right, lower and lower right neighbour, from the lowest byte up: one load
    /// brings all that lies between four pixel centres.
    pub(crate) fn fours(&self) -> Vec<u32> {
        let mut fours = Vec::with_capacity(self.levels.len());
        for y in 0..self.height {
            let row = |y: usize| {
                let begin = y.min(self.height - 1) * self.width;
                &self.levels[begin..begin + self.width]
            };
            let (above, below) = (row(y), row(y + 1));
            for x in 0..self.width {
                let right = (x + 1).min(self.width - 1);
                fours.push(u32::from_le_bytes([
                    above[x],
                    above[right],
                    below[x],
                    below[right],
                ]));
            }
        }
        fours
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_and_fours() {
        let luma = Luma {
            width: 3,
            height: 3,
            levels: vec![0, 10, 20, 30, 40, 50, 60, 70, 80],
        };
        let half = luma.half();
        assert_eq!((half.width, half.height), (2, 2));
        assert_eq!(half.levels, [20, 35, 65, 80]);
        let fours = luma.fours();
        assert_eq!(fours[0].to_le_bytes(), [0, 10, 30, 40]);
        assert_eq!(fours[8].to_le_bytes(), [80; 4]);
        let photo = RgbImage::from_pixel(1, 1, image::Rgb([255, 255, 255]));
        assert_eq!(Luma::of(&photo).levels, [255]);
    }
}
