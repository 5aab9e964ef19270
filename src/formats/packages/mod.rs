//! Cameras and posed photos as photogrammetry packages and recordings hold them.
//!
//! A package is a folder here and a row in the list below; besides, README's table has a line for it. Which
//! of several in a folder is meant, where one makes the files of another, says candidates/.

pub(crate) mod blocks_exchange;
pub(crate) mod bundler;
pub(crate) mod colmap;
pub(crate) mod drone_photos;
mod file_start;
pub(crate) mod meshroom;
pub(crate) mod metashape;
pub(crate) mod middlebury;
pub(crate) mod nerfstudio;
pub(crate) mod nvm;
pub(crate) mod odm;
pub(crate) mod open3d;
pub(crate) mod opensfm;
pub(crate) mod opf;
pub(crate) mod pix4d;
pub(crate) mod pose_covariance;
pub(crate) mod realitycapture;
pub(crate) mod reconstruction;
pub mod ros;

use std::path::{Path, PathBuf};

use self::file_start::FileStart;
use self::reconstruction::{Project, Reconstruction};
use crate::fault::Fault;
use crate::files::{FileError, read_bytes, read_text};
use crate::jobs::Progress;
use crate::photos::photos_below;

/// How many entries of a folder are looked at.
pub(crate) const LOOKED_AT: usize = 200;

/// How many bytes of a file are looked at to tell its kind.
pub(crate) const DETECTED_BY: usize = 4096;

