//! Borders by a small network, trained on simulated photos alone (`training/train.py`; its log lies beside the
//! weights in `assets/delineation`).
//!
//! It sees about a hundred pixels around each; so a photo is looked at in several sizes, the full one, a half
//! and a quarter, and each pixel takes the mean: what is a border from near and from afar is one, the texture of
//! a large block is one from near alone. A photo of more than [`MOST_PIXELS`] is looked at from half its size
//! down, because that takes a quarter of the time; how small a fragment it then still shows is said.

use std::sync::LazyLock;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use image::imageops::{FilterType, resize};
use rayon::prelude::*;
use rten::Model;
use rten_tensor::prelude::*;
use rten_tensor::{NdTensor, NdTensorView};

use crate::choice::Scorer;
use crate::classical::gray;
use crate::engine::Engine;
use crate::evidence::Evidence;

/// Side of the part that the network sees at once, pixels, and how much of it is thrown away where the photo goes
/// on, because the network knows nothing of that.
const PART: usize = 1152;
const MARGIN: usize = 48;

/// The network halves its picture so many times, and wants sides that can be.
const STEP: usize = 16;

/// How many times smaller the photo is looked at, while it stays larger than the least side.
const SIZES: [u32; 3] = [1, 2, 4];
const LEAST_SIDE: u32 = 96;

/// A photo of more pixels is looked at from half its size down.
const MOST_PIXELS: u64 = 5_000_000;

/// Border, rock, middle.
const KINDS: usize = 3;

static MODEL: LazyLock<Result<Model, String>> = LazyLock::new(|| {
    let bytes = include_bytes!("../../../assets/delineation/fragments.onnx");
    Model::load_static_slice(bytes).map_err(|error| error.to_string())
});

static SCORER: LazyLock<Option<Scorer>> = LazyLock::new(|| {
    Scorer::read(include_str!(
        "../../../assets/delineation/score_learned.txt"
    ))
});

/// The engine with the network that fragscale brings along.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Learned;

impl Engine for Learned {
    fn name(&self) -> &'static str {
        "learned"
    }

    fn least_score(&self) -> f64 {
        0.15
    }

    fn fines_of_unfound(&self) -> f64 {
        // 20.4 % of the mass passes the limit where 30.2 and 35.5 % of the area is left (`develop masses`, lab and
        // muckpile of seed 2001).
        0.62
    }

    fn doubts(&self) -> [f64; 2] {
        // P50 of simulated piles is 4 to 7 % too large with a share of fines that was measured on one of them.
        [0.07, 0.15]
    }

    fn scorer(&self) -> Result<&Scorer, Fault> {
        Scorer::brought_along(SCORER.as_ref())
    }

    fn sees_every(&self, width: u32, height: u32) -> u32 {
        let mut by = 1;
        while u64::from(width / by) * u64::from(height / by) > MOST_PIXELS {
            by *= 2;
        }
        by
    }

    fn look(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault> {
        let model = MODEL.as_ref().map_err(broken)?;
        let (width, height) = photo.dimensions();
        let first = self.sees_every(width, height);
        let sizes = SIZES
            .into_iter()
            .map(|by| by * first)
            .filter(|by| *by == first || (width / by >= LEAST_SIDE && height / by >= LEAST_SIDE));
        let sizes: Vec<u32> = sizes.collect();
        // The largest size is nearly all of the work.
        let mut sums: [Vec<f32>; KINDS] = Default::default();
        for by in &sizes {
            let small = match by {
                1 => None,
                by => Some(resize(photo, width / by, height / by, FilterType::Triangle)),
            };
            let seen = seen(model, small.as_ref().unwrap_or(photo), progress)?;
            let from = (width / by, height / by);
            for (sum, seen) in sums.iter_mut().zip(seen) {
                let seen = enlarged(&seen, from, (width, height));
                if sum.is_empty() {
                    *sum = seen;
                } else {
                    let pairs = sum.par_iter_mut().zip(&seen);
                    pairs.for_each(|(sum, more)| *sum += more);
                }
            }
        }
        let share = 255.0 / sizes.len() as f32;
        let [border, rock, middle] = sums.map(|sum| -> Vec<u8> {
            // Casts of floats end at the limits of their type.
            sum.par_iter()
                .map(|value| (value * share).round() as u8)
                .collect()
        });
        Ok(Evidence {
            width: width as usize,
            height: height as usize,
            border,
            rock,
            middle,
            gray: gray(photo),
        })
    }
}

fn broken(error: impl std::fmt::Display) -> Fault {
    Fault::new(
        format!("the network cannot be run ({error})"),
        "report this",
    )
}

