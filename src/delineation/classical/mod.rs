//! Borders without weights: edges and shadows at several scales, under an evened light.
//!
//! 1. Light: the logarithm of the photo less its own mean over a wide neighbourhood, over the deviation
//!    there; a slope in shade then counts as one in the sun.
//! 2. Edges: the gradient of the photo smoothed by about 1, 3 and 5 pixels, each times its scale, so that an edge
//!    counts the same at each; the most of them.
//! 3. Shadows: between fragments it is darker than on both sides. How much the photo lies below its closing
//!    (what it would be filled up to by a square), at two scales.
//!
//! Both are put over what they are at a wide share of pixels, so that a soft photo has borders, too.

use std::sync::LazyLock;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rayon::prelude::*;

use crate::choice::Scorer;
use crate::engine::{Engine, Habits};
use crate::evidence::{Evidence, gray};
use crate::smoothing::smoothed_floats;

static SCORER: LazyLock<Option<Scorer>> = LazyLock::new(|| {
    Scorer::read(include_str!(
        "../../../assets/delineation/score_classical.txt"
    ))
});

/// The engine that needs no weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Classical;

impl Engine for Classical {
    fn least_score(&self) -> f64 {
        0.1
    }

    fn habits(&self, _width: u32, _height: u32) -> Habits {
        Habits {
            sees_every: 1,
            // It joins fragments: its sizes are too large as it is (`develop masses`), and fewer fines would make
            // them larger still.
            fines_of_unfound: 1.0,
            sizes_off: 1.0,
            // P50 of simulated piles is 15 to 27 % too large.
            doubts: [0.2, 0.2],
        }
    }

    fn scorer(&self) -> Result<&Scorer, Fault> {
        Scorer::brought_along(SCORER.as_ref())
    }

    fn name(&self) -> &'static str {
        "classical"
    }

    fn look(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault> {
        let (width, height) = (photo.width() as usize, photo.height() as usize);
        let gray = gray(photo);
        let even = evened(&gray, width, height);
        progress.advance(1, 4)?;
        let edges = edges(&even, width, height);
        progress.advance(2, 4)?;
        let shadows = shadows(&even, width, height);
        progress.advance(3, 4)?;
        let border = edges.par_iter().zip(&shadows).map(|(edge, shadow)| {
            let both = 0.55 * edge + 0.6 * shadow;
            (255.0 * both.clamp(0.0, 1.0)) as u8
        });
        Ok(Evidence {
            width,
            height,
            border: border.collect(),
            rock: vec![255; width * height],
            middle: vec![0; width * height],
            gray,
            votes: None,
        })
    }
}

fn evened(gray: &[u8], width: usize, height: usize) -> Vec<f32> {
    let of_each: [f32; 256] = std::array::from_fn(|value| (value as f32 + 12.0).ln());
    let logarithm = gray.par_iter().map(|value| of_each[usize::from(*value)]);
    let logarithm: Vec<f32> = logarithm.collect();
    let radius = (width.max(height) / 24).clamp(8, 80);
    let mean = smoothed_floats(logarithm.clone(), width, height, radius);
    let squares = logarithm.par_iter().map(|value| value * value).collect();
    let squares = smoothed_floats(squares, width, height, radius);
    let parts = logarithm.par_iter().zip(&mean).zip(&squares);
    parts
        .map(|((value, mean), square)| {
            let deviation = (square - mean * mean).max(0.0).sqrt();
            (value - mean) / (deviation + 0.08)
        })
        .collect()
}

fn edges(even: &[f32], width: usize, height: usize) -> Vec<f32> {
    let mut most = vec![0.0f32; even.len()];
    let mut smooth = even.to_vec();
    for (radius, scale) in [(1, 1.2f32), (2, 2.2), (3, 3.6)] {
        smooth = smoothed_floats(smooth, width, height, radius);
        let from = &smooth;
        most.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            let above = &from[y.saturating_sub(1) * width..][..width];
            let below = &from[(y + 1).min(height - 1) * width..][..width];
            let here = &from[y * width..][..width];
            for (x, most) in row.iter_mut().enumerate() {
                let across = here[(x + 1).min(width - 1)] - here[x.saturating_sub(1)];
                let along = below[x] - above[x];
                *most = most.max(0.5 * scale * across.hypot(along));
            }
        });
    }
    over_wide_share(most)
}

fn shadows(even: &[f32], width: usize, height: usize) -> Vec<f32> {
    let smooth = smoothed_floats(even.to_vec(), width, height, 1);
    let mut most = vec![0.0f32; even.len()];
    for radius in [2, 5] {
        let closed = extreme(
            extreme(smooth.clone(), width, height, radius, f32::max),
            width,
            height,
            radius,
            f32::min,
        );
        let parts = most.par_iter_mut().zip(&closed).zip(&smooth);
        parts.for_each(|((most, closed), value)| *most = most.max(closed - value));
    }
    over_wide_share(most)
}

/// The extreme over a square of `2 * radius + 1`, along rows and then columns.
fn extreme(
    mut values: Vec<f32>,
    width: usize,
    height: usize,
    radius: usize,
    // A type of its own, so that loops have it within and take several pixels at once.
    of: impl Fn(f32, f32) -> f32 + Sync,
) -> Vec<f32> {
    values.par_chunks_mut(width).for_each_init(
        || vec![0.0; width],
        |line, row| {
            line.copy_from_slice(row);
            for by in 1..=radius.min(width - 1) {
                for (value, theirs) in row.iter_mut().zip(&line[by..]) {
                    *value = of(*value, *theirs);
                }
                for (value, theirs) in row[by..].iter_mut().zip(&*line) {
                    *value = of(*value, *theirs);
                }
            }
        },
    );
    let from = values.clone();
    values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(y, row)| {
            for other in y.saturating_sub(radius)..(y + radius + 1).min(height) {
                for (value, theirs) in row.iter_mut().zip(&from[other * width..][..width]) {
                    *value = of(*value, *theirs);
                }
            }
        });
    values
}

/// Values over what 95 of 100 pixels stay below.
fn over_wide_share(mut values: Vec<f32>) -> Vec<f32> {
    let mut some: Vec<f32> = values.iter().step_by(31).copied().collect();
    if some.is_empty() {
        return values;
    }
    let place = some.len() * 95 / 100;
    let (_, wide, _) = some.select_nth_unstable_by(place, f32::total_cmp);
    let wide = wide.max(1e-3);
    values.par_iter_mut().for_each(|value| *value /= wide);
    values
}
