//! One piece of a cloud's file, and the sample of those that stand for the whole.

use glam::DVec3;

use crate::geometry::Bounds;
use crate::surface::CloudFacts;

/// One piece.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudPiece {
    /// How many points it has.
    pub count: u64,
    /// Where they lie, in the file's coordinates; `None` where only reading it tells.
    pub bounds: Option<Bounds>,
    pub(in crate::clouds) place: Place,
}

/// Where a piece is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::clouds) struct Place {
    /// The first byte in its file; of tiles their number.
    pub(in crate::clouds) start: u64,
    /// How many bytes; of tiles 0.
    pub(in crate::clouds) length: u64,
}

/// The sample of an octree's cloud: of its coarsest pieces, which stand for all of it.
pub(in crate::clouds) fn sample_of(points: &[DVec3]) -> Vec<DVec3> {
    let stride = CloudFacts::sample_stride(points.len() as u64);
    let stride = usize::try_from(stride).unwrap_or(usize::MAX);
    points.iter().step_by(stride).copied().collect()
}

/// With fewer points a sample does not stand for a cloud.
pub(in crate::clouds) const LEAST_SAMPLE: usize = 4096;
