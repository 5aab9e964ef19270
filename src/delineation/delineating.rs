//! From a photo to its label image: an engine, the tree, the choice.

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;

use crate::choice::{chosen, labelled, scores};
use crate::engine::Engine;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::tree::tree;

/// Fragments narrower than this are fines: the diameter of the circle of as many pixels that the engine sees. An
/// outline is known to about a pixel, so that of ten is measured to a fifth.
const LEAST_PIXELS_ACROSS: f64 = 10.0;

/// Outlines the fragments of an undistorted photo. `left_out` says of each pixel whether it is no rock; empty
/// where nothing is left out.
///
/// # Errors
/// Where the engine cannot take the photo, or on cancel.
pub fn delineate(
    engine: &dyn Engine,
    photo: &RgbImage,
    left_out: &[bool],
    progress: &Progress,
) -> Result<LabelImage, Fault> {
    let evidence = engine.look(photo, progress)?;
    let tree = tree(&evidence, left_out, progress)?;
    let scores = scores(&tree, engine.scorer()?);
    let mut labels = labelled(&tree, &chosen(&tree, &scores, engine.least_score()));
    without_small(
        &mut labels,
        least_across(engine, photo.width(), photo.height()),
    );
    Ok(labels)
}

/// The narrowest fragment that an engine outlines in a photo of that size: the diameter of the circle of as many
/// pixels.
pub fn least_across(engine: &dyn Engine, width: u32, height: u32) -> f64 {
    LEAST_PIXELS_ACROSS * f64::from(engine.sees_every(width, height))
}

/// Small fragments become fines; the others are numbered anew.
fn without_small(labels: &mut LabelImage, across: f64) {
    let least = std::f64::consts::PI / 4.0 * across * across;
    let mut numbers = vec![FINES; labels.fragments() + 1];
    let mut next = 1;
    for (number, area) in numbers.iter_mut().zip(labels.areas()).skip(1) {
        if area as f64 >= least {
            *number = next;
            next += 1;
        }
    }
    for label in labels.labels.iter_mut().filter(|label| **label != NOT_ROCK) {
        *label = numbers[*label as usize];
    }
}
