//! Meshroom's scenes: AliceVision's SfMData as JSON, `.sfm` or `.json`.
//!
//! Written from AliceVision's `sfmDataIO/jsonIO.cpp` at format version 1.2.11, which also reads the
//! older ones, `sfmData/SfMData.hpp` (`getPose`) and `geometry/Pose3.hpp`.
//!
//! ```text
//! version     [major, minor, revision]
//! views       [{viewId, poseId, intrinsicId, path, metadata {name: text},
//!               rigId, subPoseId, isPoseIndependant}]        the last three of rigs only
//! intrinsics  [...]                                          see intrinsics.rs
//! poses       [{poseId, pose {transform {rotation [9], center [3]}}}]
//! rigs        [{rigId, subPoses [{status, pose {rotation [9], center [3]}}]}]
//! structure   [{X [3], color [3], observations [{observationId, x [2]}]}]
//! ```
//!
//! - All values are text, and what is empty is "" (loose.rs).
//! - rotation is Eigen's `camera_from_world` in column-major order, which is `world_from_camera` in
//!   row-major order, with camera axes x right, y down, z forward. center is the camera's.
//! - A view of a rig whose isPoseIndependant is false (it is true where it is left out) has the pose of
//!   its sub-pose after the rig's, as `camera_from_world`.
//! - A view was aligned where its pose and its intrinsics are there.
//! - observationId is a viewId; x counts as the principal point does, from the top-left corner; many
//!   files are saved without x, or without observations.
//! - The frame is arbitrary unless the SfMTransform node turned and scaled it, which nothing tells.
//! - Meshes beside it are turned by 180 degrees about x since version 2023 (`mesh/Mesh.cpp` writes x, -y, -z), and were not
//!   before.
//! - A photo is called by the last part of its path, or the whole path where two share that.
//!
//! `.abc` holds the same as Alembic, which is refused. OpenMVG's `sfm_data.json` is another format.

mod gps;
mod intrinsics;
mod loose;

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec2, DVec3};
use serde::Deserialize;

use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::{FileError, last_segment, read_bytes};
use crate::packages::reconstruction::{
    MeasuredPosition, Observation, PosedPhoto, Project, Reconstruction, Sizes,
};
use crate::photos::photo_folder::folder_of_photos;
use crate::poses::rounded_rotation::{from_row_major, rounded_rotation};
use crate::surface::Cloud;
use crate::text::json::parse;
use intrinsics::RawIntrinsic;
use loose::{GpsTags, Id, List, Number};

/// The version that this reader was written from.
const KNOWN: Version = Version([1, 2, 11]);

/// Of the format: major, minor, revision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Version([u32; 3]);

/// Whether a file that begins with `start` is Meshroom's, by its name or as Alembic. Scenes called
/// .json are told by their keys.
pub(crate) fn is_scene(start: &[u8], name: &str) -> bool {
    name.ends_with(".sfm") || name.ends_with(".abc") || is_alembic(start)
}

/// Alembic is an Ogawa archive, in older files HDF5.
fn is_alembic(start: &[u8]) -> bool {
    start.starts_with(b"Ogawa")
}

/// Reads a scene and finds the folder of its photos.
///
/// # Errors
/// Where the file is of another format, broken, or holds no aligned view.
pub(crate) fn read_file(path: &Path) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    let bytes = read_bytes(path)?;
    let is_abc = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("abc"));
    if is_abc || is_alembic(&bytes) {
        return Err(at(Fault::new(
            "a scene as Alembic, which fragscale does not read",
            "add a ConvertSfMFormat node with the file type sfm in Meshroom, or open the cameras.sfm \
             beside it",
        )));
    }
    let scene = read(&bytes).map_err(at)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let of_photo = scene
        .paths
        .iter()
        .filter_map(|path| Path::new(path).parent());
    let mut folders: Vec<PathBuf> = of_photo.take(1).map(|parent| folder.join(parent)).collect();
    folders.extend([folder.to_owned(), folder.join("images")]);
    let photos = folder_of_photos(folders, &scene.reconstruction);
    Ok(Project {
        photos,
        ..Project::from(scene.reconstruction)
    })
}

/// What a file holds.
#[derive(Debug)]
struct Scene {
    reconstruction: Reconstruction,
    /// The path of each photo's file, as the file has it.
    paths: Vec<String>,
}

