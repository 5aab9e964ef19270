//! A parallel view of a box of the world.

use glam::{DVec2, DVec3};

use crate::geometry::Bounds;

/// Where it is seen from: degrees clockwise from north (from y), and above the horizon. From there the near corner of a
/// box is its south-western one, and neither side hides the other.
pub(super) const AZIMUTH: f64 = 205.0;
pub(super) const ELEVATION: f64 = 30.0;

/// Places of the world on a drawing, x to the right and y down.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    right: DVec3,
    up: DVec3,
    /// What is seen at `at`.
    middle: DVec3,
    at: DVec2,
    /// Units of the drawing to a unit of the world.
    scale: f64,
}

impl View {
    /// The largest view that shows a box within a rectangle of the drawing, in its middle.
    pub(super) fn of(bounds: &Bounds, [left, top]: [f64; 2], room: [f64; 2]) -> Self {
        let (azimuth, elevation) = (AZIMUTH.to_radians(), ELEVATION.to_radians());
        // Where the eye looks, level.
        let ahead = -DVec2::new(azimuth.sin(), azimuth.cos());
        let (sine, cosine) = elevation.sin_cos();
        let mut view = Self {
            right: DVec3::new(ahead.y, -ahead.x, 0.0),
            up: (ahead * sine).extend(cosine),
            middle: bounds.center(),
            at: DVec2::new(left, top) + DVec2::from(room) / 2.0,
            scale: 1.0,
        };
        let off = |corner: DVec3| (DVec2::from(view.place(corner)) - view.at).abs();
        let half = bounds
            .corners()
            .into_iter()
            .map(off)
            .fold(DVec2::ZERO, DVec2::max);
        let fit = (DVec2::from(room) / 2.0 / half).min_element();
        // A single place has no size.
        view.scale = if fit.is_finite() { fit } else { 1.0 };
        view
    }

    /// The place on the drawing of a point.
    pub(super) fn place(&self, point: DVec3) -> [f64; 2] {
        let off = (point - self.middle) * self.scale;
        [
            self.at.x + off.dot(self.right),
            self.at.y - off.dot(self.up),
        ]
    }

    /// The direction on the drawing of a direction of the world, and how long a unit of it is there.
    pub(super) fn along(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.right), -direction.dot(self.up))
    }
}
