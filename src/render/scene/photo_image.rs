//! Reduced photos, made ready for the graphics card.

use image::RgbaImage;
use image::imageops::{FilterType, resize};

/// Edge of a reduced photo in texels. All photos share it, so that they share textures; the shape
/// comes back when they are drawn.
pub(crate) const EDGE: u32 = 256;
/// Halvings that are kept for far-away photos: 256 to 8.
pub(crate) const LEVELS: u32 = 6;

/// A reduced, undistorted photo made ready: itself and its halvings. Made on a worker thread.
#[derive(Debug, Clone)]
pub struct PhotoImage {
    pub(crate) levels: Vec<RgbaImage>,
}

impl PhotoImage {
    /// From an undistorted photo of any size; one of about 256 pixels is quickest.
    pub fn new(photo: &RgbaImage) -> Self {
        let mut levels = Vec::with_capacity(LEVELS as usize);
        levels.push(resize(photo, EDGE, EDGE, FilterType::Triangle));
        for level in 1..LEVELS {
            let edge = EDGE >> level;
            let halved = match levels.last() {
                Some(larger) => resize(larger, edge, edge, FilterType::Triangle),
                None => break,
            };
            levels.push(halved);
        }
        Self { levels }
    }
}
