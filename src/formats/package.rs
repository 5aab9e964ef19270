//! The packages whose reconstructions are read: how each is recognised, and which reader takes it.
//!
//! One line a package in each of the three places: a file is recognised by its name or its first
//! bytes, a folder by what lies in it.

use std::path::{Path, PathBuf};

use super::input::{FileError, read_text};
use super::reconstruction::Project;
use super::{
    blocks_exchange, colmap, drone_photos, metashape, nvm, odm, opf, pix4d, realitycapture, ros,
};
use crate::jobs::Progress;

/// What wrote a reconstruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Package {
    /// Bentley's BlocksExchange XML.
    ContextCapture,
    /// COLMAP's model folder.
    Colmap,
    /// Agisoft Metashape's cameras.xml, .psx or .psz.
    Metashape,
    /// OpenDroneMap's project folder.
    OpenDroneMap,
    /// Pix4D's Open Photogrammetry Format.
    Opf,
    /// Pix4Dmapper's params folder or project.
    Pix4d,
    /// RealityCapture's CSV of cameras.
    RealityCaptureCsv,
    /// The folder of RealityCapture's XMP sidecars.
    RealityCaptureXmp,
    /// VisualSFM's .nvm.
    VisualSfm,
    /// Photos with nothing beside them, placed by their own EXIF and XMP.
    Photos,
    /// A recording of ROS: a bag, a rosbag2 folder, .db3 or .mcap.
    Ros,
}

impl Package {
    /// What it is, for people.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::ContextCapture => "a ContextCapture block",
            Self::Colmap => "a COLMAP reconstruction",
            Self::Metashape => "a Metashape project",
            Self::OpenDroneMap => "an OpenDroneMap project",
            Self::Opf => "an OPF project",
            Self::Pix4d => "a Pix4D calibration",
            Self::RealityCaptureCsv | Self::RealityCaptureXmp => "RealityCapture's cameras",
            Self::VisualSfm => "a VisualSFM reconstruction",
            Self::Photos => "photos",
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
    if metashape::is_project(&name, text) {
        return this(Package::Metashape);
    }
    if has(text, "<BlocksExchange") {
        return this(Package::ContextCapture);
    }
    if String::from_utf8_lossy(text)
        .lines()
        .take(3)
        .any(realitycapture::is_header)
    {
        return this(Package::RealityCaptureCsv);
    }
    if name.ends_with(".xmp") && has(text, "capturingreality.com/ns/xcr") {
        return Some((Package::RealityCaptureXmp, path.parent()?.to_owned()));
    }
    if has(text, "\"application/opf-project+json\"") {
        return this(Package::Opf);
    }
    if has(text, "\"application/opf-") {
        return Some((Package::Opf, opf::project_in(path.parent()?)?));
    }
    if pix4d::is_pix4d_file(path, &name) {
        return this(Package::Pix4d);
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
    if drone_photos::is_photo(path)
        && [&b"\xff\xd8\xff"[..], b"\x89PNG"]
            .iter()
            .any(|magic| start.starts_with(magic))
    {
        return this(Package::Photos);
    }
    None
}

/// Whether a word stands in the first bytes.
fn has(start: &[u8], word: &str) -> bool {
    start
        .windows(word.len())
        .any(|window| window == word.as_bytes())
}

/// Recognises a folder.
pub(super) fn of_folder(path: &Path) -> Option<(Package, PathBuf)> {
    if odm::is_odm_folder(path) {
        return Some((Package::OpenDroneMap, path.to_owned()));
    }
    if let Some(project) = opf::project_in(path) {
        return Some((Package::Opf, project));
    }
    if realitycapture::has_sidecars(path) {
        return Some((Package::RealityCaptureXmp, path.to_owned()));
    }
    if pix4d::has_params(path) {
        return Some((Package::Pix4d, path.to_owned()));
    }
    if ros::is_recording_folder(path) {
        return Some((Package::Ros, path.to_owned()));
    }
    if let Some(model) = colmap::model_folder(path) {
        return Some((Package::Colmap, model));
    }
    // Last, because beside a .p4d there may lie what another package made of the same photos, and
    // beside what a package made there are often its photos.
    if pix4d::is_bare_project(path) {
        return Some((Package::Pix4d, path.to_owned()));
    }
    drone_photos::has_photos(path).then(|| (Package::Photos, path.to_owned()))
}

/// Reads what the package wrote.
pub(super) fn read(
    package: Package,
    path: &Path,
    progress: &Progress,
) -> Result<Project, FileError> {
    let at = |fault| FileError::new(path, fault);
    match package {
        Package::ContextCapture => blocks_exchange::read(&read_text(path)?)
            .map(Project::from)
            .map_err(at),
        Package::Colmap => colmap::read_folder(path).map(Project::from),
        Package::Metashape => metashape::read_project(path),
        Package::OpenDroneMap => odm::read_folder(path),
        Package::Photos => drone_photos::read(path, progress),
        Package::Opf => opf::read(path),
        Package::Pix4d => pix4d::read(path),
        Package::RealityCaptureCsv => realitycapture::read_csv(&read_text(path)?)
            .map(Project::from)
            .map_err(at),
        Package::RealityCaptureXmp => realitycapture::read_folder(path),
        Package::VisualSfm => nvm::read(&read_text(path)?).map(Project::from).map_err(at),
        Package::Ros => {
            let recording = ros::read(path, progress)?;
            recording.reconstruction().map(Project::from).map_err(at)
        }
    }
}
