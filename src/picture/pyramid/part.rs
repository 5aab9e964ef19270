//! A rectangle of whole pixels.

use image::RgbImage;

/// A rectangle of whole pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Pixels left of it.
    pub x: u32,
    /// Pixels above it.
    pub y: u32,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
}

impl Part {
    /// What of it lies in a picture of this size.
    #[must_use]
    pub fn within(self, (width, height): (u32, u32)) -> Self {
        let (x, y) = (self.x.min(width), self.y.min(height));
        Self {
            x,
            y,
            width: self.width.min(width - x),
            height: self.height.min(height - y),
        }
    }

    /// The pixels of a picture that it lies in.
    pub(in crate::picture) fn of(self, picture: &RgbImage) -> RgbImage {
        let part = self.within(picture.dimensions());
        image::imageops::crop_imm(picture, part.x, part.y, part.width, part.height).to_image()
    }
}
