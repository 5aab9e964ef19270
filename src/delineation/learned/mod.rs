//! Borders, and votes for fragments (`votes.rs`), by a small network, trained on simulated photos alone
//! (`training/train.py`; its log lies beside the weights in `assets/delineation`).
//!
//! It sees about a hundred pixels around each; so a photo is looked at in several sizes, the full one, a half
//! and a quarter, and each pixel takes the mean: what is a border from near and from afar is one, the texture of
//! a large block is one from near alone. Votes count more from where the fragment has the size that it knows best.
//! A photo of more than [`MOST_PIXELS`] is looked at from half its size down, because that takes a quarter of the time;
//! how small a fragment it then still shows is said.

use std::sync::LazyLock;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rayon::prelude::*;
use rten::Model;
use rten_tensor::prelude::*;
use rten_tensor::{NdTensor, NdTensorView};

use crate::choice::Scorer;
use crate::engine::{Engine, Habits};
use crate::evidence::{Evidence, gray};
use crate::network::{self, Channels, Input, Normal, Parts};
use crate::votes::{SIZE_OF_ONE, Votes};

/// The network halves its picture five times, and wants sides that can be; it knows nothing of what lies beyond the
/// part that it sees, so the margin is thrown away where the photo goes on.
const PARTS: Parts = Parts {
    part: [1152, 1152],
    margin: 64,
    step: 32,
    is_fixed: false,
};

const INPUT: Input = Input {
    layout: network::Layout::ChannelsFirst,
    channels: Channels::Rgb,
    white: 1.0,
    normal: Normal::OfPhoto,
    bytes: false,
};

/// How many times smaller the photo is looked at, while it stays larger than the least side.
const SIZES: [u32; 3] = [1, 2, 4];
const LEAST_SIDE: u32 = 96;

/// A photo of more pixels is looked at from half its size down.
const MOST_PIXELS: u64 = 5_000_000;

/// Border, rock, middle, size, right, down.
const KINDS: usize = 6;

/// The network knows fragments best that are so many pixels across, as a power of two (23), and how far from it its
/// votes still count: below, they are specks, above, it does not see their other side.
const BEST_SIZE: f32 = 4.5;
const SIZES_AROUND: f32 = 1.5;
/// Where it votes for such sizes in no size of the photo, all count alike.
const LEAST_WEIGHT: f32 = 0.02;

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

/// Of a large photo it looks at a smaller one.
fn sees_every(width: u32, height: u32) -> u32 {
    let mut by = 1;
    while u64::from(width / by) * u64::from(height / by) > MOST_PIXELS {
        by *= 2;
    }
    by
}

impl Engine for Learned {
    fn name(&self) -> &'static str {
        "learned"
    }

    fn least_score(&self) -> f64 {
        0.17
    }

    fn habits(&self, width: u32, height: u32) -> Habits {
        Habits {
            sees_every: sees_every(width, height),
            // 20.4 % of the mass passes the limit where 27.7 and 33.1 % of the area is left (`develop masses`, lab and
            // muckpile of seed 2001).
            fines_of_unfound: 0.67,
            // P50 and P80 of simulated flights are 0.6 % too small and 2.4 % too large (lab), 0.3 and 2.7 % too large
            // (muckpile), each within 1.3 % (standard deviation; `benches/fragments_seeds.py`, seeds 501 to 506).
            sizes_off: 1.01,
            // Simulated piles differ by 2 % each way behind that. On photos of the world, five kinds of rock that people
            // outlined, the median diameter by area is off by 8 % (root mean square; `develop score`), without the belt's,
            // where small stones lie that nobody outlined.
            doubts: [0.08, 0.15],
        }
    }

    fn scorer(&self) -> Result<&Scorer, Fault> {
        Scorer::brought_along(SCORER.as_ref())
    }

    fn look(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault> {
        let model = MODEL.as_ref().map_err(broken)?;
        let (width, height) = photo.dimensions();
        let first = sees_every(width, height);
        let sizes = SIZES
            .into_iter()
            .map(|by| by * first)
            .filter(|by| *by == first || (width / by >= LEAST_SIDE && height / by >= LEAST_SIDE));
        let sizes: Vec<f64> = sizes.map(f64::from).collect();
        let means = network::mean_of_sizes(photo, &sizes, progress, |smaller, progress| {
            let larger = (f64::from(width) / f64::from(smaller.width())).log2();
            Ok(weighed(seen(model, smaller, progress)?, larger as f32))
        })?;
        let means: [Vec<f32>; KINDS + 1] = means
            .try_into()
            .map_err(|_| broken("what it gives has another shape"))?;
        let [border, rock, middle, size, right, down, weight] = means;
        // Casts of floats end at the limits of their type.
        let byte = |value: f32| (value * 255.0).round() as u8;
        let [border, rock, middle] = [border, rock, middle]
            .map(|mean| -> Vec<u8> { mean.par_iter().map(|value| byte(*value)).collect() });
        let [size, right, down] = [size, right, down].map(|mean| -> Vec<u8> {
            let pairs = mean.par_iter().zip(&weight);
            pairs.map(|(sum, weight)| byte(sum / weight)).collect()
        });
        Ok(Evidence {
            width: width as usize,
            height: height as usize,
            border,
            rock,
            middle,
            gray: gray(photo),
            votes: Some(Votes { size, right, down }),
        })
    }
}

