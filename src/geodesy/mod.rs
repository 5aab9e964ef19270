//! Places on the Earth, and the coordinate systems that name them.

mod geocentric;

pub use geocentric::{ecef_from_geographic, enu_axes, geographic_from_ecef};

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
