//! The place of a point as a site.

use glam::DVec3;

/// A point as a site: spade refuses coordinates under 2^-142 that are not 0; and -0 must equal 0.
pub(in crate::surface) fn site_place(point: DVec3) -> DVec3 {
    DVec3::new(
        spade_coordinate(point.x),
        spade_coordinate(point.y),
        point.z,
    )
}

fn spade_coordinate(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        x
    }
}
