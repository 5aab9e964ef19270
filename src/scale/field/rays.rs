//! What single rays of a photo meet: as the field does for grids.

use glam::{DVec2, DVec3};

use super::depths::{Stand, depths};
use super::samples::{Samples, ray};
use super::{FieldError, stand};
use crate::camera::Pose;
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::surface::Caster;

/// What a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::scale) struct RayHit {
    /// From the camera's centre, world units.
    pub(in crate::scale) distance: f64,
    /// In the world.
    pub(in crate::scale) point: DVec3,
    /// The longest edge of the triangle that is met, world units.
    pub(in crate::scale) longest_edge: f64,
}

/// Meets rays from a photo's centre with the surface of a caster; `directions` are unit vectors in camera
/// axes. Hundreds of them cost one look at each block of triangles that the photo sees, and no hierarchy.
///
/// # Errors
/// Where the surface cannot be triangulated, or the work was cancelled.
pub(in crate::scale) fn meet_rays(
    directions: &[Option<DVec3>],
    pose: &Pose,
    caster: &mut Caster<'_>,
    progress: &Progress,
) -> Result<Vec<Option<RayHit>>, FieldError> {
    let surface = caster.surface();
    let stand: Stand = stand(pose, surface);
    let on_plane = |direction: &Option<DVec3>| match direction {
        Some(direction) if direction.z > 0.0 => direction.truncate() / direction.z,
        _ => DVec2::NAN,
    };
    let points: Vec<DVec2> = directions.iter().map(on_plane).collect();
    let (samples, order) = Samples::scattered(&points);
    let met = depths(&samples, &stand, surface.patches(), true, progress)?;
    let mut hits = vec![None; directions.len()];
    let all = met.depths.iter().zip(&met.edges).zip(order);
    for ((&depth, &longest_edge), place) in all.filter(|((depth, _), _)| depth.is_finite()) {
        let way = ray(points[place]) * depth;
        hits[place] = Some(RayHit {
            distance: way.length(),
            point: pose.center + pose.rotation * way,
            longest_edge,
        });
    }
    // What a wide lens sees beside and behind itself is on no plane before it.
    for (hit, direction) in hits.iter_mut().zip(directions) {
        let Some(direction) = direction.filter(|direction| direction.z <= 0.0) else {
            continue;
        };
        let ray = Ray {
            origin: pose.center,
            direction: pose.rotation * direction,
        };
        *hit = caster.cast(&ray).map(|hit| RayHit {
            distance: hit.t,
            point: hit.point,
            longest_edge: hit.longest_edge,
        });
    }
    Ok(hits)
}
