//! What a structure-from-motion package made of a flight: cameras, posed photos, sparse points.

use glam::DVec2;

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::{Similarity, median};
use crate::surface::Cloud;

/// A posed photo of a reconstruction.
#[derive(Debug, Clone, PartialEq)]
pub struct PosedPhoto {
    /// The image file's name, as the package wrote it.
    pub name: String,
    /// Index into [`Reconstruction::cameras`].
    pub camera: usize,
    /// In the reconstruction's frame.
    pub pose: Pose,
}

/// Where a photo shows a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Index into [`Reconstruction::photos`].
    pub photo: u32,
    /// Index into the points of [`Reconstruction::cloud`].
    pub point: u32,
    /// In the photo as shot, in fragscale's pixels.
    pub pixel: DVec2,
}

/// A reconstruction in its own frame, in fragscale's conventions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reconstruction {
    /// The package, as `info` names it: "colmap", "visualsfm", ...
    pub package: &'static str,
    /// The coordinate system that the package states: "EPSG:n", WKT or "ECEF".
    pub crs: Option<String>,
    /// Cameras. Where `sizes_known` is false they have width = height = 0, and cx, cy count from
    /// the middle of the image, unless `principal_points_from_corner`.
    pub cameras: Vec<Camera>,
    /// Photos in the file's order, aligned ones only.
    pub photos: Vec<PosedPhoto>,
    /// The sparse points; empty where there are none.
    pub cloud: Cloud,
    /// Measured image points; empty where the package keeps none.
    pub observations: Vec<Observation>,
    /// Whether the package writes the image sizes.
    pub sizes_known: bool,
    /// Whether cx, cy count from the top-left corner although the sizes are not known: a calibration
    /// that was given to the package in pixels.
    pub principal_points_from_corner: bool,
    /// Whether the observations count from the middle of the image (else from its top-left corner).
    pub observed_from_middle: bool,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

impl Reconstruction {
    /// Gives the cameras of a package that writes no image sizes theirs. `size_of` tells the width
    /// and height of a camera by its index.
    ///
    /// # Errors
    /// Passes on what `size_of` could not find out.
    pub fn set_sizes(
        &mut self,
        size_of: impl Fn(usize) -> Result<(u32, u32), Fault>,
    ) -> Result<(), Fault> {
        for (index, camera) in self.cameras.iter_mut().enumerate() {
            let (width, height) = size_of(index)?;
            (camera.width, camera.height) = (width, height);
            if !self.principal_points_from_corner {
                camera.cx += f64::from(width) / 2.0;
                camera.cy += f64::from(height) / 2.0;
            }
        }
        self.sizes_known = true;
        Ok(())
    }

    /// The median distance, in pixels, between the measured image points and the projections of
    /// their 3D points; `None` where nothing can be compared.
    pub fn median_reprojection_px(&self) -> Option<f64> {
        let one_origin = self.observed_from_middle != self.principal_points_from_corner;
        if !self.sizes_known && !one_origin {
            return None;
        }
        let mut errors: Vec<f64> = self
            .observations
            .iter()
            .filter_map(|observation| {
                let photo = self.photos.get(observation.photo as usize)?;
                let camera = self.cameras.get(photo.camera)?;
                let point = *self.cloud.points.get(observation.point as usize)?;
                let expected = camera.pixel_as_shot(photo.pose.camera_from_world(point))?;
                let from_corner = if self.observed_from_middle && self.sizes_known {
                    DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0
                } else {
                    DVec2::ZERO
                };
                Some((observation.pixel + from_corner - expected).length())
            })
            .collect();
        median(&mut errors)
    }

    /// Moves poses and points by a similarity.
    pub fn transform(&mut self, similarity: &Similarity) {
        for photo in &mut self.photos {
            photo.pose.center = similarity.apply(photo.pose.center);
            photo.pose.rotation = similarity.rotation * photo.pose.rotation;
        }
        for point in &mut self.cloud.points {
            *point = similarity.apply(*point);
        }
    }
}
