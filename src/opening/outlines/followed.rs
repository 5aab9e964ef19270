//! Whether outlines follow the edges of the photo that they are said to be of.
//!
//! Where outlines lie a photo changes more than beside them: the mean strength of its edges under the outlines is compared with the
//! mean under the same outlines, moved. Of 55 photos of five sets outlined by people (belt, tunnel muck, blasted rock, a gravel bar,
//! pebbles) it was 12 % and more stronger; under the outlines of another photo of the set it was 6 % at most, and under a photo's own
//! ones turned or mirrored 7 % in 19 of 20.

use std::f64::consts::TAU;

use image::RgbImage;

use crate::labels::LabelImage;
use crate::picture::{brightness, reduced};

/// The longer side of the photo as it is looked at, pixels: drawn by hand, outlines lie a pixel of these beside the edges.
const LOOKED_AT: u32 = 512;

/// What a pixel's edge is compared with, pixels on each side: a shadow's are strong, and those of a burnt-out face weak.
const AROUND: usize = 20;

/// Added to what is around a pixel, of 255: noise of a plain sky is no edge.
const PLAIN: f64 = 4.0;

/// Outlines are moved so far for comparison, pixels: farther than they are drawn beside the edges, and not off the pile.
const MOVED: [f64; 4] = [8.0, 12.0, 17.0, 23.0];

/// Of so few pixels of outlines nothing is said.
const FEWEST: usize = 300;

/// Outlines that follow their photo's edges lie on edges that are stronger than those under moved ones by so many deviations of these
/// (of 55 photos 2.9 to 33; of wrong outlines at most 3.9), or by half as many and by this share: those of small photos do, and so do
/// wrong ones of a few stones, one of twenty, which are not told.
const STRONGER: f64 = 0.08;
const CLEAR: f64 = 4.0;

/// What is to be said of outlines that follow none of the photo's edges. Both are of the undistorted photo.
pub(super) fn not_followed(photo: &RgbImage, labels: &LabelImage) -> Option<String> {
    let photo = reduced(photo, LOOKED_AT);
    let edges = Strengths::of(&photo);
    let outlines = outlines(labels, photo.width(), photo.height());
    if outlines.len() < FEWEST {
        return None;
    }
    // Drawn by hand they lie a pixel beside the edges.
    let near = (-1..=1).flat_map(|y| (-1..=1).map(move |x| [x, y]));
    let here = near.filter_map(|by| edges.under(&outlines, by));
    let here = here.reduce(f64::max)?;
    let far = MOVED.iter().flat_map(|far| {
        let turned = move |eighth: u32| {
            let angle = TAU * (f64::from(eighth) / 8.0 + 0.03);
            [angle.cos(), angle.sin()].map(|of| (of * far).round() as i64)
        };
        (0..8).map(turned)
    });
    let far: Vec<f64> = far.filter_map(|by| edges.under(&outlines, by)).collect();
    let count = far.len() as f64;
    let mean = far.iter().sum::<f64>() / count;
    let deviation = (far.iter().map(|of| (of - mean).powi(2)).sum::<f64>() / count).sqrt();
    let clear = |deviations: f64| here > mean + deviations * deviation;
    let is_followed = clear(CLEAR) || clear(CLEAR / 2.0) && here > mean * (1.0 + STRONGER);
    (!is_followed).then(|| {
        "the outlines follow none of the photo's edges: look whether they are of this photo, and not turned, mirrored or moved".to_owned()
    })
}

/// The pixels beside which another label begins, of an image of that size.
fn outlines(labels: &LabelImage, width: u32, height: u32) -> Vec<[i64; 2]> {
    let along = |place: u32, side: u32, of: usize| {
        // The middle of the pixel.
        let place = (2 * place as usize + 1) * of / (2 * side as usize);
        place.min(of.saturating_sub(1))
    };
    let label = |x: u32, y: u32| {
        let row = along(y, height, labels.height) * labels.width;
        labels.labels.get(row + along(x, width, labels.width))
    };
    let mut outlines = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let own = label(x, y);
            let is_other = |x: u32, y: u32| x < width && y < height && label(x, y) != own;
            // Beyond the edge below it wraps to beyond the other.
            let before = |place: u32| place.wrapping_sub(1);
            if is_other(x + 1, y)
                || is_other(x, y + 1)
                || is_other(before(x), y)
                || is_other(x, before(y))
            {
                outlines.push([x.into(), y.into()]);
            }
        }
    }
    outlines
}

/// How strong the edge at each pixel is, beside those around it.
struct Strengths {
    width: i64,
    height: i64,
    strengths: Vec<f64>,
}

impl Strengths {
    fn of(photo: &RgbImage) -> Self {
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let luma: Vec<f64> = photo.pixels().map(|pixel| brightness(pixel.0)).collect();
        let slopes = slopes(&luma, width, height);
        let around = means_around(&slopes, width, height);
        let strengths = slopes
            .iter()
            .zip(around)
            .map(|(slope, around)| slope / (around + PLAIN));
        Self {
            width: photo.width().into(),
            height: photo.height().into(),
            strengths: strengths.collect(),
        }
    }

