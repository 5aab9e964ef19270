//! The packages whose reconstructions are read: how each is recognised, and which reader takes it.
//!
//! One line a package in each of the three places: a file is recognised by its name or its first
//! bytes, a folder by what lies in it.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::input::{FileError, read_bytes, read_text};
use super::reconstruction::Project;
use super::{
    DETECTED_BY, blocks_exchange, bundler, colmap, drone_photos, json_packages, meshroom,
    metashape, middlebury, nerfstudio, nvm, odm, open3d, opensfm, opf, pix4d, realitycapture, ros,
};
use crate::jobs::Progress;

/// How many files of a folder are looked into.
const LOOKED_AT: usize = 200;

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

/// Recognises a folder.
pub(super) fn of_folder(path: &Path) -> Option<(Package, PathBuf)> {
    if odm::is_project(path) {
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
    let files = [
        (Package::OpenSfm, opensfm::dataset_file(path)),
        (Package::Bundler, bundler::bundle_of_folder(path)),
        (Package::Nerfstudio, nerfstudio::transforms_of_folder(path)),
        (Package::Meshroom, only_file(path, ".sfm")),
        (Package::Middlebury, only_file(path, "_par.txt")),
    ];
    let found = |(package, file): (Package, Option<PathBuf>)| Some((package, file?));
    if let Some(found) = files.into_iter().find_map(found) {
        return Some(found);
    }
    match in_folder(path).as_slice() {
        [] => {}
        [only] => return Some(only.clone()),
        // Which one is meant must be said.
        _ => return None,
    }
    // Last, because beside a .p4d there may lie what another package made of the same photos, and
    // beside what a package made there are often its photos.
    if pix4d::is_bare_project(path) {
        return Some((Package::Pix4d, path.to_owned()));
    }
    drone_photos::has_photos(path).then(|| (Package::Photos, path.to_owned()))
}

/// The reconstructions that lie as files in a folder that is none itself.
pub(super) fn in_folder(folder: &Path) -> Vec<(Package, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<(Package, PathBuf)> = entries
        .map(|entry| entry.path())
        .filter(|path| path.is_file() && !drone_photos::is_photo(path))
        .take(LOOKED_AT)
        .filter_map(|path| {
            let mut start = Vec::new();
            let file = fs::File::open(&path).ok()?;
            file.take(DETECTED_BY as u64).read_to_end(&mut start).ok()?;
            of_file(&path, &start)
        })
        .collect();
    found.sort_by(|(_, a), (_, b)| a.cmp(b));
    found.dedup();
    found
}

/// The file of a folder whose name ends so, where there is only one.
fn only_file(folder: &Path, end: &str) -> Option<PathBuf> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let mut found = entries.map(|entry| entry.path()).filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.to_ascii_lowercase().ends_with(end) && path.is_file()
    });
    found.next().filter(|_| found.next().is_none())
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
    use super::*;

    #[test]
    fn folders_are_told_by_what_lies_in_them() {
        for (file, package) in [
            ("opensfm/reconstruction.json", Package::OpenSfm),
            ("reconstruction.json", Package::OpenSfm),
            ("reconstruction_example.json", Package::OpenSfm),
            ("bundle/bundle.out", Package::Bundler),
            ("transforms.json", Package::Nerfstudio),
            ("cameras.sfm", Package::Meshroom),
            ("templeR_par.txt", Package::Middlebury),
            (
                "submodels/submodel_0000/odm_report/shots.geojson",
                Package::OpenDroneMap,
            ),
        ] {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, "[").unwrap();
            let found = of_folder(dir.path());
            assert_eq!(found.map(|(package, _)| package), Some(package), "{file}");
        }
        let dir = tempfile::tempdir().unwrap();
        assert_eq!(of_folder(dir.path()), None);
        // Under another name it is still the only one in the folder; of two neither is meant.
        let model = dir.path().join("model.nvm");
        fs::write(&model, "NVM_V3").unwrap();
        fs::write(dir.path().join("notes.txt"), "1 2 3").unwrap();
        assert_eq!(of_folder(dir.path()), Some((Package::VisualSfm, model)));
        fs::write(dir.path().join("other.nvm"), "NVM_V3").unwrap();
        assert_eq!(of_folder(dir.path()), None);
        assert_eq!(in_folder(dir.path()).len(), 2);
        let dir = tempfile::tempdir().unwrap();
        for name in ["a_par.txt", "b_par.txt"] {
            fs::write(dir.path().join(name), "").unwrap();
        }
        assert_eq!(of_folder(dir.path()), None);
    }

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
