//! OpenSfM's `reconstruction.json`.
//!
//! Written from OpenSfM's documentation ("Dataset Structure", "Reconstruction file format";
//! "Geometric Models", coordinate systems) and `opensfm/io.py` (`reconstruction_from_json`).
//!
//! ```text
//! [RECONSTRUCTION, ...]           the one with most shots first; shots of different ones have
//!                                 nothing in common, not even a frame
//! RECONSTRUCTION {
//!   cameras        {name: model}                             see camera.rs
//!   shots          {name: {camera, rotation [3], translation [3], gps_position [3], gps_dop,
//!                          covariance [6][6]}}                see covariance.rs
//!   points         {name: {coordinates [3], color [3]}}      may be left out
//!   pano_shots     panoramas                                 left out here, with a warning
//!   reference_lla  {latitude, longitude, altitude}           also in reference_lla.json
//!   rig_cameras    {name: {rotation, translation}}
//!   rig_instances  {name: {rotation, translation, rig_camera_ids {shot: rig camera}}}
//!   biases, ...                                              not needed
//! }
//! ```
//!
//! rotation is an axis of length angle (radians), translation may be left out (0):
//! x_camera = R x_world + t, with camera axes x right, y down, z forward. A shot of a rig carries its
//! own pose as well; one that does not has the rig camera's after its instance's. The world is
//! east-north-up at `reference_lla` (WGS 84) where there was GPS, else arbitrary and the reference is
//! 0, 0, 0; it names no coordinate system. OpenDroneMap writes another frame into the same file, which
//! only the positions tell (frame/). gps_position is what the receiver said, east-north-up; a
//! gps_dop of 999999 stands for a photo without GPS. Colours are 0 to 255, written as floats. Image
//! points count in the photo as stored, whatever its EXIF orientation.

pub(crate) mod camera;
mod covariance;
mod dataset;
mod frame;
mod place;
mod raw;
mod reference;
mod rig;
mod stats;
mod tracks;

use std::collections::HashMap;

use glam::DVec3;

use crate::camera::Pose;
use crate::fault::Fault;
use crate::packages::pose_covariance::{PassedOver, PoseCovariance};
use crate::packages::reconstruction::{PosedPhoto, Reconstruction, Sizes};
use crate::surface::Cloud;
use crate::text::json::{Object, parse};
use camera::usable_cameras;
pub(crate) use dataset::{count_of_photos, dataset_file, read_file, scale_error};
use raw::{List, RawPoint, RawReconstruction};
use reference::{Measured, enu_origin, measured_positions};
use rig::Rigs;

/// A `reconstruction.json` with the names of its points, which `tracks.csv` calls them by.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OpenSfm {
    /// In OpenSfM's own frame; the photos in the file's order.
    pub reconstruction: Reconstruction,
    /// Index into the cloud's points, by name.
    point_indices: HashMap<String, u32>,
    /// What the receivers said of the photos, in the file's order.
    measured: Vec<Measured>,
}

/// Reads the first, largest reconstruction of a `reconstruction.json`.
///
/// # Errors
/// As [`OpenSfm::read`].
#[cfg(test)]
pub(crate) fn read(json: &[u8]) -> Result<Reconstruction, Fault> {
    Ok(OpenSfm::read(json)?.reconstruction)
}

impl OpenSfm {
    /// Reads the first, largest reconstruction of a `reconstruction.json`, without observations,
    /// which [`OpenSfm::add_observations`] adds.
    ///
    /// # Errors
    /// Where it is no JSON of that shape (with the line), a number is not usable, a shot names a
    /// camera that is not there, or nothing was aligned.
    pub(crate) fn read(json: &[u8]) -> Result<Self, Fault> {
        let list: List = parse(json)?;
        let Some(mut raw) = list.largest else {
            return Err(nothing_aligned("it holds no reconstruction"));
        };
        if raw.shots.0.is_empty() {
            return Err(nothing_aligned("its reconstruction has no shots"));
        }
        let mut warnings = Vec::new();
        if list.others > 0 {
            warnings.push(format!(
                "{} more reconstructions with {} photos in all, not connected to the largest, are left out",
                list.others, list.other_shots
            ));
        }
        if !raw.pano_shots.0.is_empty() {
            let count = raw.pano_shots.0.len();
            warnings.push(format!("{count} panoramas are left out"));
        }
        leave_out_unsupported(&mut raw, &mut warnings)?;
        let is_used = |id: &str| raw.shots.0.iter().any(|(_, shot)| shot.camera == id);
        let cameras = usable_cameras(&raw.cameras, is_used, &mut warnings)?;
        let camera_indices: HashMap<&str, usize> = cameras
            .iter()
            .enumerate()
            .map(|(index, camera)| (camera.name.as_str(), index))
            .collect();
        let enu_origin = raw.reference_lla.and_then(enu_origin);
        let of_shots = raw.shots.0.iter();
        let measured: Vec<Measured> = of_shots
            .filter_map(|(name, shot)| Measured::of_shot(name, shot.gps_position, shot.gps_dop))
            .collect();
        let measured_positions = measured_positions(&measured, enu_origin, &mut warnings);
        let rigs = Rigs::new(raw.rig_cameras, raw.rig_instances);
        let mut photos = Vec::with_capacity(raw.shots.0.len());
        let mut pose_errors = Vec::with_capacity(raw.shots.0.len());
        let mut passed_over = PassedOver::default();
        let mut without_translation = 0;
        for (name, shot) in raw.shots.0 {
            let Some(&camera) = camera_indices.get(shot.camera.as_str()) else {
                return Err(Fault::new(
                    format!(
                        "shot \"{name}\" names the camera \"{}\", which is not there",
                        shot.camera
                    ),
                    "export it again",
                ));
            };
            let pose = match shot.rotation {
                Some(rotation) => {
                    without_translation += usize::from(shot.translation.is_none());
                    pose_from(rotation, shot.translation.unwrap_or_default())
                }
                None => rigs.pose_of(&name)?,
            };
            let pose = checked(pose, &name)?;
            let rotation = shot.rotation.map(|r| -DVec3::from(r));
            pose_errors.push(match rotation {
                Some(rotation) => covariance::of(&shot.covariance, rotation, &mut passed_over),
                None => PoseCovariance::default(),
            });
            photos.push(PosedPhoto { name, camera, pose });
        }
        if without_translation > 0 {
            warnings.push(format!(
                "{without_translation} shots have no translation; 0 is taken, as OpenSfM does"
            ));
        }
        warnings.extend(passed_over.warning());
        let (cloud, point_indices) = points(raw.points)?;
        Ok(Self {
            reconstruction: Reconstruction {
                package: "opensfm",
                enu_origin,
                measured_positions,
                cameras,
                photos,
                pose_errors,
                cloud,
                sizes: Sizes::PerhapsReduced,
                // OpenDroneMap, which most often brings it, has reduced photos before it.
                warnings,
                ..Reconstruction::default()
            },
            point_indices,
            measured,
        })
    }

