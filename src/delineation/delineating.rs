//! From a photo to its label image: an engine, the tree, the choice.

use std::collections::BTreeMap;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use fragscale_core::labels::Outlines;
use fragscale_core::picture::edge_spread;
use image::RgbImage;

use crate::choice::{chosen, labelled, scores};
use crate::engine::Engine;
use crate::evidence::Evidence;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::regions::Regions;
use crate::tree::tree;

/// What an engine makes of a photo.
#[derive(Debug, Clone, PartialEq)]
pub struct Delineated {
    /// The fragments, and how sure each is.
    pub outlines: Outlines,
    /// All regions that might have been one.
    pub regions: Regions,
    /// How far the photo's edges are spread: see [`Habits::least_across`](crate::Habits::least_across).
    pub spread: Option<f64>,
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
    let outlined = engine.outline(photo, progress)?;
    let evidence = match &outlined {
        Some(outlined) => Evidence::of_outlines(&outlined.labels, photo),
        None => engine.look(photo, progress)?,
    };
    let tree = tree(&evidence, left_out, progress)?;
    let scores = scores(&tree, engine.scorer()?);
    let (mut labels, sure) = match outlined {
        Some(mut outlined) => {
            leave_out(&mut outlined.labels, left_out);
            (outlined.labels, outlined.sure)
        }
        None => {
            let taken = chosen(&tree, &scores, engine.least_score());
            let sure = taken.iter().map(|node| scores[*node as usize]);
            (labelled(&tree, &taken), sure.collect())
        }
    };
    let spread = edge_spread(photo);
    let habits = engine.habits(photo.width(), photo.height());
    let across = habits.least_across(spread);
    let least_area = std::f64::consts::PI / 4.0 * across * across;
    let numbers = without_small(&mut labels, least_area);
    let sure = numbers.iter().zip(sure);
    let sure: BTreeMap<u32, f64> = sure
        .filter_map(|(number, sure)| Some(((*number)?, sure)))
        .collect();
    Ok(Delineated {
        outlines: Outlines::new(labels, sure),
        regions: Regions::new(tree, scores, least_area),
        spread,
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

/// What is left out is no rock. How many pixels were fragments before.
pub fn leave_out(labels: &mut LabelImage, left_out: &[bool]) -> usize {
    let places = labels.labels.iter_mut().zip(left_out);
    let mut fragments = 0;
    for (label, _) in places.filter(|(_, is_left_out)| **is_left_out) {
        fragments += usize::from(*label != NOT_ROCK && *label != FINES);
        *label = NOT_ROCK;
    }
    fragments
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
