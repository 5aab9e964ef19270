//! How a photo looks at the surface: what an engineer weighs before she trusts its scale.

use glam::DVec3;

use super::footprint::plane_through;
use super::{
    CornerOutcome, FieldError, Footprint, FootprintDetail, GroundFinder, ImageKind, PhotoScale,
};
use crate::camera::{Camera, Pose};
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::surface::Caster;

/// Facts about one photo's view. Lengths in world units, angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewFacts {
    /// Of the optical axis below the horizon; 90 looks straight down.
    pub tilt: f64,
    /// Of the camera centre above the surface plumb below it; above the ground where there is none.
    pub height: Option<f64>,
    /// Whether `height` is above the ground, because no surface is plumb below the camera.
    pub height_is_above_ground: bool,
    /// The smallest angle between a corner's ray and the plane of the corner points (that of
    /// [`Footprint::distance_from_corner_plane`]); small is a flat view. The plane and not the
    /// triangle that was met: that one is as steep as the one fragment that it belongs to.
    pub flattest_corner: Option<f64>,
    /// Of each corner in the contract's order: the longest edge of the triangle that its ray met.
    pub triangle_edges: [Option<f64>; 4],
    /// See [`Footprint::distance_from_corner_plane`].
    pub plane_distance: Option<f64>,
    /// The mean distance between neighbouring corner points, which lengths are compared to; `None`
    /// where a corner point is missing.
    pub footprint_size: Option<f64>,
    /// The outline on the surface, and a grid inside it.
    pub footprint: Footprint,
}

impl ViewFacts {
    /// Looks at a photo whose scale is known.
    ///
    /// # Errors
    /// Where no ground can be found although it is needed, or the work was cancelled.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        scale: &PhotoScale,
        ground: &mut GroundFinder<'_>,
        caster: &mut Caster<'_>,
        progress: &Progress,
    ) -> Result<Self, FieldError> {
        let axis = pose.rotation.z_axis;
        let below = caster.cast(&Ray {
            origin: pose.center,
            direction: DVec3::NEG_Z,
        });
        let (height, height_is_above_ground) = match below {
            Some(hit) => (Some(hit.t), false),
            None => (Some(pose.center.z - ground.under(camera, pose)?), true),
        };
        let footprint = Footprint::compute(
            camera,
            pose,
            image,
            FootprintDetail::default(),
            ground,
            caster,
            progress,
        )?;
        let corners: Vec<DVec3> = scale
            .corners
            .iter()
            .filter_map(super::Corner::point)
            .collect();
        let flattest_corner = plane_through(&corners).and_then(|(_, normal)| {
            scale
                .corners
                .iter()
                .filter(|corner| corner.point().is_some())
                .filter_map(|corner| corner.direction)
                .map(|direction| direction.dot(normal).abs().min(1.0).asin().to_degrees())
                .min_by(f64::total_cmp)
        });
        let triangle_edges = scale.corners.map(|corner| match corner.outcome {
            CornerOutcome::OnSurface { longest_edge, .. } => Some(longest_edge),
            CornerOutcome::OnGround { .. } | CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => {
                None
            }
        });
        let footprint_size = (corners.len() == 4).then(|| {
            (0..4)
                .map(|i| corners[i].distance(corners[(i + 1) % 4]))
                .sum::<f64>()
                / 4.0
        });
        Ok(Self {
            tilt: (-axis.z).clamp(-1.0, 1.0).asin().to_degrees(),
            height,
            height_is_above_ground,
            flattest_corner,
            triangle_edges,
            plane_distance: footprint.distance_from_corner_plane(scale),
            footprint_size,
            footprint,
        })
    }
}
