//! The model brought to where the photos were taken, and adjusted once more with those places: so that it
//! neither bends nor loses its focal length over flat ground.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::geometry::Sim3;
use cumulus3d_core::{Reconstruction, Vec3};

use super::Whose;
use super::bundle::{Adjustment, adjust};
use super::conversions::{point, to_rotation, to_vector};
use super::level::level;
use crate::fault::Fault;
use crate::georeference::{Pair, fit};
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
    // On a line, too few, or contradicting each other: georeferencing says so of the result.
    let Ok(fitted) = fit(&pairs) else {
        level(model, whose);
        return Ok(());
    };
    let similarity = &fitted.similarity;
    model.transform(&Sim3::new(
        similarity.scale,
        to_rotation(&similarity.rotation),
        to_vector(similarity.translation),
    ));
    let used = images.iter().zip(&pairs).zip(&fitted.used);
    let places: HashMap<u32, (Vec3, f64)> = used
        .filter(|(_, used)| **used)
        .map(|((&image, pair), _)| {
            let deviation = pair.accuracy.unwrap_or(Pair::USUAL_OF_RECEIVERS);
            (image, (to_vector(pair.target), deviation))
        })
        .collect();
    for _ in 0..2 {
        progress.advance(0, 1)?;
        let adjustment = Adjustment {
            images: HashSet::new(),
            places: places.clone(),
            whose,
            iterations: 100,
        };
        adjust(model, adjustment, progress)?;
    }
    Ok(())
}
