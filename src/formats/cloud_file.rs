//! What a cloud reader hands over.

use glam::DVec3;

use crate::geometry::Bounds;
use crate::surface::Cloud;

/// A cloud as its file has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CloudFile {
    /// Points, colours, faces, in the file's own coordinates.
    pub cloud: Cloud,
    /// The coordinate system that the file states: "EPSG:n" or WKT.
    pub crs: Option<String>,
    /// Whether the file says that x and y are degrees: no surface can be made of them.
    pub geographic: bool,
    /// What the reader had to assume, one sentence each.
    pub warnings: Vec<String>,
}

impl CloudFile {
    /// Warns where coordinates that were stored as f32 are too large for the cloud's own extent:
    /// UTM northings in f32 are rounded to half a metre.
    pub(super) fn warn_if_rounded(&mut self) {
        let Some(bounds) = Bounds::of(&self.cloud.points) else {
            return;
        };
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let rounding = largest * f64::from(f32::EPSILON) / 2.0;
        if rounding > bounds.size().max_element() * 1e-5 {
            self.warnings.push(format!(
                "its coordinates are 32-bit floats of up to {largest:.0}, which rounds them to about {rounding:.2}; export doubles, or subtract an offset"
            ));
        }
    }
}

/// The index, from 0, of the first point with a coordinate that is not a finite number.
pub(super) fn first_not_finite(points: &[DVec3]) -> Option<usize> {
    points.iter().position(|point| !point.is_finite())
}