/// What is known of a package.
struct Row {
    /// Its name, for lists.
    name: &'static str,
    /// What it wrote, for people.
    words: &'static str,
    /// Recognises a file; the path is that of what has to be read, which may be a folder.
    of_file: fn(&FileStart<'_>) -> Option<PathBuf>,
    /// What lies in a folder as the package lays it out, each as it has to be read.
    of_folder: fn(&Path) -> Vec<PathBuf>,
    /// Whether a folder with nothing else in it is the package's.
    of_bare_folder: fn(&Path) -> bool,
    /// Reads what it wrote.
    read: fn(&Path, &Progress) -> Result<Project, FileError>,
}

/// Writes the list of the packages from one row for each. They are asked in this order: what is
/// distinctive comes first.
macro_rules! packages {
    ($($(#[$doc:meta])* $package:ident { $($row:tt)* })*) => {
        /// What wrote a reconstruction.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Package {
            $($(#[$doc])* $package,)*
        }

        impl Package {
            const ALL: &[Self] = &[$(Self::$package),*];

            fn row(self) -> &'static Row {
                match self {
                    $(Self::$package => {
                        const ROW: Row = Row { $($row)* };
                        &ROW
                    })*
                }
            }
        }
    };
}

packages! {
    /// OpenDroneMap's project folder.
    OpenDroneMap {
        name: "OpenDroneMap",
        words: "an OpenDroneMap project",
        of_file: no_file,
        of_folder: |folder| whole(folder, odm::is_project(folder)),
        of_bare_folder: never,
        read: |path, _| odm::read_folder(path),
    }
    /// VisualSFM's .nvm.
    VisualSfm {
        name: "VisualSFM",
        words: "a VisualSFM reconstruction",
        of_file: |file| file.is(file.text.starts_with(b"NVM_V3") || file.name.ends_with(".nvm")),
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| of_text(path, nvm::read),
    }
    /// Agisoft Metashape's cameras.xml, .psx or .psz.
    Metashape {
        name: "Metashape",
        words: "a Metashape project",
        of_file: |file| file.is(metashape::is_project(&file.name, file.text)),
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| metashape::read_project(path),
    }
    /// Bentley's BlocksExchange XML.
    ContextCapture {
        name: "ContextCapture",
        words: "a ContextCapture block",
        of_file: |file| file.is(file.has("<BlocksExchange")),
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| of_text(path, blocks_exchange::read),
    }
    /// RealityCapture's CSV of cameras.
    RealityCaptureCsv {
        name: "RealityCapture's CSV",
        words: "RealityCapture's cameras",
        of_file: |file| {
            let text = String::from_utf8_lossy(file.text);
            file.is(text.lines().take(3).any(realitycapture::is_header))
        },
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| of_text(path, realitycapture::read_csv),
    }
    /// The folder of RealityCapture's XMP sidecars.
    RealityCaptureXmp {
        name: "RealityCapture's XMP",
        words: "RealityCapture's cameras",
        of_file: |file| {
            let is_one = file.name.ends_with(".xmp") && file.has("capturingreality.com/ns/xcr");
            file.path.parent().filter(|_| is_one).map(Path::to_owned)
        },
        of_folder: |folder| whole(folder, realitycapture::has_sidecars(folder)),
        of_bare_folder: never,
        read: |path, _| realitycapture::read_folder(path),
    }
    /// Pix4D's Open Photogrammetry Format.
    Opf {
        name: "OPF",
        words: "an OPF project",
        of_file: |file| {
            if file.has("\"application/opf-project+json\"") {
                return file.is(true);
            }
            let is_part = file.has("\"application/opf-");
            file.path.parent().filter(|_| is_part).and_then(opf::project_in)
        },
        of_folder: |folder| opf::project_in(folder).into_iter().collect(),
        of_bare_folder: never,
        read: |path, _| opf::read(path),
    }
    /// Pix4Dmapper's params folder or project.
    Pix4d {
        name: "Pix4D",
        words: "a Pix4D calibration",
        of_file: |file| file.is(pix4d::is_pix4d_file(file.path, &file.name)),
        of_folder: |folder| whole(folder, pix4d::has_params(folder)),
        // Beside a .p4d there may lie what another package made of the same photos.
        of_bare_folder: pix4d::is_bare_project,
        read: |path, _| pix4d::read(path),
    }
    /// A recording of ROS: a bag, a rosbag2 folder, .db3 or .mcap.
    Ros {
        name: "ROS",
        words: "a ROS recording",
        of_file: |file| file.is(ros::is_recording(file.bytes, &file.name)),
        of_folder: |folder| whole(folder, ros::is_recording_folder(folder)),
        of_bare_folder: never,
        read: |path, progress| {
            let recording = ros::read(path, progress)?;
            let found = recording.reconstruction().map(Project::from);
            found.map_err(|fault| FileError::new(path, fault))
        },
    }
    /// Bundler's bundle.out.
    Bundler {
        name: "Bundler",
        words: "a Bundler reconstruction",
        of_file: |file| file.is(bundler::is_bundle(file.text, &file.name)),
        of_folder: |folder| bundler::bundle_of_folder(folder).into_iter().collect(),
        of_bare_folder: never,
        read: |path, _| bundler::read_file(path),
    }
    /// Middlebury's multi-view benchmark's _par.txt.
    Middlebury {
        name: "Middlebury",
        words: "Middlebury camera parameters",
        of_file: |file| file.is(file.name.ends_with("_par.txt")),
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| of_text(path, middlebury::read),
    }
    /// OpenSfM's reconstruction.json.
    OpenSfm {
        name: "OpenSfM",
        words: "an OpenSfM reconstruction",
        of_file: |file| file.is(file.json().is_list_of(&["shots"])),
        of_folder: |folder| opensfm::dataset_file(folder).into_iter().collect(),
        of_bare_folder: never,
        read: |path, _| opensfm::read_file(path),
    }
    /// Meshroom's .sfm, which AliceVision writes.
    Meshroom {
        name: "Meshroom",
        words: "a Meshroom scene",
        of_file: |file| {
            let of_scene = ["intrinsics", "poses", "structure", "version"];
            let is_json = || of_scene.iter().any(|key| file.json().has(&["views", key]));
            file.is(meshroom::is_scene(file.text, &file.name) || is_json())
        },
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| meshroom::read_file(path),
    }
    /// transforms.json, which nerfstudio and instant-ngp read.
    Nerfstudio {
        name: "nerfstudio",
        words: "nerfstudio's transforms",
        of_file: |file| file.is(file.json().has(&["frames"])),
        of_folder: |folder| nerfstudio::transforms_of_folder(folder).into_iter().collect(),
        of_bare_folder: never,
        read: |path, _| nerfstudio::read_file(path),
    }
    /// Open3D's trajectory or parameters of a camera.
    Open3d {
        name: "Open3D",
        words: "an Open3D camera trajectory",
        of_file: |file| {
            let of_open3d = [["extrinsic", "intrinsic"], ["class_name", "parameters"]];
            file.is(of_open3d.iter().any(|pair| file.json().has(pair)))
        },
        of_folder: nothing,
        of_bare_folder: never,
        read: |path, _| {
            let found = open3d::read(&read_bytes(path)?).map(Project::from);
            found.map_err(|fault| FileError::new(path, fault))
        },
    }
    /// COLMAP's model folder.
    Colmap {
        name: "COLMAP",
        words: "a COLMAP reconstruction",
        of_file: |file| {
            let folder = file.path.parent().filter(|_| colmap::is_part(&file.name));
            folder.and_then(colmap::model_folder)
        },
        of_folder: |folder| colmap::models_in(folder, LOOKED_AT),
        of_bare_folder: never,
        read: |path, _| colmap::read_folder(path).map(Project::from),
    }
    /// Photos with nothing beside them, placed by their own EXIF and XMP.
    Photos {
        name: "photos alone",
        words: "photos",
        of_file: |file| {
            let mut magics = [&b"\xff\xd8\xff"[..], b"\x89PNG"].into_iter();
            let is_image = magics.any(|magic| file.bytes.starts_with(magic));
            file.is(photos_below::is_photo(file.path) && is_image)
        },
        of_folder: nothing,
        // Beside what a package made there are often its photos.
        of_bare_folder: photos_below::has_photos,
        read: drone_photos::read,
    }
}

impl Package {
    /// What it is, for people.
    pub fn in_words(self) -> &'static str {
        self.row().words
    }

    /// Its name, for lists.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Reads what it wrote.
    pub(crate) fn read(self, path: &Path, progress: &Progress) -> Result<Project, FileError> {
        (self.row().read)(path, progress)
    }
}

/// Recognises a file; `start` is its first 4096 bytes at most. The path is that of what has to be
/// read: the folder where the file is one of several that belong together.
pub(crate) fn of_file(path: &Path, start: &[u8]) -> Option<(Package, PathBuf)> {
    let file = FileStart::new(path, start)?;
    let mut packages = Package::ALL.iter();
    packages.find_map(|&package| Some((package, (package.row().of_file)(&file)?)))
}

/// What the packages' own ways to lay out a folder show in it.
pub(crate) fn of_folder(folder: &Path) -> Vec<(Package, PathBuf)> {
    let of_package = |&package: &Package| {
        let found = (package.row().of_folder)(folder).into_iter();
        found.map(move |path| (package, path))
    };
    Package::ALL.iter().flat_map(of_package).collect()
}

/// Whose a folder is that shows nothing else.
pub(crate) fn of_bare_folder(folder: &Path) -> Option<Package> {
    let mut packages = Package::ALL.iter().copied();
    packages.find(|package| (package.row().of_bare_folder)(folder))
}

fn no_file(_: &FileStart<'_>) -> Option<PathBuf> {
    None
}

fn nothing(_: &Path) -> Vec<PathBuf> {
    Vec::new()
}

fn never(_: &Path) -> bool {
    false
}

/// The folder itself, where it is the package's.
fn whole(folder: &Path, is_its: bool) -> Vec<PathBuf> {
    is_its.then(|| folder.to_owned()).into_iter().collect()
}

/// Of a package that writes one text.
fn of_text(
    path: &Path,
    read: fn(&str) -> Result<Reconstruction, Fault>,
) -> Result<Project, FileError> {
    let found = read(&read_text(path)?).map(Project::from);
    found.map_err(|fault| FileError::new(path, fault))
}

#[cfg(test)]
mod tests;
