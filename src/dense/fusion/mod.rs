//! Depth maps -> points.

use glam::DVec3;

/// A fused cloud.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fused {
    /// Points.
    pub points: Vec<DVec3>,
}

/// x
pub fn fuse() {}