    /// The mean strength under outlines that are moved; `None` where hardly any lies on the photo.
    fn under(&self, outlines: &[[i64; 2]], by: [i64; 2]) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0);
        for [x, y] in outlines {
            let (x, y) = (x + by[0], y + by[1]);
            if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
                sum += self.strengths[(y * self.width + x) as usize];
                count += 1;
            }
        }
        (2 * count > outlines.len()).then(|| sum / f64::from(count as u32))
    }
}

/// Sobel's slopes, brightness a pixel times 8; the outermost pixels are those beside them.
fn slopes(luma: &[f64], width: usize, height: usize) -> Vec<f64> {
    let mut slopes = Vec::with_capacity(luma.len());
    for y in 0..height {
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
        for x in 0..width {
            let columns = [x.saturating_sub(1), x, (x + 1).min(width - 1)];
            let at = |column: usize, row: usize| luma[rows[row] * width + columns[column]];
            let across = |row: usize| at(2, row) - at(0, row);
            let down = |column: usize| at(column, 2) - at(column, 0);
            let (gx, gy) = (
                across(0) + 2.0 * across(1) + across(2),
                down(0) + 2.0 * down(1) + down(2),
            );
            slopes.push(gx.hypot(gy));
        }
    }
    slopes
}

/// The mean within [`AROUND`] pixels, as far as the image goes.
fn means_around(values: &[f64], width: usize, height: usize) -> Vec<f64> {
    // Sums of all above and to the left, a row and a column of zeros before them.
    let stride = width + 1;
    let mut sums = vec![0.0; stride * (height + 1)];
    for y in 0..height {
        let mut row = 0.0;
        for x in 0..width {
            row += values[y * width + x];
            sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
        }
    }
    let mut means = Vec::with_capacity(values.len());
    for y in 0..height {
        let (top, bottom) = (y.saturating_sub(AROUND), (y + AROUND + 1).min(height));
        for x in 0..width {
            let (left, right) = (x.saturating_sub(AROUND), (x + AROUND + 1).min(width));
            let at = |x: usize, y: usize| sums[y * stride + x];
            let sum = at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
            means.push(sum / ((right - left) * (bottom - top)) as f64);
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    /// Round stones, each of its own brightness with a grain, on dark ground; the outlines of the same stones, moved.
    fn stones(seed: u32, by: u32) -> (RgbImage, LabelImage) {
        let (width, height) = (512_u32, 384_u32);
        // Ellis' lowbias32: places and sizes that follow no pattern.
        let hash = |n: u32| {
            let n = (n ^ n >> 16).wrapping_mul(0x7feb_352d);
            let n = (n ^ n >> 15).wrapping_mul(0x846c_a68b);
            (n ^ n >> 16) % 10_000
        };
        let stone = |n: u32| {
            let of = |k: u32| hash(seed * 7919 + n * 31 + k);
            (of(1) % width, of(2) % height, 5 + of(3) % 9)
        };
        let stones: Vec<_> = (1..500).map(stone).collect();
        let number = |x: u32, y: u32| {
            let is_in = |(cx, cy, r): &(u32, u32, u32)| {
                x.abs_diff(*cx).pow(2) + y.abs_diff(*cy).pow(2) < r * r
            };
            stones.iter().position(is_in).map_or(0, |at| at as u32 + 1)
        };
        let photo = RgbImage::from_fn(width, height, |x, y| {
            let n = number(x, y);
            let grain = hash(x * 461 + y * 7577 + seed) % 24;
            let bright = if n == 0 { 30 } else { 80 + hash(n) % 120 };
            Rgb([(bright + grain) as u8; 3])
        });
        let labels = (0..width * height).map(|at| number(at % width + by, at / width));
        let labels = LabelImage {
            width: width as usize,
            height: height as usize,
            labels: labels.collect(),
        };
        (photo, labels)
    }

    #[test]
    fn outlines_of_another_photo_are_told() {
        let [(first, own), (second, other)] = [stones(1, 0), stones(2, 0)];
        assert_eq!(not_followed(&first, &own), None);
        assert_eq!(not_followed(&second, &other), None);
        assert!(not_followed(&first, &other).is_some());
        // Drawn a pixel beside the edges they are right, 40 pixels they are not.
        assert_eq!(not_followed(&first, &stones(1, 1).1), None);
        assert!(not_followed(&first, &stones(1, 40).1).is_some());
        // Turned.
        let turned = LabelImage {
            labels: own.labels.iter().rev().copied().collect(),
            ..own.clone()
        };
        assert!(not_followed(&first, &turned).is_some());
        // One small outline says nothing.
        let one = LabelImage {
            labels: own.labels.iter().map(|of| u32::from(*of == 1)).collect(),
            ..own
        };
        assert_eq!(not_followed(&second, &one), None);
    }

    /// Outlines of a photo that was reduced before, or of the whole of one that was not.
    #[test]
    fn their_size_may_be_another() {
        let (photo, labels) = stones(3, 0);
        let small = reduced(&photo, 200);
        assert_eq!(not_followed(&small, &labels), None);
        assert_eq!(not_followed(&RgbImage::new(4, 3), &labels), None);
    }
}
