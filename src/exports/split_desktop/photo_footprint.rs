//! One photo's footprint, as maps take it.

use crate::PhotoLine;

/// One photo's footprint.
pub(super) struct PhotoFootprint<'a> {
    pub line: PhotoLine<'a>,
    /// One ring, closed, counterclockwise seen from above; empty where there is none. Longitude and
    /// latitude, or x, y, z.
    pub ring: Vec<Vec<f64>>,
    /// Whether every point of the outline has a place.
    pub is_complete: bool,
    /// How many points of the outline are not on the surface.
    pub off_surface: usize,
}
