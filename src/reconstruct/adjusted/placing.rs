//! The model brought to where the photos were taken, and adjusted once more with those places: so that it
//! neither bends nor loses its focal length over flat ground.
//!
//! Places and lenses count as much as they are known beside where photos see points, which the model itself tells
//! (0.1 to 0.5 pixels): weighed against a pixel, whatever they are, scales hung ten times as much on the focal length that the
//! maker states as was said. How sure the outcome is, is stated more carefully: there not every point counts by itself
//! (`covariance`). Weighed likewise, an EXIF that was 15 % off moved the scales of twelve photos by 0.5 %, four times what it states.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::Reconstruction;
use cumulus3d_core::geometry::Sim3;
use glam::DVec3;

use super::Whose;
use super::bundle::{Adjustment, adjust};
use super::conversions::{point, pose, to_rotation, to_vector};
use super::level::level;
use super::own_lens::with_own_lenses;
use crate::fault::Fault;
use crate::georeference::{Pair, fit, is_turned_over};
use crate::jobs::Progress;
use crate::opening::covariance::deviation_of_pixels;

/// Metres that a receiver may be off whose contradiction is believed, one standard deviation.
const SURE: f64 = 0.3;

/// No matcher tells where a photo sees a point better, pixels.
const LEAST_PX: f64 = 0.02;

/// Brings the model to the photos' places; without three of them it is only turned upright.
///
/// # Errors
/// Where the adjustment has no solution, or the work was cancelled.
pub(super) fn place(
    model: &mut Reconstruction,
    whose: &Whose<'_>,
    progress: &Progress,
) -> Result<(), Fault> {
    progress.stage("placing the model in the world");
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
    let (mut places, mut contradicting) = (HashMap::new(), HashSet::new());
    if let Some(fitted) = &fitted {
        let similarity = &fitted.similarity;
        model.transform(&Sim3::new(
            similarity.scale,
            to_rotation(&similarity.rotation),
            to_vector(similarity.translation),
        ));
        for ((&image, pair), &used) in images.iter().zip(&pairs).zip(&fitted.used) {
            let deviation = pair.accuracy.unwrap_or(Pair::USUAL_OF_RECEIVERS);
            if used {
                places.insert(image, (to_vector(pair.target), deviation));
            } else if deviation <= SURE {
                contradicting.insert(image);
            }
        }
    }
    if !contradicting.is_empty() && whose.cameras().all(|(_, camera)| !camera.is_given) {
        *model = with_own_lenses(model, &contradicting)?;
    }
    let whose = &whose.again(model);
    for is_square in [false, false, true] {
        progress.advance(0, 1)?;
        let adjustment = Adjustment {
            images: HashSet::new(),
            places: places.clone(),
            whose,
            pixel: Some(pixel_deviation(model)),
            is_square,
            iterations: 100,
        };
        adjust(model, adjustment, progress)?;
    }
    if fitted.is_none() {
        level(model, whose);
    }
    Ok(())
}

/// The deviation of where photos see points. What nothing tells is a pixel; exact data of tests are what no matcher reaches.
fn pixel_deviation(model: &Reconstruction) -> f64 {
    let mut off = Vec::new();
    for (_, point) in model.points3d() {
        let seen = point.track.iter().filter_map(|seen| {
            let image = model.image(seen.image_id)?;
            let camera = model.camera(image.camera_id)?;
            let pose = model.world_to_cam(seen.image_id)?;
            let found = camera.cam_to_img(&pose.transform_point(&point.xyz))?;
            Some((found - image.point2d(seen.point2d_idx).xy).norm())
        });
        off.extend(seen.filter(|off| off.is_finite()));
    }
    let (photos, points) = (model.registered_image_count(), model.num_points3d());
    deviation_of_pixels(off.into_iter(), photos, points).map_or(1.0, |pixel| pixel.max(LEAST_PX))
}

#[cfg(test)]
mod tests;
