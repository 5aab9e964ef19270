//! A photo as it is compared with those beside it: undistorted, small ([`crate::picture::for_comparing`]), gray.

use std::array::from_fn;

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
    /// See [`fours`].
    fours: Vec<[u8; 4]>,
}

/// Nothing is shown by one of four pixels: a pixel that shows something has at least a brightness of 1.
const NOTHING: [u8; 4] = [0; 4];

/// How many pixels of the small photo one of a camera's is wide.
pub(super) fn shrunk(camera: &Camera) -> f64 {
    let (width, _) = reduced_size(camera.width, camera.height, COMPARED);
    f64::from(width) / f64::from(camera.width.max(1))
}

impl SmallPhoto {
    /// Of a photo that is ready for comparing, and its camera.
    pub fn of(small: &RgbImage, camera: &Camera) -> Self {
        let (width, height) = small.dimensions();
        // ITU-R BT.601's luma; at least 1 of what is shown.
        let luma = small.pixels().map(|pixel| match pixel.0 {
            [0, 0, 0] => 0,
            [r, g, b] => {
                let luma = 299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b);
                (luma / 1000).clamp(1, 255) as u8
            }
        });
        let luma: Vec<u8> = luma.collect();
        Self {
            width,
            height,
            shrunk: shrunk(camera),
            fours: fours(&luma, width as usize),
            luma,
        }
    }

    /// Width and height, pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// The brightness of a pixel; `None` where it shows nothing.
    pub(super) fn pixel(&self, column: u32, row: u32) -> Option<f32> {
        let at = row as usize * self.width as usize + column as usize;
        let luma = self.luma.get(at).filter(|_| column < self.width)?;
        (*luma > 0).then(|| f32::from(*luma))
    }

    /// A pixel of the camera's image as a place in the small photo: multiplied by the first, less the second, as a pixel's centre is
    /// half a pixel in.
    pub(super) fn placed(&self) -> (f64, f64) {
        (self.shrunk, 0.5)
    }

    /// The brightness at [places](Self::placed), each between the four pixels around it; `None` where one of them lies beyond their
    /// centres, or beside a pixel that shows nothing.
    ///
    /// A sweep asks for this some million times: so what is the same for all places is done for all of them at once, step by step.
    pub(super) fn at<const N: usize>(&self, xs: &[f32; N], ys: &[f32; N]) -> Option<[f32; N]> {
        let last = |side: u32| side.saturating_sub(1) as f32;
        let (right, bottom) = (last(self.width), last(self.height));
        let is_inside = |x: f32, y: f32| (x >= 0.0) & (y >= 0.0) & (x < right) & (y < bottom);
        let inside: [bool; N] = from_fn(|at| is_inside(xs[at], ys[at]));
        if inside.contains(&false) {
            return None;
        }
        // Truncated on purpose: no photo is compared with so many pixels. Not by `fract`, which is a call where a processor's
        // rounding is not taken for granted.
        let width = self.width as usize;
        let (mut right, mut down, mut fours) = ([0.0; N], [0.0; N], [NOTHING; N]);
        for at in 0..N {
            let (column, row) = (xs[at] as u16, ys[at] as u16);
            right[at] = xs[at] - f32::from(column);
            down[at] = ys[at] - f32::from(row);
            fours[at] = self.fours[usize::from(row) * width + usize::from(column)];
        }
        if fours.contains(&NOTHING) {
            return None;
        }
        Some(from_fn(|at| {
            let [a, b, c, d] = fours[at].map(f32::from);
            let (above, below) = (a + (b - a) * right[at], c + (d - c) * right[at]);
            above + (below - above) * down[at]
        }))
    }
}

/// The brightness of each pixel, of that to its right, and of those below the two; [`NOTHING`] where one of them is not there or shows
/// nothing.
fn fours(luma: &[u8], width: usize) -> Vec<[u8; 4]> {
    let at = |place: usize| luma.get(place).copied().unwrap_or(0);
    let four = |place: usize| {
        let is_last = (place + 1).is_multiple_of(width.max(1));
        let four = [place, place + 1, place + width, place + width + 1].map(at);
        if is_last || four.contains(&0) {
            NOTHING
        } else {
            four
        }
    };
    (0..luma.len()).map(four).collect()
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
        // Pixels of the image; places count from the first pixel's centre.
        let at = |x: f32, y: f32| Some(photo.at(&[x - 0.5], &[y - 0.5])?[0]);
        assert_eq!(at(0.5, 0.5), Some(10.0));
        assert_eq!(at(0.75, 0.5), Some(12.5));
        assert_eq!(at(0.75, 1.0), Some((12.5 + 42.5) / 2.0));
        // Beside the black one, on the last row, beyond the first column.
        assert_eq!([at(1.75, 0.75), at(0.75, 1.5), at(0.25, 0.75)], [None; 3]);
        assert_eq!(at(f32::NAN, 1.0), None);
        assert_eq!(photo.placed(), (1.0, 0.5));
        // Reduced to half, the second pixel's centre of four lies at 1.5 of these, 0.75 of the small ones, a quarter behind the first's.
        let twice = Camera {
            width: 1024,
            height: 768,
            ..camera
        };
        let (shrunk, half) = SmallPhoto::of(&RgbImage::new(512, 384), &twice).placed();
        assert_eq!(1.5 * shrunk - half, 0.25);
    }
}
