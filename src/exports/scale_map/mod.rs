//! The scale of every pixel of a photo as a file: numbers for programs (TIFF), colours for people (PNG).
//!
//! ```text
//! description   what a page says of itself
//! tiff          the numbers
//! picture       the colours
//! ```

mod description;
mod picture;
mod tiff;

pub use self::picture::scale_map_png;
pub use self::tiff::scale_map_tiff;

use crate::scale::ScaleField;
use crate::units::LengthUnit;

/// A photo's scale field with what has to be said beside it.
#[derive(Debug, Clone, Copy)]
pub struct ScaleMap<'a> {
    /// Depth and scale at each pixel.
    pub field: &'a ScaleField,
    /// The flight's name.
    pub flight: &'a str,
    /// The photo's.
    pub photo: &'a str,
    /// Scales are in pixels per this.
    pub unit: LengthUnit,
    /// The unit of depths and coordinates.
    pub world_unit: LengthUnit,
    /// The coordinate system of the world: "EPSG:n" or WKT.
    pub crs: Option<&'a str>,
}

impl ScaleMap<'_> {
    /// What turns a scale of the field into one per [`Self::unit`].
    fn factor(&self) -> f64 {
        self.unit.in_units_of(self.world_unit)
    }
}

/// What a page of the TIFF holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapLayer {
    /// Pixels per unit.
    Scale,
    /// Along the optical axis, world units.
    Depth,
    /// World coordinate, less the origin.
    X,
    /// World coordinate, less the origin.
    Y,
    /// World coordinate, less the origin.
    Z,
}

impl MapLayer {
    /// As it is called in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scale => "scale",
            Self::Depth => "depth",
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }
}

#[cfg(test)]
mod tests;