fn read(json: &[u8]) -> Result<Scene, Fault> {
    let raw: RawScene = parse(json)?;
    let mut warnings = Vec::new();
    let version = raw.version(&mut warnings)?;
    let mut cameras = Vec::new();
    let mut camera_of: HashMap<&Id, Result<usize, String>> = HashMap::new();
    for intrinsic in &raw.intrinsics.0 {
        let id = &intrinsic.intrinsic_id;
        let camera = intrinsic.camera(version).map(|(camera, remark)| {
            warnings.extend(remark.map(|remark| format!("camera {}: {remark}", id.0)));
            cameras.push(camera);
            cameras.len() - 1
        });
        if camera_of.insert(id, camera).is_some() {
            return Err(broken(format!("the intrinsicId {} stands twice", id.0)));
        }
    }
    let poses = raw.poses()?;
    let names = raw.names();
    let mut photos = Vec::new();
    let mut paths = Vec::new();
    let mut photo_of_view = HashMap::new();
    let mut measured_positions = Vec::new();
    let mut unusable: HashMap<&Id, u32> = HashMap::new();
    for (view, name) in raw.views.0.iter().zip(&names) {
        if let Some(position) = gps::position(&view.metadata) {
            let photo = name.clone();
            measured_positions.push(MeasuredPosition { photo, position });
        }
        let intrinsic = view.intrinsic_id.as_ref().filter(|id| !id.is_undefined());
        let camera = intrinsic.and_then(|id| Some((id, camera_of.get(id)?)));
        let (Some((id, camera)), Some(pose)) = (camera, raw.pose_of(view, &poses)?) else {
            continue;
        };
        let Ok(camera) = *camera else {
            *unusable.entry(id).or_default() += 1;
            continue;
        };
        let photo = u32::try_from(photos.len()).map_err(|_| broken("too many views".to_owned()))?;
        if photo_of_view.insert(&view.view_id, photo).is_some() {
            return Err(broken(format!(
                "the viewId {} stands twice",
                view.view_id.0
            )));
        }
        let name = name.clone();
        photos.push(PosedPhoto { name, camera, pose });
        paths.push(view.path.clone());
    }
    for intrinsic in &raw.intrinsics.0 {
        let id = &intrinsic.intrinsic_id;
        if let (Some(Err(why)), Some(count)) = (camera_of.get(id), unusable.get(id)) {
            let what = format!("camera {} cannot be used: {why}", id.0);
            if photos.is_empty() {
                let remedy =
                    "reconstruct with a pinhole camera (CameraInit), or export undistorted photos";
                return Err(Fault::new(what, remedy));
            }
            warnings.push(format!("{what}; its {count} photos are left out"));
        }
    }
    let without = raw.views.0.len() - photos.len() - unusable.values().sum::<u32>() as usize;
    if photos.is_empty() {
        return Err(Fault::new(
            "none of its views has a pose",
            "give the scene of the StructureFromMotion node (cameras.sfm), not CameraInit's",
        ));
    }
    if without > 0 {
        let all = raw.views.0.len();
        warnings.push(format!(
            "{without} of {all} photos were not aligned and are left out"
        ));
    }
    if raw.views.0.iter().any(|view| view.path.is_empty()) {
        warnings.push(format!(
            "views without a path are called by their number, \"{NO_PATH}n\""
        ));
    }
    let mut reconstruction = Reconstruction {
        package: "meshroom",
        may_turn_meshes: true,
        measured_positions,
        cameras,
        photos,
        sizes: Sizes::Known,
        warnings,
        ..Reconstruction::default()
    };
    add_structure(raw.structure, &photo_of_view, &mut reconstruction)?;
    Ok(Scene {
        reconstruction,
        paths,
    })
}

/// In front of the number of a view without a path.
const NO_PATH: &str = "view ";

fn broken(what: String) -> Fault {
    Fault::new(what, "export it again")
}

