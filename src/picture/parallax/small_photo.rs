//! A photo as it is compared with those beside it: undistorted, small ([`crate::picture::for_comparing`]), gray.

use glam::DVec2;
use image::RgbImage;

use crate::camera::Camera;
use crate::picture::agreement::COMPARED;
use crate::picture::reduced_size;

/// A photo without its lens and its colours.
#[derive(Debug, Clone)]
pub struct SmallPhoto {
    width: u32,
    height: u32,
    /// See [`shrunk`].
    shrunk: f64,
    /// Row by row, 0 where the photo shows nothing.
    luma: Vec<u8>,
}

/// How many pixels of the small photo one of a camera's is wide.
pub(super) fn shrunk(camera: &Camera) -> f64 {
    let (width, _) = reduced_size(camera.width, camera.height, COMPARED);
    f64::from(width) / f64::from(camera.width.max(1))
}

impl SmallPhoto {
    /// Of a photo that is ready for comparing, and its camera.
    pub fn of(small: &RgbImage, camera: &Camera) -> Self {
        let (width, height) = small.dimensions();
        Self {
            width,
            height,
            shrunk: shrunk(camera),
            // ITU-R BT.601's luma; at least 1 of what is shown.
            luma: small
                .pixels()
                .map(|pixel| match pixel.0 {
                    [0, 0, 0] => 0,
                    [r, g, b] => {
                        let luma = 299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b);
                        (luma / 1000).clamp(1, 255) as u8
                    }
                })
                .collect(),
        }
    }

    /// Width and height, pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The brightness of a pixel; `None` where it shows nothing.
    pub(super) fn pixel(&self, column: u32, row: u32) -> Option<f64> {
        let at = row as usize * self.width as usize + column as usize;
        let luma = self.luma.get(at).filter(|_| column < self.width)?;
        (*luma > 0).then(|| f64::from(*luma))
    }

    /// The brightness at a pixel of the camera's image, between the four pixels around it; `None` beyond their centres.
    pub(super) fn at(&self, pixel: DVec2) -> Option<f64> {
        // A pixel's centre is half a pixel in.
        let place = pixel * self.shrunk - 0.5;
        if !(place.x >= 0.0 && place.y >= 0.0) {
            return None;
        }
        // Truncated on purpose; what is too large is in no image.
        let (column, row) = (place.x as u32, place.y as u32);
        if column.checked_add(1)? >= self.width || row.checked_add(1)? >= self.height {
            return None;
        }
        let (x, y) = (place.x.fract(), place.y.fract());
        let above = self.pixel(column, row)? * (1.0 - x) + self.pixel(column + 1, row)? * x;
        let below = self.pixel(column, row + 1)? * (1.0 - x) + self.pixel(column + 1, row + 1)? * x;
        Some(above * (1.0 - y) + below * y)
    }
}
