//! Half-lines.

use glam::DVec3;

/// A half-line. Positions along it are `origin + t * direction` with t > 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts; that point itself does not count as met.
    pub origin: DVec3,
    /// Where it goes; a unit vector where t shall be a distance.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }
}