fn broken(error: impl std::fmt::Display) -> Fault {
    Fault::new(
        format!("the network cannot be run ({error})"),
        "report this",
    )
}

/// What is seen in a photo `larger` powers of two smaller, with its votes of the size in the photo itself; the votes times
/// their weights, and last the weights.
fn weighed(mut seen: Vec<Vec<f32>>, larger: f32) -> Vec<Vec<f32>> {
    let [_, _, _, size, right, down] = seen.as_mut_slice() else {
        return seen;
    };
    let mut weights = Vec::with_capacity(size.len());
    for ((size, right), down) in size.iter_mut().zip(right).zip(down) {
        let power = *size * SIZE_OF_ONE;
        let weight = (-((power - BEST_SIZE) / SIZES_AROUND).powi(2)).exp() + LEAST_WEIGHT;
        *size = weight * (power + larger) / SIZE_OF_ONE;
        *right *= weight;
        *down *= weight;
        weights.push(weight);
    }
    seen.push(weights);
    seen
}

/// What the network sees in a photo, part by part.
fn seen(model: &Model, photo: &RgbImage, progress: &Progress) -> Result<Vec<Vec<f32>>, Fault> {
    let (width, height) = (photo.width() as usize, photo.height() as usize);
    let mut found = vec![vec![0.0; width * height]; KINDS];
    let other_shape = || broken("what it takes or gives has another shape");
    let normals = INPUT.normals(photo);
    let (&input, &output) = model
        .input_ids()
        .first()
        .zip(model.output_ids().first())
        .ok_or_else(other_shape)?;
    let parts = PARTS.of(width, height);
    for (number, part) in parts.iter().enumerate() {
        progress.advance(number as u64, parts.len() as u64)?;
        let tensor = INPUT
            .tensor(photo, part, &normals)
            .ok_or_else(other_shape)?;
        let out = network::run(model, vec![(input, tensor.into())], &[output]).map_err(broken)?;
        let out = out.into_iter().next().ok_or_else(other_shape)?;
        let out: NdTensor<f32, 4> = out.try_into().map_err(|_| other_shape())?;
        if out.shape() != [1, KINDS, part.rows, part.columns] {
            return Err(other_shape());
        }
        let view: NdTensorView<'_, f32, 4> = out.view();
        for (kind, found) in found.iter_mut().enumerate() {
            for y in part.top..part.bottom {
                for x in part.left..part.right {
                    found[y * width + x] = view[[0, kind, y - part.above, x - part.first]];
                }
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONNXRUNTIME: [((usize, usize), [u8; KINDS]); 5] = [
        ((5, 7), [12, 254, 115, 155, 160, 131]),
        ((31, 20), [1, 255, 180, 153, 105, 111]),
        ((50, 40), [38, 251, 18, 147, 66, 162]),
        ((20, 30), [4, 255, 117, 154, 129, 88]),
        ((60, 3), [44, 56, 14, 152, 138, 125]),
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

    /// Against onnxruntime 1.32 on the same file: all that it says of some pixels.
    #[test]
    fn as_onnxruntime_has_it() {
        let seen = Learned
            .look(&pattern(64, 64), &Progress::default())
            .unwrap();
        for ((x, y), wanted) in ONNXRUNTIME {
            let place = y * 64 + x;
            let votes = seen.votes.as_ref().unwrap();
            let planes = [
                &seen.border,
                &seen.rock,
                &seen.middle,
                &votes.size,
                &votes.right,
                &votes.down,
            ];
            let found = planes.map(|plane| plane[place]);
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!(
                    found.abs_diff(wanted) <= 1,
                    "{x} {y}: {found}, not {wanted}"
                );
            }
        }
    }

    /// A fragment that is 45 pixels across in the photo is 23 in its half, where the network knows it best.
    #[test]
    fn votes_count_where_the_size_is_known_best() {
        let planes = |size: f32, right: f32| {
            vec![
                vec![0.5],
                vec![0.5],
                vec![0.5],
                vec![size],
                vec![right],
                vec![0.5],
            ]
        };
        let full = weighed(planes(0.55, 0.9), 0.0);
        let half = weighed(planes(0.45, 0.6), 1.0);
        let off = ((5.5_f32 - 4.5) / 1.5).powi(2);
        let [far, near] = [(-off).exp() + 0.02, 1.02];
        let sum = |kind: usize| full[kind][0] + half[kind][0];
        assert!((sum(KINDS) - far - near).abs() < 1e-5);
        // Both are of the same size in the photo, and the way is that of the nearer.
        assert!((sum(3) / sum(KINDS) - 0.55).abs() < 1e-5);
        let way = (far * 0.9 + near * 0.6) / (far + near);
        assert!((sum(4) / sum(KINDS) - way).abs() < 1e-5);
        assert_eq!(full[0], [0.5]);
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
