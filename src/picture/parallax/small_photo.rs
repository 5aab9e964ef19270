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
        // A sweep asks for this a hundred million times. Not by `fract`, which is a call where a processor's rounding is not taken
        // for granted.
        let (x, y) = (place.x - f64::from(column), place.y - f64::from(row));
        let width = self.width as usize;
        let at = row as usize * width + column as usize;
        let above = self.luma.get(at..at + 2)?;
        let below = self.luma.get(at + width..at + width + 2)?;
        if above[0].min(above[1]).min(below[0]).min(below[1]) == 0 {
            return None;
        }
        let along = |two: &[u8]| f64::from(two[0]) * (1.0 - x) + f64::from(two[1]) * x;
        Some(along(above) * (1.0 - y) + along(below) * y)
    }
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;
    use crate::camera::Distortion;

    /// By hand: between four grays, and nothing where one of them shows nothing or lies beyond the edge.
    #[test]
    fn between_pixels_it_is_a_mix_of_four() {
        let camera = Camera {
            name: String::new(),
            width: 3,
            height: 2,
            fx: 3.0,
            fy: 3.0,
            cx: 1.5,
            cy: 1.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let grays = [[10, 20, 0], [30, 80, 50]];
        let image = RgbImage::from_fn(3, 2, |x, y| Rgb([grays[y as usize][x as usize]; 3]));
        let photo = SmallPhoto::of(&image, &camera);
        let at = |x: f64, y: f64| photo.at(DVec2::new(x, y));
        assert_eq!(at(0.5, 0.5), Some(10.0));
        assert_eq!(at(0.75, 0.5), Some(12.5));
        assert_eq!(at(0.75, 1.0), Some((12.5 + 42.5) / 2.0));
        // Beside the black one, on the last row, beyond the first column.
        assert_eq!([at(1.75, 0.75), at(0.75, 1.5), at(0.25, 0.75)], [None; 3]);
        assert_eq!(at(f64::NAN, 1.0), None);
    }
}
