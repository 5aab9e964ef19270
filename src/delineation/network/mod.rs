//! A photo seen by a network: part by part, in one size or several.
//!
//! A network has seen small pictures when it was trained, and needs memory by the area that it sees; so a photo goes
//! to it in overlapping parts, of which the margin is thrown away where the photo goes on. What a network makes of a
//! part is brought to the part's size, and what it makes of a smaller photo to the photo's.
//!
//! Networks are ONNX files, run by `rten`: no network of the internet, no other process.

mod enlarged;
mod input;
mod parts;

use std::borrow::Cow;
use std::panic::{AssertUnwindSafe, catch_unwind};

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use image::imageops::{FilterType, resize};
use rayon::prelude::*;
use rten::{Model, NodeId, Value, ValueOrView};

pub(crate) use enlarged::{enlarged, enlarged_part};
pub(crate) use input::{Channels, Input, Layout, Normal};
pub(crate) use parts::{Part, Parts};

/// The photo so many times smaller along a side.
pub(crate) fn at_size(photo: &RgbImage, by: f64) -> Cow<'_, RgbImage> {
    if by <= 1.0 {
        return Cow::Borrowed(photo);
    }
    let smaller = |side: u32| ((f64::from(side) / by) as u32).max(1);
    let [width, height] = [photo.width(), photo.height()].map(smaller);
    Cow::Owned(resize(photo, width, height, FilterType::Triangle))
}

/// Runs a network once. A panic of the library is an error, too: what a stranger's file makes it do nobody has tried.
///
/// # Errors
/// What it says, as words.
pub(crate) fn run(
    model: &Model,
    inputs: Vec<(NodeId, ValueOrView<'_>)>,
    outputs: &[NodeId],
) -> Result<Vec<Value>, String> {
    let run = || model.run(inputs, outputs, None);
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(Ok(values)) => Ok(values),
        Ok(Err(error)) => Err(error.to_string()),
        Err(_) => Err("one of its operators cannot take what it gets".to_owned()),
    }
}

/// The mean of what is seen in several sizes, kind by kind, each value at the photo's size. `see` gives the kinds of
/// one size, row by row.
///
/// # Errors
/// Those of `see`.
pub(crate) fn mean_of_sizes(
    photo: &RgbImage,
    sizes: &[f64],
    progress: &Progress,
    mut see: impl FnMut(&RgbImage, &Progress) -> Result<Vec<Vec<f32>>, Fault>,
) -> Result<Vec<Vec<f32>>, Fault> {
    let to = photo.dimensions();
    let mut sums: Vec<Vec<f32>> = Vec::new();
    // The largest size is nearly all of the work.
    for by in sizes {
        let sized = at_size(photo, *by);
        let seen = see(&sized, progress)?;
        let from = sized.dimensions();
        for (kind, seen) in seen.into_iter().enumerate() {
            let seen = enlarged(seen, from, to);
            match sums.get_mut(kind) {
                None => sums.push(seen),
                Some(sum) => {
                    let pairs = sum.par_iter_mut().zip(&seen);
                    pairs.for_each(|(sum, more)| *sum += more);
                }
            }
        }
    }
    let share = 1.0 / sizes.len().max(1) as f32;
    for sum in &mut sums {
        sum.par_iter_mut().for_each(|value| *value *= share);
    }
    Ok(sums)
}
