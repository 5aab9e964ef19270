//! The packages whose reconstructions are read: how each is recognised, and which reader takes it.
//!
//! One line a package in each of the places: a file is recognised by its name or its first bytes, a
//! folder by what lies in it (candidates.rs).

use std::path::{Path, PathBuf};

use crate::files::{FileError, read_bytes, read_text};
use crate::jobs::Progress;
use crate::packages::blocks_exchange;
use crate::packages::bundler;
use crate::packages::colmap;
use crate::packages::drone_photos;
use crate::packages::json_packages;
use crate::packages::meshroom;
use crate::packages::metashape;
use crate::packages::middlebury;
use crate::packages::nerfstudio;
use crate::packages::nvm;
use crate::packages::odm;
use crate::packages::open3d;
use crate::packages::opensfm;
use crate::packages::opf;
use crate::packages::pix4d;
use crate::packages::realitycapture;
use crate::packages::reconstruction::Project;
use crate::packages::ros;

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
    /// OpenSfM's reconstruction.json.
    OpenSfm,
    /// Bundler's bundle.out.
    Bundler,
    /// Meshroom's .sfm, which AliceVision writes.
    Meshroom,
    /// transforms.json, which nerfstudio and instant-ngp read.
    Nerfstudio,
    /// Open3D's trajectory or parameters of a camera.
    Open3d,
    /// The Middlebury multi-view benchmark's _par.txt.
    Middlebury,
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
            Self::OpenSfm => "an OpenSfM reconstruction",
            Self::Bundler => "a Bundler reconstruction",
            Self::Meshroom => "a Meshroom scene",
            Self::Nerfstudio => "nerfstudio's transforms",
            Self::Open3d => "an Open3D camera trajectory",
            Self::Middlebury => "Middlebury camera parameters",
        }
    }

    /// Its name, for lists.
    pub fn name(self) -> &'static str {
        match self {
            Self::ContextCapture => "ContextCapture",
            Self::Colmap => "COLMAP",
            Self::Metashape => "Metashape",
            Self::OpenDroneMap => "OpenDroneMap",
            Self::Opf => "OPF",
            Self::Pix4d => "Pix4D",
            Self::RealityCaptureCsv => "RealityCapture's CSV",
            Self::RealityCaptureXmp => "RealityCapture's XMP",
            Self::VisualSfm => "VisualSFM",
            Self::Photos => "photos alone",
            Self::Ros => "ROS",
            Self::OpenSfm => "OpenSfM",
            Self::Bundler => "Bundler",
            Self::Meshroom => "Meshroom",
            Self::Nerfstudio => "nerfstudio",
            Self::Open3d => "Open3D",
            Self::Middlebury => "Middlebury",
        }
    }
}

/// Recognises a file; `start` is its first 4096 bytes at most. The path is that of what has to be
/// read: the folder where the file is one of several that belong together.
pub(crate) fn of_file(path: &Path, start: &[u8]) -> Option<(Package, PathBuf)> {
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
    if bundler::is_bundle(text, &name) {
        return this(Package::Bundler);
    }
    if meshroom::is_scene(text, &name) {
        return this(Package::Meshroom);
    }
    if name.ends_with("_par.txt") {
        return this(Package::Middlebury);
    }
    if let Some(package) = json_packages::of_file(path, text) {
        return this(package);
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

/// Reads what the package wrote.
pub(crate) fn read(
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
        Package::OpenSfm => opensfm::read_file(path),
        Package::Bundler => bundler::read_file(path),
        Package::Meshroom => meshroom::read_file(path),
        Package::Nerfstudio => nerfstudio::read_file(path),
        Package::Open3d => open3d::read(&read_bytes(path)?)
            .map(Project::from)
            .map_err(at),
        Package::Middlebury => middlebury::read(&read_text(path)?)
            .map(Project::from)
            .map_err(at),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_are_told_by_their_beginning_or_name() {
        for (name, start, package) in [
            ("x.out", "# Bundle file v0.3\n", Package::Bundler),
            ("synth_0.out", "drews 1.0\n", Package::Bundler),
            ("cameras.sfm", "{", Package::Meshroom),
            ("sfm.abc", "Ogawa", Package::Meshroom),
            ("dino_par.txt", "16\n", Package::Middlebury),
            ("x.json", r#"[{"shots": {}}]"#, Package::OpenSfm),
            ("x.json", r#"{"views": [], "poses": []}"#, Package::Meshroom),
            (
                "transforms_train.json",
                r#"{"frames": []}"#,
                Package::Nerfstudio,
            ),
            (
                "x.json",
                r#"{"intrinsic": {}, "extrinsic": []}"#,
                Package::Open3d,
            ),
        ] {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join(name);
            fs::write(&path, start).unwrap();
            let found = of_file(&path, start.as_bytes());
            assert_eq!(found, Some((package, path)), "{name}");
        }
    }
}
