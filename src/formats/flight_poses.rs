//! What a flight.toml may name as `[photos] poses`: a poses.csv, or poses over time (a trajectory, a
//! ROS recording), which the image files in `[photos] folder` take by the stamps in their names.
//!
//! Poses over time name no camera, so the flight has one. Where they are those of a body, the camera's
//! file must say where it sits on it (EuRoC's sensor.yaml, T_BS).

use std::fs;
use std::path::{Path, PathBuf};

use super::input::{FileError, read_bytes};
use super::trajectory::{Moving, PosedFiles, chained};
use super::{
    Kind, Package, PoseLine, PosesFile, detect, poses_csv, read_camera_mount, read_trajectory, ros,
};
use crate::camera::Pose;
use crate::fault::Fault;
use crate::flight::{CameraEntry, CameraSource};
use crate::jobs::Progress;

/// The endings of image files, in lower case.
const IMAGES: [&str; 5] = ["jpg", "jpeg", "png", "tif", "tiff"];

/// What poses over time are for.
pub(super) struct PhotosToPose<'a> {
    /// The folder of flight.toml, which paths are relative to.
    pub(super) flight_folder: &'a Path,
    /// Its cameras.
    pub(super) cameras: &'a [CameraEntry],
    /// The folder of the image files.
    pub(super) folder: Option<PathBuf>,
}

/// Reads the poses of a flight's photos.
///
/// # Errors
/// With the file and the place in it, where no image file gets a pose, and where a camera has to be
/// said.
pub(super) fn read(
    path: &Path,
    photos: &PhotosToPose<'_>,
    progress: &Progress,
) -> Result<PosesFile, FileError> {
    let at = |fault| FileError::new(path, fault);
    let (posed, warnings) = match detect(path) {
        Ok(Kind::Trajectory(format)) => {
            let trajectory = read_trajectory(path, format, progress)?;
            let mut posed = trajectory.pose_files(&photos.files(path)?).map_err(at)?;
            if trajectory.moving == Moving::Body {
                let mount = photos.mount(path)?;
                for (_, pose) in &mut posed.photos {
                    *pose = chained(pose, &mount);
                }
                (posed, Vec::new())
            } else {
                (posed, trajectory.warnings)
            }
        }
        Ok(Kind::Reconstruction(Package::Ros, folder)) => {
            let files = photos.files(path)?;
            let recording = ros::read(&folder, progress)?;
            (recording.pose_files(&files).map_err(at)?, Vec::new())
        }
        // Whatever else it is, its faults are those of a poses.csv.
        _ => return poses_csv::read(&read_bytes(path)?).map_err(at),
    };
    if photos.cameras.len() > 1 {
        return Err(at(Fault::new(
            "the flight has several cameras, and poses over time name none",
            "keep one [[camera]], or write a poses.csv with a column camera",
        )));
    }
    Ok(poses_file(posed, warnings))
}

fn poses_file(posed: PosedFiles, mut warnings: Vec<String>) -> PosesFile {
    warnings.extend(posed.warnings);
    let lines = posed.photos.into_iter().zip(1..);
    PosesFile {
        lines: lines
            .map(|((photo, pose), line)| PoseLine {
                photo,
                camera: None,
                pose,
                line,
            })
            .collect(),
        warnings,
    }
}

impl PhotosToPose<'_> {
    /// The names of the image files, sorted.
    fn files(&self, poses: &Path) -> Result<Vec<String>, FileError> {
        let Some(folder) = &self.folder else {
            return Err(FileError::new(
                poses,
                Fault::new(
                    "these are poses over time: the photos are the image files called by their stamps",
                    "name their folder as [photos] folder",
                ),
            ));
        };
        let entries = fs::read_dir(folder).map_err(|e| {
            let what = format!("the folder of the photos cannot be read ({e})");
            FileError::new(folder, Fault::new(what, "correct [photos] folder"))
        })?;
        let names = entries
            .flatten()
            .filter_map(|entry| entry.file_name().into_string().ok());
        let is_image = |name: &String| {
            let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
            IMAGES.contains(&ending.to_ascii_lowercase().as_str())
        };
        let mut names: Vec<String> = names.filter(is_image).collect();
        names.sort_unstable();
        Ok(names)
    }

    /// Where the flight's camera sits on the body.
    fn mount(&self, poses: &Path) -> Result<Pose, FileError> {
        let entry = self.cameras.first();
        let source = entry
            .map(CameraEntry::source)
            .transpose()
            .map_err(|fault| FileError::new(poses, fault))?;
        let mount = match source {
            Some(CameraSource::File(name)) => read_camera_mount(&self.flight_folder.join(name))?,
            _ => None,
        };
        mount.ok_or_else(|| {
            FileError::new(
                poses,
                Fault::new(
                    "its poses are those of the body, and the camera does not say where it sits on it (T_BS)",
                    "name the camera's own sensor.yaml as [[camera]] file, or write a trajectory of the camera",
                ),
            )
        })
    }
}
