//! The ground: the plane z = ground that a ray falls back to where it misses the surface.

use crate::camera::{Camera, Pose};
use crate::geometry::median;
use crate::surface::{Surface, SurfaceError};

/// How the elevation of the ground is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Ground {
    /// For each photo the median elevation of the surface's vertices that project inside its
    /// undistorted image in front of the camera, or of all vertices where none does. A fixed 0, the
    /// paper's, makes the scale of a flight at 160 m five times too small.
    #[default]
    Auto,
    /// An elevation in the world's unit.
    At(f64),
}

/// Finds the ground under photos.
#[derive(Debug)]
pub struct GroundFinder<'a> {
    ground: Ground,
    surface: &'a Surface,
    /// The median of all vertices, once somebody needed it.
    of_all: Option<f64>,
}

impl<'a> GroundFinder<'a> {
    /// Finds the ground by this rule on this surface.
    pub fn new(ground: Ground, surface: &'a Surface) -> Self {
        Self {
            ground,
            surface,
            of_all: None,
        }
    }

    /// The elevation of the ground for a photo, in the world's unit.
    ///
    /// # Errors
    /// Where the surface has no vertex.
    pub fn under(&mut self, camera: &Camera, pose: &Pose) -> Result<f64, SurfaceError> {
        if let Ground::At(z) = self.ground {
            return Ok(z);
        }
        let mut seen: Vec<f64> = self
            .surface
            .vertices()
            .filter(|&vertex| {
                camera
                    .pixel_undistorted(pose.camera_from_world(vertex))
                    .is_some_and(|pixel| camera.contains(pixel))
            })
            .map(|vertex| vertex.z)
            .collect();
        if let Some(z) = median(&mut seen) {
            return Ok(z);
        }
        if self.of_all.is_none() {
            let mut all: Vec<f64> = self.surface.vertices().map(|vertex| vertex.z).collect();
            self.of_all = median(&mut all);
        }
        self.of_all.ok_or(SurfaceError::TooFewPoints(0))
    }
}
