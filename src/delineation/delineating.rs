//! From a photo to its label image: an engine, the tree, the choice.

use std::collections::BTreeMap;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use fragscale_core::labels::Outlines;
use image::RgbImage;

use crate::choice::{chosen, labelled, scores};
use crate::engine::Engine;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::regions::Regions;
use crate::tree::tree;

/// Fragments narrower than this are fines: the diameter of the circle of as many pixels that the engine sees. An
/// outline is known to about a pixel, so that of ten is measured to a fifth.
const LEAST_PIXELS_ACROSS: f64 = 10.0;

/// What an engine makes of a photo.
#[derive(Debug, Clone, PartialEq)]
pub struct Delineated {
    /// The fragments, and how sure each is.
    pub outlines: Outlines,
    /// All regions that might have been one.
    pub regions: Regions,
}

/// Outlines the fragments of an undistorted photo. `left_out` says of each pixel whether it is no rock; empty
/// where nothing is left out.
///
/// # Errors
/// Where the engine cannot take the photo, or on cancel.
pub fn delineated(
    engine: &dyn Engine,
    photo: &RgbImage,
    left_out: &[bool],
    progress: &Progress,
) -> Result<Delineated, Fault> {
    let evidence = engine.look(photo, progress)?;
    let tree = tree(&evidence, left_out, progress)?;
    let scores = scores(&tree, engine.scorer()?);
    let taken = chosen(&tree, &scores, engine.least_score());
    let mut labels = labelled(&tree, &taken);
    let across = least_across(engine, photo.width(), photo.height());
    let least_area = std::f64::consts::PI / 4.0 * across * across;
    let numbers = without_small(&mut labels, least_area);
    let sure = taken.iter().zip(&numbers).filter_map(|(node, number)| {
        let score = scores.get(*node as usize)?;
        Some(((*number)?, *score))
    });
    let sure: BTreeMap<u32, f64> = sure.collect();
    Ok(Delineated {
        outlines: Outlines::new(labels, sure),
        regions: Regions::new(tree, scores, least_area),
    })
}

/// The label image alone, as [`delineated`] makes it.
///
/// # Errors
/// As there.
pub fn delineate(
    engine: &dyn Engine,
    photo: &RgbImage,
    left_out: &[bool],
    progress: &Progress,
) -> Result<LabelImage, Fault> {
    let found = delineated(engine, photo, left_out, progress)?;
    Ok(found.outlines.into_labels())
}

/// The narrowest fragment that an engine outlines in a photo of that size: the diameter of the circle of as many
/// pixels.
pub fn least_across(engine: &dyn Engine, width: u32, height: u32) -> f64 {
    LEAST_PIXELS_ACROSS * f64::from(engine.sees_every(width, height))
}

/// Small fragments become fines; the others are numbered anew. What number each has now, in the order of those
/// before.
fn without_small(labels: &mut LabelImage, least_area: f64) -> Vec<Option<u32>> {
    let mut next = 1;
    let numbers = labels.areas().into_iter().skip(1).map(|area| {
        (area as f64 >= least_area).then(|| {
            next += 1;
            next - 1
        })
    });
    let numbers: Vec<Option<u32>> = numbers.collect();
    let fragments = labels.labels.iter_mut();
    for label in fragments.filter(|label| **label != NOT_ROCK && **label != FINES) {
        *label = numbers[*label as usize - 1].unwrap_or(FINES);
    }
    numbers
}
