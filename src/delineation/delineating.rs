//! From a photo to its label image: an engine, the tree, the choice.

use std::collections::{BTreeMap, BTreeSet};

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

/// What fragments lost where pixels were left out.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LeftOut {
    /// How many of their pixels were left out.
    pub pixels: usize,
    /// Those of which more than half was, by number: they are no rock altogether.
    pub gone: BTreeSet<u32>,
}

/// What is left out is no rock, and with it all of a fragment of which more than half is: of a ball whose outline is a little too narrow
/// no rim is left, which would be measured as a fragment as wide as the ball.
pub fn leave_out(labels: &mut LabelImage, left_out: &[bool]) -> LeftOut {
    if !left_out.contains(&true) {
        return LeftOut::default();
    }
    let areas = labels.areas();
    let mut lost = vec![0_usize; areas.len()];
    for (label, _) in (labels.labels.iter().zip(left_out)).filter(|(_, is_left_out)| **is_left_out)
    {
        if let Some(lost) = lost.get_mut(*label as usize) {
            *lost += 1;
        }
    }
    // Fines are no fragment.
    let fragments = || (0_u32..).zip(lost.iter().zip(&areas)).skip(1);
    let gone = fragments().filter(|(_, (lost, area))| 2 * **lost > **area);
    let gone: BTreeSet<u32> = gone.map(|(number, _)| number).collect();
    let pixels = fragments().map(|(_, (lost, _))| lost).sum();
    for (label, is_left_out) in labels.labels.iter_mut().zip(left_out) {
        if *is_left_out || gone.contains(label) {
            *label = NOT_ROCK;
        }
    }
    LeftOut { pixels, gone }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the first of two fragments three of four pixels are left out, of the second one of three, and one of fines.
    #[test]
    fn no_rim_of_what_is_left_out_is_a_fragment() {
        let row = |labels: [u32; 9]| LabelImage {
            width: 9,
            height: 1,
            labels: labels.to_vec(),
        };
        let before = row([0, 1, 1, 1, 1, 2, 2, 2, NOT_ROCK]);
        let is_left_out = |place: usize| place == 0 || (2..=5).contains(&place) || place == 8;
        let left_out: Vec<bool> = (0..9).map(is_left_out).collect();
        let mut labels = before.clone();
        let lost = leave_out(&mut labels, &left_out);
        let out = NOT_ROCK;
        assert_eq!(labels, row([out, out, out, out, out, out, 2, 2, out]));
        assert_eq!((lost.pixels, lost.gone), (4, BTreeSet::from([1])));
        // Where nothing is left out all stays.
        for nothing in [&[][..], &[false; 9]] {
            let mut labels = before.clone();
            assert_eq!(leave_out(&mut labels, nothing), LeftOut::default());
            assert_eq!(labels, before);
        }
    }
}
