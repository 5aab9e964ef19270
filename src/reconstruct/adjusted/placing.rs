//! The model brought to where the photos were taken, and adjusted once more with those places: so that it
//! neither bends nor loses its focal length over flat ground.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::Reconstruction;
use cumulus3d_core::geometry::Sim3;
use glam::DVec3;

use super::Whose;
use super::bundle::{Adjustment, Weighed, adjust};
use super::conversions::{point, pose, to_rotation, to_vector};
use super::level::level;
use super::own_lens::{Trials, with_own_lenses};
use crate::fault::Fault;
use crate::georeference::{Pair, fit, is_turned_over};
use crate::jobs::Progress;

/// Brings the model to the photos' places; without three of them it is only turned upright.
///
/// # Errors
/// Where the adjustment has no solution, or the work was cancelled.
pub(super) fn place(
    model: &mut Reconstruction,
    whose: &Whose<'_>,
    progress: &Progress,
) -> Result<(), Fault> {
    let stage = "placing the model in the world";
    progress.stage(stage);
    progress.advance(0, 1)?;
    let mut images = Vec::new();
    let mut pairs = Vec::new();
    for image in model.registered_images() {
        let Some(place) = whose.photo(image).and_then(|photo| photo.place) else {
            continue;
        };
        let Some(center) = model.projection_center(image) else {
            continue;
        };
        // One number for all directions is what the adjustment takes.
        let deviation = place
            .deviation
            .map_or(Pair::USUAL_OF_RECEIVERS, Pair::accuracy_of);
        images.push(image);
        pairs.push(Pair {
            source: point(&center),
            target: place.center,
            accuracy: Some(deviation),
        });
    }
    // On a line, too few, contradicting each other or the gimbals: georeferencing says so of the result.
    let fitted = fit(&pairs).ok();
    let fitted = fitted.filter(|fitted| {
        let looks = images.iter().filter_map(|&image| {
            let found = pose(&model.world_to_cam(image)?).rotation * DVec3::Z;
            let gimbal = whose.photo(image)?.gimbal;
            let found = fitted.similarity.rotation * found;
            Some((found, gimbal.map(|gimbal| gimbal * DVec3::Z)))
        });
        !is_turned_over(looks)
    });
    let (mut places, mut in_trial) = (HashMap::new(), HashMap::new());
    if let Some(fitted) = &fitted {
        let similarity = &fitted.similarity;
        model.transform(&Sim3::new(
            similarity.scale,
            to_rotation(&similarity.rotation),
            to_vector(similarity.translation),
        ));
        for ((&image, pair), &used) in images.iter().zip(&pairs).zip(&fitted.used) {
            let deviation = pair.accuracy.unwrap_or(Pair::USUAL_OF_RECEIVERS);
            let place = (to_vector(pair.target), deviation);
            if used {
                places.insert(image, place);
            }
            // What contradicts one that is sure may be its photo's focal length.
            if used || deviation <= Pair::SURE_OF_RECEIVERS {
                in_trial.insert(image, place);
            }
        }
    }
    if whose.cameras().all(|(_, camera)| !camera.is_given) {
        progress.stage("comparing the photos' focal lengths");
        let trials = Trials {
            places: &in_trial,
            whose,
            progress,
        };
        let zoomed = match trials.of_another_length(model) {
            Err(fault) if progress.is_cancelled() => return Err(fault),
            // A trial without a solution says nothing of the model itself.
            found => found.unwrap_or_default(),
        };
        if !zoomed.is_empty() {
            *model = with_own_lenses(model, &zoomed)?;
        }
        progress.stage(stage);
    }
    let whose = &whose.again(model);
    let rounds = [
        Weighed::ItsPixels,
        Weighed::ItsPixels,
        Weighed::ItsBestSquarePixels,
    ];
    for (number, weighed) in (0..).zip(rounds) {
        progress.advance(number, 3)?;
        let adjustment = Adjustment {
            images: HashSet::new(),
            places: places.clone(),
            whose,
            weighed,
            iterations: 100,
        };
        adjust(model, adjustment, progress)?;
    }
    if fitted.is_none() {
        level(model, whose);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
