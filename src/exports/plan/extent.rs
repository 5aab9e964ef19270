//! What a plan holds: the surface without its outliers, what photos show near it, and the cameras near it.

use glam::DVec2;

use super::PlanPhoto;
use crate::geometry::Bounds;

/// How far beside the surface a footprint or camera may lie and still belong on the plan, in the
/// surface's larger side, and in the larger side of the footprint in the middle of all by size: whole footprints
/// of neighbours are on it. Rays near the horizon end far away, and a plan with them would show nothing else.
const FAR: f64 = 0.5;
const FAR_IN_FOOTPRINTS: f64 = 1.5;

/// What is left free around all of it, in its larger side.
const ROOM: f64 = 0.02;

pub(super) fn of(bulk: &Bounds, photos: &[PlanPhoto]) -> [DVec2; 2] {
    let (min, max) = (bulk.min.truncate(), bulk.max.truncate());
    let side = |photo: &PlanPhoto| {
        let points = || photo.outline.iter().copied();
        let (low, high) = (points().reduce(DVec2::min)?, points().reduce(DVec2::max)?);
        Some((high - low).max_element())
    };
    let mut sides: Vec<f64> = photos.iter().filter_map(side).collect();
    sides.sort_by(f64::total_cmp);
    let usual = sides.get(sides.len() / 2).copied().unwrap_or_default();
    // A photo that shows the horizon is large itself, and others of its flight may be so.
    let surface = (max - min).max_element();
    let far = surface * FAR + (usual * FAR_IN_FOOTPRINTS).min(surface * 2.0);
    let near = |point: &DVec2| point.cmpge(min - far).all() && point.cmple(max + far).all();
    let places = photos.iter().flat_map(|photo| {
        let marks = photo.middle.iter().chain([&photo.camera]);
        photo.outline.iter().chain(marks)
    });
    let all = places.copied().filter(near);
    let (min, max) = all.fold((min, max), |(min, max), place| {
        (min.min(place), max.max(place))
    });
    let room = (max - min).max_element() * ROOM;
    [min - room, max + room]
}
