//! What a structure-from-motion package made of a flight: cameras, posed photos, sparse points.

use std::collections::HashMap;
use std::path::PathBuf;

use glam::DVec2;

use crate::camera::{Camera, Distortion, Pose};
use crate::geodesy::Geographic;
use crate::geometry::{Similarity, median};
use crate::packages::pose_covariance::PoseCovariance;
use crate::scale::StatedErrors;
use crate::surface::Cloud;
use crate::units::LengthUnit;

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

/// From where pixels count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Origin {
    /// The top-left corner of the image.
    #[default]
    Corner,
    /// The middle of the image.
    Middle,
}

/// What lengths in an image count in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImageUnit {
    /// Pixels.
    #[default]
    Pixel,
    /// The image's longer side: a package that writes focal lengths in parts of the film.
    LongerSide,
}

/// What a package says of the sizes of its images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sizes {
    /// Each camera has its own.
    Known,
    /// Each camera has one, and the package is known to solve on reduced copies of the photos: it may
    /// not be that of the photos that the engineer has.
    PerhapsReduced,
    /// Nothing: the cameras have width = height = 0 until [`Reconstruction::set_sizes`].
    Unknown {
        /// What fx, fy, cx, cy and the skew are in.
        unit: ImageUnit,
        /// From where cx, cy count: from the corner, where a calibration was given to the package in
        /// pixels.
        principal_points_from: Origin,
    },
}

impl Default for Sizes {
    fn default() -> Self {
        Self::Unknown {
            unit: ImageUnit::Pixel,
            principal_points_from: Origin::Middle,
        }
    }
}

