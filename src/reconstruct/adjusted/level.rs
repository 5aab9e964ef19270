//! Which way is up in a model that nobody can place: a surface is triangulated as seen from above, so that a model on
//! its side has none. The gimbals say it where they are recorded (a hover, whose positions are all the same);
//! without them it is across the points, towards the cameras, as over every pile that a drone has flown over.

use cumulus3d_core::Reconstruction;
use cumulus3d_core::geometry::{Mat3, Quat, Sim3};
use glam::{DMat3, DVec3};

use super::Whose;
use super::placing::{matrix, vector};
use crate::georeference::{Pair, fit};

/// Turns a model so that z is up; it keeps its size.
pub(super) fn level(model: &mut Reconstruction, whose: &Whose<'_>) {
    let Some(turn) = by_gimbals(model, whose).or_else(|| across_points(model)) else {
        return;
    };
    let turn = Quat::from_rotation_matrix(&matrix(&turn));
    model.transform(&Sim3::new(1.0, turn, vector(DVec3::ZERO)));
}

/// From the gimbals' angles, whose errors are those of a compass: photos that contradict the others are left
/// out.
fn by_gimbals(model: &Reconstruction, whose: &Whose<'_>) -> Option<DMat3> {
    let mut pairs = Vec::new();
    for image in model.registered_images() {
        let gimbal = whose.photo(image).and_then(|photo| photo.gimbal);
        let (Some(gimbal), Some(pose)) = (gimbal, model.world_to_cam(image)) else {
            continue;
        };
        let found = pose.rotation_matrix().transpose();
        let found = DMat3::from_cols_slice(found.as_slice());
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

/// The direction in which the points spread least, towards the cameras.
fn across_points(model: &Reconstruction) -> Option<DMat3> {
    let points: Vec<DVec3> = model
        .points3d()
        .map(|(_, point)| DVec3::from_array(point.xyz.into()))
        .collect();
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let mut spread = Mat3::zeros();
    for point in &points {
        let from = vector(point - middle);
        spread += from * from.transpose();
    }
    let cameras: DVec3 = model
        .registered_images()
        .into_iter()
        .filter_map(|image| model.projection_center(image))
        .map(|center| DVec3::from_array(center.into()) - middle)
        .sum();
    let axes = spread.symmetric_eigen();
    let least = axes.eigenvalues.imin();
    let up = DVec3::from_slice(axes.eigenvectors.column(least).as_slice());
    let up = up.try_normalize()? * if up.dot(cameras) < 0.0 { -1.0 } else { 1.0 };
    Some(DMat3::from_quat(glam::DQuat::from_rotation_arc(
        up,
        DVec3::Z,
    )))
}
