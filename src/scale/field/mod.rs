//! The scale field: depth and scale at each pixel of a photo (contract, section 7).
//!
//! The scale at a pixel of the undistorted image whose ray first meets the surface at the depth Z along
//! the optical axis is sqrt(fx·fy) / Z: pixels per unit on the plane through that point parallel to the
//! image. For the photo as shot it is that times sqrt(|det J|), J the derivative of distorted by
//! undistorted pixel there. Where the ray misses the surface there is none: the ground is no surface,
//! and nothing is filled in.

mod depths;
mod rays;
mod samples;

use glam::DVec3;
use rayon::prelude::*;

pub(super) use self::depths::clipped;
pub(super) use self::rays::meet_rays;
pub use self::samples::FieldGrid;

use self::depths::{Met, Stand, depths};
use self::samples::{Samples, ray};
use super::ImageKind;
use crate::camera::{Camera, Pose};
use crate::jobs::Progress;
use crate::surface::{Surface, SurfaceError};

/// Samples that one thread works on at a time: what bounds the memory that a lens takes.
const BAND: u32 = 1 << 20;

/// Grids of at most so many points know which triangles they met: of all pixels of a photo nobody asks.
const EDGES_UP_TO: usize = 1 << 16;

/// Depth and scale on a grid over a photo.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleField {
    /// Where its pixels are.
    pub grid: FieldGrid,
    camera: Camera,
    pose: Pose,
    image: ImageKind,
    /// Row by row, world units; infinite where the ray misses.
    depths: Vec<f64>,
    /// The longest edges of the triangles that are met, world units; empty on fine grids.
    edges: Vec<f64>,
}

/// What is met at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldPoint {
    /// Along the optical axis, world units.
    pub depth: f64,
    /// Pixels per world unit.
    pub scale: f64,
    /// In the world.
    pub point: DVec3,
}

/// Why there is no field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FieldError {
    /// The surface cannot be triangulated.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The work was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl ScaleField {
    /// Meets the rays of a grid over a photo with a surface, on all cores where they are many.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        grid: FieldGrid,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, FieldError> {
        let patches = surface.patches();
        let stand = stand(pose, surface);
        let rows = (BAND / grid.columns.max(1)).clamp(1, grid.rows.max(1));
        let bands: Vec<u32> = (0..grid.rows).step_by(rows as usize).collect();
        let with_edges = grid.len() <= EDGES_UP_TO;
        let bands: Vec<Met> = bands
            .into_par_iter()
            .map(|first| {
                let band = first..first.saturating_add(rows).min(grid.rows);
                let samples = Samples::new(camera, image, grid, band);
                depths(&samples, &stand, patches, with_edges, progress)
            })
            .collect::<Result<_, FieldError>>()?;
        let (depths, edges): (Vec<_>, Vec<_>) = (bands.into_iter())
            .map(|band| (band.depths, band.edges))
            .unzip();
        Ok(Self {
            grid,
            camera: camera.clone(),
            pose: *pose,
            image,
            depths: depths.concat(),
            edges: edges.concat(),
        })
    }

    /// What is met at a column and a row; `None` where the ray misses the surface.
    pub fn at(&self, column: u32, row: u32) -> Option<FieldPoint> {
        let depth = self.depth_at(column, row)?;
        let direction = self.direction_at(column, row)?;
        let in_camera = direction * depth;
        Some(FieldPoint {
            depth,
            scale: self.scale(direction, depth)?,
            point: self.pose.center + self.pose.rotation * in_camera,
        })
    }

    /// Pixels per world unit at a column and a row; `None` where the ray misses the surface.
    pub fn scale_at(&self, column: u32, row: u32) -> Option<f64> {
        let depth = self.depth_at(column, row)?;
        match self.image {
            ImageKind::Undistorted => self.scale(DVec3::Z, depth),
            ImageKind::AsShot => self.scale(self.direction_at(column, row)?, depth),
        }
    }

    fn scale(&self, direction: DVec3, depth: f64) -> Option<f64> {
        scale_at_point(&self.camera, self.image, direction * depth)
    }

    /// The depth at a column and a row along the optical axis, world units; `None` where the ray misses.
    pub fn depth_at(&self, column: u32, row: u32) -> Option<f64> {
        let place = row as usize * self.grid.columns as usize + column as usize;
        self.depths
            .get(place)
            .copied()
            .filter(|depth| depth.is_finite())
    }

    /// The longest edge of the triangle that is met at a column and a row, world units; `None` where the
    /// ray misses, and on grids of more than 65 536 points.
    pub fn longest_edge_at(&self, column: u32, row: u32) -> Option<f64> {
        let place = row as usize * self.grid.columns as usize + column as usize;
        (self.edges.get(place).copied()).filter(|edge| edge.is_finite())
    }

    /// The share of the grid's points that have a scale.
    pub fn covered(&self) -> f64 {
        let cells = self.grid.cells();
        let with_scale = cells.filter(|&(column, row)| self.scale_at(column, row).is_some());
        with_scale.count() as f64 / self.grid.len().max(1) as f64
    }

    /// What its photo shows of the surface, in the world, row by row.
    pub fn points(&self) -> Vec<DVec3> {
        let cells = self.grid.cells();
        let met = cells.filter_map(|(column, row)| Some(self.at(column, row)?.point));
        met.collect()
    }

    /// The ray of a column and a row, (x, y, 1) in camera axes; `None` where the lens shows nothing.
    pub fn direction_at(&self, column: u32, row: u32) -> Option<DVec3> {
        let pixel = self.grid.pixel(&self.camera, column, row);
        let direction = self.image.direction(&self.camera, pixel).ok()?;
        (direction.z > 0.0).then(|| ray(direction.truncate() / direction.z))
    }

    /// Whether no ray meets the surface.
    pub fn is_empty(&self) -> bool {
        !self.depths.iter().any(|depth| depth.is_finite())
    }

    /// Its image's camera.
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The pose of its photo.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Which image it is of.
    pub fn image(&self) -> ImageKind {
        self.image
    }
}

/// Where the camera of a photo stands before a surface.
fn stand(pose: &Pose, surface: &Surface) -> Stand {
    Stand {
        center: surface.frame().local_from_world(pose.center),
        rotation: pose.rotation,
        slack: surface.slack(pose.center),
    }
}

/// Pixels per world unit of an image at a point in camera axes (contract, section 7): on the plane through
/// it parallel to the image. `None` where the lens does not see it.
pub(super) fn scale_at_point(camera: &Camera, image: ImageKind, point: DVec3) -> Option<f64> {
    let scale = (camera.fx * camera.fy).sqrt() / point.z;
    match image {
        ImageKind::Undistorted => (point.z > 0.0).then_some(scale),
        ImageKind::AsShot => Some(scale * camera.lens_area(point)?.sqrt()),
    }
}

#[cfg(test)]
mod tests;
