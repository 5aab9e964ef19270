//! A frame near the data, so that UTM coordinates lose nothing in products and squares.
//!
//! The origin is a point of whole units. Subtracting a whole number from a coordinate of about its
//! size is exact in f64 (both are multiples of the coordinate's last bit, and the difference needs
//! no more bits), so going to the local frame loses no digit of the input.

use glam::DVec3;

use super::{Bounds, Ray};

/// A translation between the world and a frame near the data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalFrame {
    origin: DVec3,
}

impl LocalFrame {
    /// The frame with its origin at the whole-numbered point nearest to the middle of `bounds`.
    pub fn near(bounds: &Bounds) -> Self {
        Self {
            origin: bounds.center().round(),
        }
    }

    /// Its origin in the world.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// A world point in this frame.
    pub fn local_from_world(&self, point: DVec3) -> DVec3 {
        point - self.origin
    }

    /// A point of this frame in the world.
    pub fn world_from_local(&self, point: DVec3) -> DVec3 {
        point + self.origin
    }

    /// A world ray in this frame; distances along it stay the same.
    pub fn local_from_world_ray(&self, ray: &Ray) -> Ray {
        Ray {
            origin: self.local_from_world(ray.origin),
            direction: ray.direction,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utm_coordinates_survive_to_the_last_bit() {
        let points = [
            DVec3::new(500_000.123_456, 5_000_000.654_321, 161.000_001),
            DVec3::new(500_123.999_999, 4_999_876.000_001, -3.5),
        ];
        let frame = LocalFrame::near(&Bounds::of(&points).unwrap());
        for point in points {
            let local = frame.local_from_world(point);
            assert!(local.length() < 400.0);
            assert_eq!(frame.world_from_local(local), point);
        }
    }

    #[test]
    fn small_coordinates_are_left_alone() {
        let points = [DVec3::splat(-0.1), DVec3::splat(0.3)];
        let frame = LocalFrame::near(&Bounds::of(&points).unwrap());
        assert_eq!(frame.origin(), DVec3::ZERO);
    }
}
