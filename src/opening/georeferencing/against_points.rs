//! Known distances that decide alone, held against the surveyed points beside them.

use glam::DVec3;

use super::list_world::ListWorld;
use super::marks::MarkedPoint;
use super::{GeoreferenceRequest, Known, KnownDistance, by_positions, distances};
use crate::control::ControlList;
use crate::fault::Fault;

/// What surveyed points say against known distances that decide instead, a sentence each; nothing where they give no world.
pub(super) fn against_points(
    known_distances: (&str, &[KnownDistance]),
    points: &ControlList,
    marked: &[MarkedPoint],
    request: &GeoreferenceRequest,
) -> Vec<String> {
    let by_points = || {
        let positions: Vec<DVec3> = points.points.iter().filter_map(|p| p.position).collect();
        let (asked, stated) = (request.crs.as_deref(), points.crs.as_deref());
        let world = ListWorld::new(asked, stated, &positions, &mut Vec::new())?;
        let mut known = Vec::new();
        for point in marked {
            known.extend(Known::of_point(point, &world)?);
        }
        let mut result = by_positions(&known, true)?;
        result.unit = world.unit();
        distances::compare(&mut result, known_distances, marked)?;
        Ok::<_, Fault>(result.warnings)
    };
    by_points().unwrap_or_default()
}