    /// Adds the image points of a `tracks.csv`. Those of photos and points that the reconstruction
    /// does not have are left out.
    ///
    /// # Errors
    /// Where the file is of an unknown version or a line is broken, with the line; nothing is added
    /// then.
    pub(crate) fn add_observations(&mut self, tracks: &str) -> Result<(), Fault> {
        let reconstruction = &self.reconstruction;
        let observations = tracks::read(tracks, reconstruction, |point| {
            self.point_indices.get(point).copied()
        })?;
        self.reconstruction.observations = observations;
        Ok(())
    }
}

fn nothing_aligned(what: &str) -> Fault {
    Fault::new(what, "check that the alignment succeeded")
}

/// The pose of a rotation vector and a translation of `camera_from_world`.
fn pose_from(rotation: [f64; 3], translation: [f64; 3]) -> Pose {
    let rotation = DVec3::from(rotation);
    let mut pose = Pose::from_rotation_vector_of_camera_from_world(DVec3::ZERO, rotation);
    pose.center = -(pose.rotation * DVec3::from(translation));
    pose
}

/// Leaves out the shots of cameras that fragscale has no lens for, unless there are no others.
fn leave_out_unsupported(
    raw: &mut RawReconstruction,
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let unsupported: Vec<(String, Fault)> = raw
        .cameras
        .0
        .iter()
        .filter_map(|(id, model)| Some((id.clone(), model.unsupported(id)?)))
        .collect();
    for (id, fault) in unsupported {
        let all = raw.shots.0.len();
        let shots = raw.shots.0.iter();
        let kept = shots.filter(|(_, shot)| shot.camera != id).count();
        if kept == 0 {
            return Err(fault);
        }
        raw.shots.0.retain(|(_, shot)| shot.camera != id);
        raw.cameras.0.retain(|(name, _)| *name != id);
        warnings.push(match all - kept {
            0 => format!("{}; no photo uses it, it is left out", fault.what),
            count => format!("{}; its {count} photos are left out", fault.what),
        });
    }
    Ok(())
}

/// Refuses a pose whose numbers ran over.
pub(crate) fn checked(pose: Pose, name: &str) -> Result<Pose, Fault> {
    if pose.rotation.is_finite() && pose.center.is_finite() {
        return Ok(pose);
    }
    Err(Fault::new(
        format!("the rotation or the position of shot \"{name}\" is too large to compute with"),
        "export it again, or leave the shot out",
    ))
}

/// The points with their colours (none where one has none), and the indices of their names.
fn points(raw: Object<RawPoint>) -> Result<(Cloud, HashMap<String, u32>), Fault> {
    let mut cloud = Cloud::default();
    let mut indices = HashMap::with_capacity(raw.0.len());
    for (index, (name, point)) in raw.0.into_iter().enumerate() {
        let index = u32::try_from(index)
            .map_err(|_| Fault::new("it has more than 4 294 967 295 points", "thin them out"))?;
        cloud.points.push(DVec3::from(point.coordinates));
        if let Some(color) = point.color {
            cloud
                .colors
                .push(color.map(|c| c.round().clamp(0.0, 255.0) as u8));
        }
        indices.insert(name, index);
    }
    if cloud.colors.len() != cloud.points.len() {
        cloud.colors.clear();
    }
    Ok((cloud, indices))
}

#[cfg(test)]
mod tests;
