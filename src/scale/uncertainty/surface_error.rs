//! The surface's part in a photo's error, from the cloud itself.
//!
//! How far the points of the cloud lie from what the points around them predict (`surface::LeftOut`) is,
//! seen by the photo, a draw from the error of the depth at its pixels, where many photos saw it. What lies
//! between fragments where fewer than three photos look has no points, so the surface runs above it and scales are
//! too large: `unseen`.

use glam::{DMat3, DVec2, DVec3};

use crate::scale::field::ScaleField;
use crate::scale::pyramid::Pyramid;
use crate::surface::{Patch, Surface};

/// With fewer points nothing is known of a photo's surface.
pub(super) const LEAST_POINTS: usize = 30;

/// The root mean square of depth errors; `None` where they are too few.
pub(super) fn root_mean_square(depths: &[DepthError]) -> Option<f64> {
    let squares: f64 = depths.iter().map(|error| error.relative.powi(2)).sum();
    (depths.len() >= LEAST_POINTS).then(|| (squares / depths.len() as f64).sqrt())
}

/// The surface's error at one place of a photo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthError {
    /// In the image.
    pub(super) pixel: DVec2,
    /// The true depth over the predicted one, less 1: by so much scales are too large.
    pub(super) relative: f64,
    /// What the triangles at the point cover (over x and y) over its squared depth.
    pub(super) area: f64,
}

/// The plane that lies best through a photo's field, in camera axes: m·X = 1, so that the inverse of the
/// depth along (x, y, 1) is m·(x, y, 1). `None` where the field has too few points.
pub(super) fn plane_of(field: &ScaleField) -> Option<DVec3> {
    let mut normal = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for row in 0..field.grid.rows {
        for column in 0..field.grid.columns {
            let depth = field.depth_at(column, row);
            if let (Some(depth), Some(d)) = (depth, field.direction_at(column, row)) {
                normal += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
                right += d / depth;
            }
        }
    }
    let plane = normal.inverse() * right;
    (normal.determinant() > 0.0 && plane.is_finite()).then_some(plane)
}

/// At each of the points that the photo of a field shows.
pub(super) fn depth_errors(field: &ScaleField, plane: DVec3, surface: &Surface) -> Vec<DepthError> {
    let (camera, pose) = (field.camera(), field.pose());
    let center = surface.frame().local_from_world(pose.center);
    let seen = Pyramid::of_image(camera, center, pose.rotation);
    let camera_from_local = pose.rotation.transpose();
    let up = camera_from_local * DVec3::Z;
    let mut errors = Vec::new();
    // The field has triangulated what the photo sees, so nothing can fail here.
    let patches = surface.patches().seen(|bounds| seen.misses(bounds));
    let patches = patches.unwrap_or_default();
    for left_out in Patch::left_out(&patches) {
        let point = camera_from_local * (left_out.point - center);
        let pixel = field.image().pixel(camera, point);
        let Some(pixel) = pixel.filter(|&pixel| camera.contains(pixel)) else {
            continue;
        };
        // m·(X - h up) = 1: moved up by h, the plane's depth along a ray grows by the share h m·up.
        let relative = -left_out.above * plane.dot(up);
        // A point high above its neighbours may lie where they predict nothing: at the camera.
        let predicted = (1.0 + relative).max(0.1);
        errors.push(DepthError {
            pixel,
            relative: 1.0 / predicted - 1.0,
            area: left_out.star / (point.z * point.z),
        });
    }
    errors
}