/// What the network sees in a photo, part by part.
fn seen(model: &Model, photo: &RgbImage, progress: &Progress) -> Result<[Vec<f32>; KINDS], Fault> {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let mut found: [Vec<f32>; KINDS] = std::array::from_fn(|_| vec![0.0; width * height]);
    let (mean, deviation) = mean_and_deviation(photo);
    let inner = PART - 2 * MARGIN;
    let corners: Vec<(usize, usize)> = (0..height)
        .step_by(inner)
        .flat_map(|y| (0..width).step_by(inner).map(move |x| (x, y)))
        .collect();
    for (number, &(left, top)) in corners.iter().enumerate() {
        progress.advance(number as u64, corners.len() as u64)?;
        let (right, bottom) = ((left + inner).min(width), (top + inner).min(height));
        // Where the photo goes on, the part does.
        let (first, above) = (left.saturating_sub(MARGIN), top.saturating_sub(MARGIN));
        let columns = ((right + MARGIN).min(width) - first).next_multiple_of(STEP);
        let rows = ((bottom + MARGIN).min(height) - above).next_multiple_of(STEP);
        let mut input = NdTensor::zeros([1, 3, rows, columns]);
        for row in 0..rows {
            // Sides that cannot be halved so often go on with the photo's mirror.
            let y = mirrored(above + row, height);
            for column in 0..columns {
                let x = mirrored(first + column, width);
                let pixel = photo.get_pixel(x as u32, y as u32).0;
                for (channel, part) in pixel.into_iter().enumerate() {
                    input[[0, channel, row, column]] = (f32::from(part) / 255.0 - mean) / deviation;
                }
            }
        }
        let out = model.run_one(input.view().into(), None).map_err(broken)?;
        let out: NdTensor<f32, 4> = out
            .try_into()
            .map_err(|_| broken("what it gives has another shape"))?;
        if out.shape() != [1, KINDS, rows, columns] {
            return Err(broken("what it gives has another shape"));
        }
        let view: NdTensorView<'_, f32, 4> = out.view();
        for (kind, found) in found.iter_mut().enumerate() {
            for y in top..bottom {
                for x in left..right {
                    found[y * width + x] = view[[0, kind, y - above, x - first]];
                }
            }
        }
    }
    Ok(found)
}

/// A place that lies on the photo, by reflection at its far edge.
fn mirrored(place: usize, size: usize) -> usize {
    let last = size.saturating_sub(1);
    if place <= last {
        place
    } else {
        (2 * last).saturating_sub(place)
    }
}

/// Over all pixels and channels, of 0 to 1.
fn mean_and_deviation(photo: &RgbImage) -> (f32, f32) {
    let (mut sum, mut squares) = (0u64, 0u64);
    for part in photo.as_raw() {
        let part = u64::from(*part);
        sum += part;
        squares += part * part;
    }
    let count = photo.as_raw().len().max(1) as f64;
    let mean = sum as f64 / count / 255.0;
    let variance = squares as f64 / count / 255.0 / 255.0 - mean * mean;
    (mean as f32, variance.max(0.0).sqrt() as f32 + 1e-3)
}

/// Values of a smaller photo at the size of the larger, linear between the middles of pixels.
fn enlarged(
    values: &[f32],
    (width, height): (u32, u32),
    (to_width, to_height): (u32, u32),
) -> Vec<f32> {
    if (width, height) == (to_width, to_height) {
        return values.to_vec();
    }
    let (columns, rows) = (width as usize, height as usize);
    let place = |to: usize, size: usize, to_size: u32| {
        let at = (to as f32 + 0.5) * size as f32 / to_size as f32 - 0.5;
        let at = at.clamp(0.0, (size - 1) as f32);
        let first = at as usize;
        (first, (first + 1).min(size - 1), at - first as f32)
    };
    let across: Vec<_> = (0..to_width as usize)
        .map(|x| place(x, columns, to_width))
        .collect();
    let mut large = vec![0.0; to_width as usize * to_height as usize];
    large
        .par_chunks_mut(to_width as usize)
        .enumerate()
        .for_each(|(y, row)| {
            let (above, below, down) = place(y, rows, to_height);
            let (above, below) = (&values[above * columns..], &values[below * columns..]);
            for (value, &(left, right, along)) in row.iter_mut().zip(&across) {
                let mix = |line: &[f32]| line[left] + (line[right] - line[left]) * along;
                let (one, other) = (mix(above), mix(below));
                *value = one + (other - one) * down;
            }
        });
    large
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONNXRUNTIME: [((usize, usize), [u8; 3]); 5] = [
        ((5, 7), [48, 215, 53]),
        ((31, 20), [1, 254, 206]),
        ((50, 40), [52, 97, 39]),
        ((20, 30), [2, 254, 67]),
        ((60, 3), [51, 219, 61]),
    ];

    fn pattern(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            image::Rgb([
                (x * 5 % 256) as u8,
                (y * 7 % 256) as u8,
                ((x + y) * 3 % 256) as u8,
            ])
        })
    }

    /// Against onnxruntime 1.32 on the same file: border, rock and middle of some pixels.
    #[test]
    fn as_onnxruntime_has_it() {
        let seen = Learned
            .look(&pattern(64, 48), &Progress::default())
            .unwrap();
        for ((x, y), wanted) in ONNXRUNTIME {
            let place = y * 64 + x;
            let found = [seen.border[place], seen.rock[place], seen.middle[place]];
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!(
                    found.abs_diff(wanted) <= 1,
                    "{x} {y}: {found}, not {wanted}"
                );
            }
        }
    }

    /// A photo of several parts is seen as in one: what a part does not know of is thrown away.
    #[test]
    fn parts_meet() {
        let photo = pattern(1300, 64);
        let whole = Learned.look(&photo, &Progress::default()).unwrap();
        let left = image::imageops::crop_imm(&photo, 0, 0, 900, 64).to_image();
        let left = Learned.look(&left, &Progress::default()).unwrap();
        // Their means differ by little, so what is seen does.
        let off = (0..64 * 800).map(|place| {
            let (x, y) = (place % 800, place / 800);
            whole.border[y * 1300 + x].abs_diff(left.border[y * 900 + x])
        });
        let off: Vec<u8> = off.collect();
        let mean = off.iter().map(|off| f64::from(*off)).sum::<f64>() / off.len() as f64;
        assert!(mean < 4.0, "{mean}");
    }

    #[test]
    fn a_pixel_and_nothing() {
        for (width, height) in [(1, 1), (3, 200), (17, 5)] {
            let seen = Learned
                .look(&pattern(width, height), &Progress::default())
                .unwrap();
            assert_eq!(seen.border.len(), (width * height) as usize);
        }
    }
}
