//! Places on the Earth, and the coordinate systems that name them.
//!
//! Good to a metre or so against maps: datums that are fixed to a continent (ETRS89, NAD83, GDA) are
//! taken as WGS 84, older ones go through the seven parameters that EPSG's table of definitions or
//! the WKT gives, and systems that need a grid file are refused. Inside one system nothing is lost:
//! there and back agree to half a millimetre, and far
//! better without a shift of the datum.

mod crs;
mod definition;
mod geocentric;
mod geoid;
mod heights;
mod proj_text;
mod wkt;

pub use crs::{Crs, CrsKind};
pub use definition::stated_unit_metres;
pub use geocentric::{ecef_from_geographic, enu_axes, geographic_from_ecef};
pub use geoid::geoid_height;

/// Whether a text names a system at all: packages leave the text of a frame of their own empty.
pub fn is_stated(crs: &str) -> bool {
    crs.contains(|c: char| c.is_alphanumeric())
}

/// A place on WGS 84.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Geographic {
    /// Degrees east of Greenwich.
    pub longitude: f64,
    /// Degrees north of the equator.
    pub latitude: f64,
    /// Metres above the ellipsoid, unless its source says otherwise.
    pub height: f64,
}
