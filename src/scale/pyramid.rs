//! The part of space that an image shows: in front of the camera, between four planes through its
//! centre. What lies wholly outside of one of them needs no closer look.

use glam::{DMat3, DVec2, DVec3};

use crate::camera::Camera;
use crate::geometry::Bounds;

/// In front of a camera, between four planes through its centre.
pub(super) struct Pyramid {
    apex: DVec3,
    /// Inward normals.
    normals: [DVec3; 5],
}

impl Pyramid {
    /// What an undistorted image shows: `apex` is the camera's centre, `rotation` its axes in the same
    /// frame.
    pub(super) fn of_image(camera: &Camera, apex: DVec3, rotation: DMat3) -> Self {
        let Camera {
            fx,
            fy,
            cx,
            cy,
            skew,
            ..
        } = *camera;
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        // K·(x, y, z) = z·(u, v, 1), so u >= 0 is fx·x + s·y + cx·z >= 0, and so on.
        let normals = [
            DVec3::Z,
            DVec3::new(fx, skew, cx),
            DVec3::new(-fx, -skew, width - cx),
            DVec3::new(0.0, fy, cy),
            DVec3::new(0.0, -fy, height - cy),
        ];
        Self::new(apex, rotation, normals)
    }

    /// Directions (x, y, 1) in camera axes with (x, y) between `min` and `max`.
    pub(super) fn of_directions(min: DVec2, max: DVec2, apex: DVec3, rotation: DMat3) -> Self {
        Self::new(apex, rotation, inward(min, max))
    }

    fn new(apex: DVec3, rotation: DMat3, normals: [DVec3; 5]) -> Self {
        Self {
            apex,
            normals: normals.map(|normal| (rotation * normal).normalize_or_zero()),
        }
    }

    /// Whether a box lies wholly outside of one of the planes, by more than rounding can do. Where it
    /// does not, what it holds is looked at one by one.
    pub(super) fn misses(&self, bounds: &Bounds) -> bool {
        let (middle, half) = (bounds.center(), bounds.size() / 2.0);
        let way = middle - self.apex;
        let room = 1e-9 * (way.length() + half.length())
            + 1e-14 * (middle.abs() + self.apex.abs()).max_element();
        self.normals
            .iter()
            .any(|normal| normal.dot(way) + normal.abs().dot(half) < -room)
    }
}

/// Inward normals, in camera axes, of the directions (x, y, 1) with (x, y) between two corners.
pub(super) fn inward(min: DVec2, max: DVec2) -> [DVec3; 5] {
    [
        DVec3::Z,
        DVec3::new(1.0, 0.0, -min.x),
        DVec3::new(-1.0, 0.0, max.x),
        DVec3::new(0.0, 1.0, -min.y),
        DVec3::new(0.0, -1.0, max.y),
    ]
}
