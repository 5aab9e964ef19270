//! The packages whose reconstructions are read: how each is recognised, and which reader takes it.
//!
//! One line a package in each of the three places: a file is recognised by its name or its first
//! bytes, a folder by what lies in it.

use std::path::{Path, PathBuf};

use super::input::{FileError, read_text};
use super::reconstruction::Project;
use super::{colmap, nvm, odm, ros};
use crate::jobs::Progress;

/// What wrote a reconstruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Package {
    /// COLMAP's model folder.
    Colmap,
    /// OpenDroneMap's project folder.
    OpenDroneMap,
    /// VisualSFM's .nvm.
    VisualSfm,
    /// A recording of ROS: a bag, a rosbag2 folder, .db3 or .mcap.
    Ros,
}

impl Package {
    /// What it is, for people.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Colmap => "a COLMAP reconstruction",
            Self::OpenDroneMap => "an OpenDroneMap project",
            Self::VisualSfm => "a VisualSFM reconstruction",
            Self::Ros => "a ROS recording",
        }
    }
}

/// Recognises a file; `start` is its first 4096 bytes at most. The path is that of what has to be
/// read: the folder where the file is one of several that belong together.
pub(super) fn of_file(path: &Path, start: &[u8]) -> Option<(Package, PathBuf)> {
    let text = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
    let this = |package| Some((package, path.to_owned()));
    if text.starts_with(b"NVM_V3") || name.ends_with(".nvm") {
        return this(Package::VisualSfm);
    }
    if ros::is_recording(start, &name) {
        return this(Package::Ros);
    }
    let of_colmap = ["cameras", "images", "points3d"]
        .map(|part| [format!("{part}.bin"), format!("{part}.txt")]);
    if of_colmap.as_flattened().contains(&name) {
        let model = colmap::model_folder(path.parent()?)?;
        return Some((Package::Colmap, model));
    }
    None
}

/// Recognises a folder.
pub(super) fn of_folder(path: &Path) -> Option<(Package, PathBuf)> {
    if odm::is_odm_folder(path) {
        return Some((Package::OpenDroneMap, path.to_owned()));
    }
    if ros::is_recording_folder(path) {
        return Some((Package::Ros, path.to_owned()));
    }
    Some((Package::Colmap, colmap::model_folder(path)?))
}

/// Reads what the package wrote.
pub(super) fn read(
    package: Package,
    path: &Path,
    progress: &Progress,
) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    match package {
        Package::Colmap => colmap::read_folder(path).map(Project::from),
        Package::OpenDroneMap => odm::read_folder(path),
        Package::VisualSfm => nvm::read(&read_text(path)?).map(Project::from).map_err(at),
        Package::Ros => {
            let recording = ros::read(path, progress)?;
            recording.reconstruction().map(Project::from).map_err(at)
        }
    }
}
