//! What a structure-from-motion package made of a flight: cameras, posed photos, sparse points.

use std::path::PathBuf;

use glam::DVec2;

use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::geodesy::Geographic;
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

/// Where a photo was taken as its receiver measured it: no result of the adjustment.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredPosition {
    /// The image file's name, as in [`PosedPhoto::name`].
    pub photo: String,
    /// On WGS 84; the height as the package wrote it.
    pub position: Geographic,
}

/// A reconstruction with what else its package left on disk.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Project {
    /// Cameras, poses and sparse points.
    pub reconstruction: Reconstruction,
    /// The file of the dense cloud or mesh, in the reconstruction's frame unless it says otherwise.
    pub surface: Option<PathBuf>,
    /// Which of several surfaces that is, or where none was found: a sentence for whoever names no
    /// other one.
    pub surface_note: Option<String>,
    /// The folder of the photo files.
    pub photos: Option<PathBuf>,
}

impl From<Reconstruction> for Project {
    fn from(reconstruction: Reconstruction) -> Self {
        Self {
            reconstruction,
            ..Self::default()
        }
    }
}

/// A reconstruction in its own frame, in fragscale's conventions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reconstruction {
    /// The package, as `info` names it: "colmap", "visualsfm", ...
    pub package: &'static str,
    /// The coordinate system that the package states: "EPSG:n", WKT or "ECEF". Where it is one of
    /// longitude and latitude, positions are (degrees east, degrees north, metres up), and rotations
    /// take camera axes to east, north, up at the photo's own place.
    pub crs: Option<String>,
    /// The map projection ("EPSG:n" or WKT) that the engineer chose in a package whose frame is
    /// another one: a target to bring the photos to.
    pub preferred_crs: Option<String>,
    /// Where the origin stands of a frame without `crs` whose axes are east, north and up there.
    pub enu_origin: Option<Geographic>,
    /// Receivers' positions of photos, aligned or not; empty where the package keeps none.
    pub measured_positions: Vec<MeasuredPosition>,
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
    /// Whether fx, fy, cx, cy and the skew are in units of the image's longer side until the sizes
    /// are set: a package that writes focal lengths in parts of the film.
    pub intrinsics_in_longer_sides: bool,
    /// Whether the observations count from the middle of the image (else from its top-left corner).
    pub observed_from_middle: bool,
    /// The median reprojection error in the frame that the package solved in, where the reader had
    /// to bend that frame on the way into the world.
    pub solved_reprojection_px: Option<f64>,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

impl Reconstruction {
    /// One of its cameras as one of photos of this size, where the package writes none.
    pub(super) fn sized(&self, camera: &Camera, width: u32, height: u32) -> Camera {
        let mut camera = Camera {
            width,
            height,
            ..camera.clone()
        };
        if self.intrinsics_in_longer_sides {
            let longer = f64::from(width.max(height));
            for value in [
                &mut camera.fx,
                &mut camera.fy,
                &mut camera.cx,
                &mut camera.cy,
                &mut camera.skew,
            ] {
                *value *= longer;
            }
        }
        if !self.principal_points_from_corner {
            camera.cx += f64::from(width) / 2.0;
            camera.cy += f64::from(height) / 2.0;
        }
        camera
    }

    /// Gives the cameras of a package that writes no image sizes theirs. `size_of` tells the width
    /// and height of a camera by its index.
    ///
    /// # Errors
    /// Passes on what `size_of` could not find out.
    pub fn set_sizes(
        &mut self,
        size_of: impl Fn(usize) -> Result<(u32, u32), Fault>,
    ) -> Result<(), Fault> {
        for index in 0..self.cameras.len() {
            let (width, height) = size_of(index)?;
            self.cameras[index] = self.sized(&self.cameras[index], width, height);
        }
        self.sizes_known = true;
        self.intrinsics_in_longer_sides = false;
        Ok(())
    }

    /// The median distance, in pixels, between the measured image points and the projections of
    /// their 3D points, in the image in which the package minimises it: the photo as shot, for
    /// VisualSFM the undistorted one. `None` where nothing can be compared.
    pub fn median_reprojection_px(&self) -> Option<f64> {
        if self.solved_reprojection_px.is_some() {
            return self.solved_reprojection_px;
        }
        let one_origin = self.observed_from_middle != self.principal_points_from_corner;
        let unknown = self.intrinsics_in_longer_sides || !one_origin;
        if !self.sizes_known && unknown {
            return None;
        }
        let errors = self.observations.iter().filter_map(|o| self.error_px(o));
        median(&mut errors.collect::<Vec<f64>>())
    }

    fn error_px(&self, observation: &Observation) -> Option<f64> {
        let photo = self.photos.get(observation.photo as usize)?;
        let camera = self.cameras.get(photo.camera)?;
        let point = *self.cloud.points.get(observation.point as usize)?;
        let in_camera = photo.pose.camera_from_world(point);
        let mut measured = observation.pixel;
        if self.observed_from_middle && self.sizes_known {
            measured += DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
        }
        if let Distortion::VisualSfm(_) = camera.distortion {
            let measured = camera.pixel_undistorted(camera.direction_as_shot(measured).ok()?)?;
            return Some((measured - camera.pixel_undistorted(in_camera)?).length());
        }
        Some((measured - camera.pixel_as_shot(in_camera)?).length())
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
