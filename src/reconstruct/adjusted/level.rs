//! Which way is up in a model that nobody can place: a surface is triangulated as seen from above, so that a model on
//! its side has none. The gimbals say it where they are recorded (a hover, whose positions are all the same);
//! without them it is across the points, towards the cameras, as over every pile that a drone has flown over.

use cumulus3d_core::Reconstruction;
use cumulus3d_core::geometry::Sim3;
use glam::{DMat3, DVec3};

use super::Whose;
use super::conversions::{point, pose, to_rotation, to_vector};
use crate::georeference::{Pair, fit, levelled};

/// Turns a model so that z is up; it keeps its size.
pub(super) fn level(model: &mut Reconstruction, whose: &Whose<'_>) {
    let Some(turn) = by_gimbals(model, whose).or_else(|| across_points(model)) else {
        return;
    };
    model.transform(&Sim3::new(1.0, to_rotation(&turn), to_vector(DVec3::ZERO)));
}

/// From the gimbals' angles, whose errors are those of a compass: photos that contradict the others are left
/// out.
fn by_gimbals(model: &Reconstruction, whose: &Whose<'_>) -> Option<DMat3> {
    let mut pairs = Vec::new();
    for image in model.registered_images() {
        let gimbal = whose.photo(image).and_then(|photo| photo.gimbal);
        let (Some(gimbal), Some(found)) = (gimbal, model.world_to_cam(image)) else {
            continue;
        };
        let found = pose(&found).rotation;
        // A rotation is a similarity of the tips of its axes.
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for tip in [axis, -axis] {
                pairs.push(Pair {
                    source: found * tip,
                    target: gimbal * tip,
                    accuracy: None,
                });
            }
        }
    }
    fit(&pairs).ok().map(|fitted| fitted.similarity.rotation)
}

/// Across the points, towards the cameras.
fn across_points(model: &Reconstruction) -> Option<DMat3> {
    let points = model.points3d().map(|(_, seen)| point(&seen.xyz));
    let cameras = model.registered_images().into_iter();
    let cameras = cameras.filter_map(|image| model.projection_center(image));
    let cameras: Vec<DVec3> = cameras.map(|center| point(&center)).collect();
    levelled(points.collect(), &cameras)
}