impl Sizes {
    /// Whether the cameras have theirs.
    pub fn are_known(self) -> bool {
        matches!(self, Self::Known | Self::PerhapsReduced)
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
    /// The unit that the package states for a frame without `crs`: that of a local system, or what its
    /// specification says. `None` where it states none.
    pub unit: Option<LengthUnit>,
    /// Receivers' positions of photos, aligned or not; empty where the package keeps none.
    pub measured_positions: Vec<MeasuredPosition>,
    /// How sure the package is of each photo's pose, in the reconstruction's frame; parallel to `photos`,
    /// or empty where the package says nothing.
    pub pose_errors: Vec<PoseCovariance>,
    /// How sure it is of what all photos share. (Of poses `pose_errors` says it.)
    pub errors: StatedErrors,
    /// Cameras. What their numbers mean is said by `sizes`.
    pub cameras: Vec<Camera>,
    /// Photos in the file's order, aligned ones only.
    pub photos: Vec<PosedPhoto>,
    /// The sparse points; empty where there are none.
    pub cloud: Cloud,
    /// Measured image points; empty where the package keeps none.
    pub observations: Vec<Observation>,
    /// What is known of the image sizes.
    pub sizes: Sizes,
    /// Whether some versions of the package turn meshes by 180 degrees about x as they write them, and not their poses.
    pub may_turn_meshes: bool,
    /// Sizes of photos in pixels as the package names them beside its cameras, by the photo's name.
    pub named_sizes: HashMap<String, (u32, u32)>,
    /// From where the observations count.
    pub observed_from: Origin,
    /// The median reprojection error in the frame that the package solved in, where the reader had
    /// to bend that frame on the way into the world.
    pub solved_reprojection_px: Option<f64>,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

impl Reconstruction {
    /// One of its cameras as one of photos of this size, where the package writes none.
    pub fn sized(&self, camera: &Camera, width: u32, height: u32) -> Camera {
        let mut camera = Camera {
            width,
            height,
            ..camera.clone()
        };
        let Sizes::Unknown {
            unit,
            principal_points_from,
        } = self.sizes
        else {
            return camera;
        };
        if unit == ImageUnit::LongerSide {
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
        if principal_points_from == Origin::Middle {
            camera.cx += f64::from(width) / 2.0;
            camera.cy += f64::from(height) / 2.0;
        }
        camera
    }

    /// Gives the cameras of a package that writes no image sizes theirs. `size_of` tells the width and
    /// height of a camera by its index. Cameras without one go, with their photos and what these show.
    pub fn set_sizes(&mut self, size_of: impl Fn(usize) -> Option<(u32, u32)>) {
        let mut now_at = Vec::with_capacity(self.cameras.len());
        let mut cameras = Vec::with_capacity(self.cameras.len());
        for (index, camera) in self.cameras.iter().enumerate() {
            let size = size_of(index);
            now_at.push(size.map(|_| cameras.len()));
            cameras.extend(size.map(|(width, height)| self.sized(camera, width, height)));
        }
        self.cameras = cameras;
        let mut photo_now_at = Vec::with_capacity(self.photos.len());
        let mut kept = 0;
        self.photos.retain_mut(|photo| {
            let camera = now_at.get(photo.camera).copied().flatten();
            photo_now_at.push(camera.map(|_| kept));
            kept += u32::from(camera.is_some());
            photo.camera = camera.unwrap_or_default();
            camera.is_some()
        });
        let mut is_kept = photo_now_at.iter().map(Option::is_some);
        self.pose_errors
            .retain(|_| is_kept.next().unwrap_or_default());
        self.observations.retain_mut(|observation| {
            let photo = photo_now_at.get(observation.photo as usize).copied();
            observation.photo = photo.flatten().unwrap_or_default();
            photo.flatten().is_some()
        });
        self.sizes = Sizes::Known;
    }

    /// The size in pixels that the package names for each photo, beside its camera's.
    pub fn named_size(&self, photo: &PosedPhoto) -> Option<(u32, u32)> {
        let named = self.named_sizes.get(&photo.name);
        let of_camera = || size_in_camera_name(&self.cameras.get(photo.camera)?.name);
        named.copied().or_else(of_camera)
    }

    /// The median distance, in pixels, between the measured image points and the projections of
    /// their 3D points, in the image in which the package minimises it: the photo as shot, for
    /// VisualSFM the undistorted one. `None` where nothing can be compared.
    pub fn median_reprojection_px(&self) -> Option<f64> {
        if self.solved_reprojection_px.is_some() {
            return self.solved_reprojection_px;
        }
        if let Sizes::Unknown {
            unit,
            principal_points_from,
        } = self.sizes
            && (unit == ImageUnit::LongerSide || principal_points_from != self.observed_from)
        {
            return None;
        }
        let errors = self
            .observations
            .iter()
            .filter_map(|o| self.reprojection_px(o));
        median(&mut errors.collect::<Vec<f64>>())
    }

    /// How far a point projects from where a photo shows it, pixels of the photo as shot; `None` where it lies
    /// behind the camera.
    pub fn reprojection_px(&self, observation: &Observation) -> Option<f64> {
        let photo = self.photos.get(observation.photo as usize)?;
        let camera = self.cameras.get(photo.camera)?;
        let point = *self.cloud.points.get(observation.point as usize)?;
        let in_camera = photo.pose.camera_from_world(point);
        let mut measured = observation.pixel;
        if self.observed_from == Origin::Middle && self.sizes.are_known() {
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
        for errors in &mut self.pose_errors {
            *errors = errors.moved(&(similarity.rotation * similarity.scale));
        }
    }
}

/// The photos' size in the name that OpenSfM and OpenDroneMap give to a camera, after what the photos'
/// own EXIF says: "v2 dji fc6310 5472 3648 brown 0.6666" (`opensfm/exif.py`, `camera_id_`).
fn size_in_camera_name(name: &str) -> Option<(u32, u32)> {
    let words: Vec<&str> = name.split_whitespace().collect();
    let is_projection = |word: &str| word.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    words.windows(4).rev().find_map(|four| {
        let [width, height, projection, focal] = four else {
            return None;
        };
        let size = (width.parse().ok()?, height.parse().ok()?);
        let focal: f64 = focal.parse().ok()?;
        let sane = size.0 > 0 && size.1 > 0 && (0.0..100.0).contains(&focal);
        (sane && is_projection(projection)).then_some(size)
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_size_in_a_cameras_name() {
        for (name, size) in [
            ("v2 dji fc6310 5472 3648 brown 0.6666", Some((5472, 3648))),
            ("dji fc300s 400 225 brown 0.5555 rgb", Some((400, 225))),
            ("v2 sony ilce-7 4000 6000 perspective 0", Some((4000, 6000))),
            ("v2 unknown unknown -1 -1 perspective 0", None),
            ("FC6310 8.8 5472x3648", None),
            ("1", None),
            ("", None),
        ] {
            assert_eq!(size_in_camera_name(name), size, "{name}");
        }
    }

    /// The photo without a size goes, and what it shows; all else points where it pointed before.
    #[test]
    fn cameras_without_a_size_go_with_their_photos() {
        let camera = |name: &str| Camera {
            name: name.to_owned(),
            width: 0,
            height: 0,
            fx: 100.0,
            fy: 100.0,
            cx: 1.0,
            cy: -2.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let photo = |name: &str, camera| PosedPhoto {
            name: name.to_owned(),
            camera,
            pose: Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]),
        };
        let of_angle = |angle| PoseCovariance {
            angle: Some(DVec3::splat(angle)),
            ..PoseCovariance::default()
        };
        let seen = |photo| Observation {
            photo,
            point: 7,
            pixel: DVec2::ZERO,
        };
        let mut found = Reconstruction {
            cameras: vec![camera("a"), camera("b"), camera("c")],
            photos: vec![photo("1", 1), photo("2", 2), photo("3", 0)],
            observations: vec![seen(0), seen(1), seen(2), seen(9)],
            pose_errors: [0.1, 0.2, 0.3].map(of_angle).to_vec(),
            ..Reconstruction::default()
        };
        found.set_sizes(|camera| [Some((40, 30)), None, Some((20, 10))][camera]);
        let sizes: Vec<_> = found
            .cameras
            .iter()
            .map(|c| (c.name.as_str(), c.width, c.cx))
            .collect();
        assert_eq!(sizes, [("a", 40, 21.0), ("c", 20, 11.0)]);
        let photos: Vec<_> = found
            .photos
            .iter()
            .map(|p| (p.name.as_str(), p.camera))
            .collect();
        assert_eq!(photos, [("2", 1), ("3", 0)]);
        assert_eq!(found.pose_errors, [0.2, 0.3].map(of_angle));
        let seen: Vec<u32> = found.observations.iter().map(|o| o.photo).collect();
        assert_eq!(seen, [0, 1]);
        assert_eq!(found.sizes, Sizes::Known);
    }
}