fn add_structure(
    structure: List<RawLandmark>,
    photo_of_view: &HashMap<&Id, u32>,
    found: &mut Reconstruction,
) -> Result<(), Fault> {
    let mut cloud = Cloud::default();
    for (index, landmark) in structure.0.into_iter().enumerate() {
        let point = u32::try_from(index).map_err(|_| broken("too many landmarks".to_owned()))?;
        let Ok(position) = <[Number; 3]>::try_from(&landmark.position) else {
            return Err(broken(format!(
                "X of landmark {index} (from 0) is not three numbers"
            )));
        };
        cloud.points.push(DVec3::from(position.map(|x| x.0)));
        if let Ok(color) = <[Number; 3]>::try_from(&landmark.color) {
            let byte = |c: Number| c.0.round().clamp(0.0, 255.0) as u8;
            cloud.colors.push(color.map(byte));
        }
        for observation in landmark.observations.0 {
            let pixel = <[Number; 2]>::try_from(&observation.pixel);
            let photo = photo_of_view.get(&observation.observation_id);
            if let (Ok([u, v]), Some(&photo)) = (pixel, photo) {
                found.observations.push(Observation {
                    photo,
                    point,
                    pixel: DVec2::new(u.0, v.0),
                });
            }
        }
    }
    if cloud.colors.len() != cloud.points.len() {
        cloud.colors.clear();
    }
    found.cloud = cloud;
    Ok(())
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct RawScene {
    version: List<Number>,
    #[serde(default)]
    views: List<RawView>,
    #[serde(default)]
    intrinsics: List<RawIntrinsic>,
    #[serde(default)]
    poses: List<RawPose>,
    #[serde(default)]
    rigs: List<RawRig>,
    #[serde(default)]
    structure: List<RawLandmark>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct RawView {
    view_id: Id,
    pose_id: Option<Id>,
    intrinsic_id: Option<Id>,
    #[serde(default)]
    path: String,
    rig_id: Option<Id>,
    sub_pose_id: Option<Number>,
    is_pose_independant: Option<Id>,
    #[serde(default)]
    metadata: GpsTags,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct RawPose {
    pose_id: Id,
    pose: RawCameraPose,
}

#[derive(Deserialize)]
struct RawCameraPose {
    transform: RawTransform,
}

#[derive(Deserialize)]
struct RawTransform {
    rotation: List<Number>,
    center: List<Number>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct RawRig {
    rig_id: Id,
    #[serde(default)]
    sub_poses: List<RawSubPose>,
}

#[derive(Deserialize)]
struct RawSubPose {
    #[serde(default)]
    status: String,
    pose: RawTransform,
}

#[derive(Deserialize)]
struct RawLandmark {
    #[serde(rename = "X")]
    position: List<Number>,
    #[serde(default)]
    color: List<Number>,
    #[serde(default)]
    observations: List<RawObservation>,
}

#[derive(Deserialize)]
struct RawObservation {
    #[serde(rename = "observationId")]
    observation_id: Id,
    #[serde(rename = "x", default)]
    pixel: List<Number>,
}

impl RawTransform {
    fn pose(&self, of: &str, id: &str) -> Result<Pose, Fault> {
        let fault = |what: &str| broken(format!("the {of} {id}: {what}"));
        let rotation = <[Number; 9]>::try_from(&self.rotation)
            .map_err(|()| fault("its rotation is not nine numbers"))?;
        let center = <[Number; 3]>::try_from(&self.center)
            .map_err(|()| fault("its center is not three numbers"))?;
        let matrix: DMat3 = from_row_major(rotation.map(|entry| entry.0));
        Ok(Pose {
            rotation: rounded_rotation(matrix).map_err(|e| fault(&e.to_string()))?,
            center: DVec3::from(center.map(|x| x.0)),
        })
    }
}

impl RawScene {
    fn version(&self, warnings: &mut Vec<String>) -> Result<Version, Fault> {
        let numbers = <[Number; 3]>::try_from(&self.version)
            .map_err(|()| broken("its version is not three numbers".to_owned()))?;
        // Negative and huge ones saturate, which is as wrong as they are.
        let version = Version(numbers.map(|n| n.0 as u32));
        if version > KNOWN {
            let [major, minor, revision] = version.0;
            warnings.push(format!(
                "it is of version {major}.{minor}.{revision}, newer than 1.2.11, which fragscale knows: \
                 compare the focal lengths"
            ));
        }
        Ok(version)
    }

    /// The poses by their ids.
    fn poses(&self) -> Result<HashMap<&Id, Pose>, Fault> {
        let mut poses = HashMap::new();
        for raw in &self.poses.0 {
            let pose = raw.pose.transform.pose("pose", &raw.pose_id.0)?;
            if poses.insert(&raw.pose_id, pose).is_some() {
                return Err(broken(format!("the poseId {} stands twice", raw.pose_id.0)));
            }
        }
        Ok(poses)
    }

    /// The pose of a view, where it was aligned.
    fn pose_of(&self, view: &RawView, poses: &HashMap<&Id, Pose>) -> Result<Option<Pose>, Fault> {
        let Some(&pose) = view.pose_id.as_ref().and_then(|id| poses.get(id)) else {
            return Ok(None);
        };
        let independent = view.is_pose_independant.as_ref().is_none_or(Id::is_true);
        let rig_id = view
            .rig_id
            .as_ref()
            .filter(|id| !id.is_undefined() && !independent);
        let Some(rig_id) = rig_id else {
            return Ok(Some(pose));
        };
        let rig = self.rigs.0.iter().find(|rig| rig.rig_id == *rig_id);
        let sub_pose = rig.zip(view.sub_pose_id).and_then(|(rig, Number(index))| {
            let is_index = index >= 0.0 && index.fract() == 0.0;
            is_index
                .then(|| rig.sub_poses.0.get(index as usize))
                .flatten()
        });
        let Some(sub_pose) = sub_pose.filter(|sub| sub.status != "uninitialized") else {
            return Ok(None);
        };
        let in_rig = sub_pose.pose.pose("sub-pose of rig", &rig_id.0)?;
        Ok(Some(pose.carrying(&in_rig)))
    }

    /// What the views' photos are called.
    fn names(&self) -> Vec<String> {
        let last = |path: &str| last_segment(path).to_owned();
        let mut seen = HashSet::new();
        let mut shared = HashSet::new();
        for view in &self.views.0 {
            if !seen.insert(last(&view.path)) {
                shared.insert(last(&view.path));
            }
        }
        let mut paths = HashSet::new();
        let name = |view: &RawView| {
            let last = last(&view.path);
            if !last.is_empty() && !shared.contains(&last) {
                return last;
            }
            if !view.path.is_empty() && paths.insert(view.path.clone()) {
                return view.path.clone();
            }
            format!("{NO_PATH}{}", view.view_id.0)
        };
        self.views.0.iter().map(name).collect()
    }
}

#[cfg(test)]
mod tests;
