//! Which reconstructions a folder holds, and which of them is meant: the only one, or the one that the
//! others were made into. Where there are several, none is taken for another; the choice is the
//! engineer's.
//!
//! A folder is looked into as its packages lay it out (packages/mod.rs); only where nothing lies in it
//! itself, its folders are looked into, two levels down. Pictures above a flight that do not say where they were taken
//! (screenshots, sketches) are nothing.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::FileError;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::packages::{
    self, DETECTED_BY, LOOKED_AT, Package, colmap, drone_photos, odm, opensfm, pix4d,
};
use crate::photos::photos_below;

/// How many folders below one are looked into, over both levels.
const MOST_FOLDERS: usize = 200;

/// How many candidates are named in an error, and counted.
const NAMED: usize = 8;

/// The most bytes that are read to count the photos of one reconstruction.
const COUNTED_BYTES: u64 = 32 << 20;

/// The most bytes that are read to count all of them.
const COUNTED_BYTES_IN_ALL: u64 = 128 << 20;

/// A flight or reconstruction that may be meant by a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// What wrote it; `None` for a flight.toml.
    pub package: Option<Package>,
    /// What to open: a file, or the folder that its files lie in.
    pub path: PathBuf,
    /// How many photos it places; `None` where counting would take long, or it cannot be read.
    pub photos: Option<usize>,
}

impl Candidate {
    /// As in a list below `folder`: "sparse/0: COLMAP, 26 photos".
    pub fn in_words(&self, folder: &Path) -> String {
        let inside = self.path.strip_prefix(folder).unwrap_or(&self.path);
        let place = if inside.as_os_str().is_empty() {
            ".".to_owned()
        } else {
            inside.to_string_lossy().replace('\\', "/")
        };
        let name = self.package.map_or("fragscale", Package::name);
        match self.photos {
            Some(1) => format!("{place}: {name}, 1 photo"),
            Some(count) => format!("{place}: {name}, {count} photos"),
            None => format!("{place}: {name}"),
        }
    }
}

/// A candidate before its photos are counted.
pub(crate) type Found = (Option<Package>, PathBuf);

/// What lies in a folder.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Contents {
    /// The reconstructions of which one is meant.
    pub(crate) meant: Vec<(Package, PathBuf)>,
    /// What they were made of, or made beside: not meant themselves.
    pub(crate) sources: Vec<(Package, PathBuf)>,
}

impl Contents {
    /// Looks into a folder, not into its folders beyond where a package keeps its own files.
    pub(crate) fn of(folder: &Path) -> Self {
        let mut found = packages::of_folder(folder);
        let known: Vec<PathBuf> = found.iter().map(|(_, path)| path.clone()).collect();
        found.extend(in_files(folder, &known));
        found.sort_by(|(_, a), (_, b)| a.cmp(b));
        found.dedup();
        let all = found.clone();
        found.retain(|one| !all.iter().any(|whole| is_part_of(one, whole)));
        let all = found.clone();
        let is_source = |one: &(Package, PathBuf)| all.iter().any(|whole| is_made_into(one, whole));
        let (sources, meant) = found.into_iter().partition(is_source);
        let mut contents = Self { meant, sources };
        if contents.meant.is_empty() {
            let bare = packages::of_bare_folder(folder);
            let bare = bare.map(|package| (package, folder.to_owned()));
            contents.meant.extend(bare);
        }
        contents
    }

    /// A sentence about what was not taken beside the one that was; `None` where there is nothing.
    pub(crate) fn sources_in_words(&self, folder: &Path) -> Option<String> {
        let ([(package, _)], [_, ..]) = (self.meant.as_slice(), self.sources.as_slice()) else {
            return None;
        };
        let mut names: Vec<String> = self
            .sources
            .iter()
            .take(NAMED)
            .map(|(source, path)| {
                let inside = path.strip_prefix(folder).unwrap_or(path);
                let inside = inside.to_string_lossy().replace('\\', "/");
                format!("{inside} ({})", source.name())
            })
            .collect();
        if self.sources.len() > NAMED {
            names.push(format!("{} more", self.sources.len() - NAMED));
        }
        Some(format!(
            "{} is taken; {} in the folder went into it or came from it",
            package.in_words(),
            names.join(", ")
        ))
    }
}

/// The reconstructions of which one is meant by a folder itself.
pub(crate) fn meant_in(folder: &Path) -> Vec<(Package, PathBuf)> {
    let meant = Contents::of(folder).meant;
    let are_loose = !meant.is_empty()
        && are_photos(&meant)
        && !drone_photos::has_placed(folder)
        && below(folder)
            .iter()
            .any(|(package, _)| *package != Some(Package::Photos));
    if are_loose { Vec::new() } else { meant }
}

/// Whether these are mere photos.
fn are_photos(meant: &[(Package, PathBuf)]) -> bool {
    meant.iter().all(|(package, _)| *package == Package::Photos)
}

/// The reconstructions that lie as files in a folder, besides those that are `known`.
fn in_files(folder: &Path, known: &[PathBuf]) -> Vec<(Package, PathBuf)> {
    let mut files = entries(folder);
    files.retain(|path| path.is_file() && !photos_below::is_photo(path));
    files
        .into_iter()
        .take(LOOKED_AT)
        .filter(|path| !known.contains(path))
        .filter_map(|path| {
            if let Some(stage) = stage_of_opensfm(&path) {
                return Some((stage, path));
            }
            let mut start = Vec::new();
            let file = fs::File::open(&path).ok()?;
            file.take(DETECTED_BY as u64).read_to_end(&mut start).ok()?;
            packages::of_file(&path, &start)
        })
        .collect()
}

/// OpenSfM's stages beside its `reconstruction.json`, which are as large and need not be looked into.
fn stage_of_opensfm(path: &Path) -> Option<Package> {
    let name = path.file_name()?.to_str()?;
    let is_stage = name.starts_with("reconstruction.") && name.ends_with(".json");
    let whole = path.with_file_name(WHOLE_OF_OPENSFM);
    (is_stage && name != WHOLE_OF_OPENSFM && whole.is_file()).then_some(Package::OpenSfm)
}

const WHOLE_OF_OPENSFM: &str = "reconstruction.json";

/// The entries of a folder, by name.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort_unstable();
    paths
}

/// Whether `one` is a file that the folder `whole` stands for.
fn is_part_of(one: &(Package, PathBuf), whole: &(Package, PathBuf)) -> bool {
    let stands_for_it = match whole.0 {
        Package::Pix4d => true,
        // A bag of ROS 1 is no part of a recording of ROS 2.
        Package::Ros => one.1.extension().is_none_or(|end| end != "bag"),
        _ => false,
    };
    stands_for_it && one.0 == whole.0 && one.1 != whole.1 && one.1.starts_with(&whole.1)
}

/// Whether `one` is a part, an earlier stage or an export of `whole`, by the places where the packages
/// write them.
fn is_made_into(one: &(Package, PathBuf), whole: &(Package, PathBuf)) -> bool {
    let (package, path) = one;
    let (of_package, of_path) = whole;
    if path == of_path {
        return false;
    }
    let is_inside = path.starts_with(of_path);
    let is_beside = path.parent() == of_path.parent();
    let lower = |path: &Path| {
        let name = path.file_name().unwrap_or_default();
        name.to_string_lossy().to_ascii_lowercase()
    };
    let (name, of_name) = (lower(path), lower(of_path));
    match (of_package, package) {
        // It runs OpenSfM, in older versions Bundler, and exports Bundler's format.
        (Package::OpenDroneMap, Package::OpenSfm | Package::Bundler) => is_inside,
        (Package::OpenSfm, Package::OpenSfm) => {
            of_name == WHOLE_OF_OPENSFM && is_beside && name.starts_with("reconstruction.")
        }
        // The same cameras for undistorted photos.
        (Package::Bundler, Package::Bundler) => of_name == "bundle.out" && name == "bundle.rd.out",
        // Its parts for training, testing and validation.
        (Package::Nerfstudio, Package::Nerfstudio) => {
            of_name == "transforms.json" && is_beside && name.starts_with("transforms_")
        }
        // The same scene twice.
        (Package::Meshroom, Package::Meshroom) => {
            of_name.ends_with(".sfm") && is_beside && name.ends_with(".abc")
        }
        _ => false,
    }
}

/// The flights and reconstructions in the folders of a folder, else in theirs. Folders of mere photos
/// are listed only where there is nothing else.
pub(crate) fn below(folder: &Path) -> Vec<Found> {
    let mut found = Vec::new();
    let mut photos = Vec::new();
    let mut level = vec![folder.to_owned()];
    let mut left = MOST_FOLDERS;
    for _ in 0..2 {
        let mut next = Vec::new();
        for parent in level {
            let folders = entries(&parent).into_iter().take(LOOKED_AT);
            for folder in folders.filter(|path| path.is_dir()) {
                if left == 0 {
                    break;
                }
                left -= 1;
                let flight = folder.join("flight.toml");
                if flight.is_file() {
                    found.push((None, flight));
                    continue;
                }
                let contents = Contents::of(&folder).meant;
                if are_photos(&contents) {
                    next.push(folder);
                }
                for (package, path) in contents {
                    if package == Package::Photos {
                        photos.push((Some(package), path));
                    } else {
                        found.push((Some(package), path));
                    }
                }
            }
        }
        level = next;
    }
    if found.is_empty() { photos } else { found }
}

/// Counts the photos of the first of them.
pub(crate) fn counted(found: Vec<Found>) -> Vec<Candidate> {
    let mut left = COUNTED_BYTES_IN_ALL;
    found
        .into_iter()
        .enumerate()
        .map(|(index, (package, path))| {
            let photos = package
                .filter(|_| index < NAMED)
                .and_then(|package| photos_of(package, &path, &mut left));
            Candidate {
                package,
                path,
                photos,
            }
        })
        .collect()
}

/// How many photos a reconstruction places. `left` is what may still be read.
fn photos_of(package: Package, path: &Path, left: &mut u64) -> Option<usize> {
    let count = |is_one: fn(&Path) -> bool| {
        let paths = entries(path);
        paths.iter().filter(|path| is_one(path)).count()
    };
    let is_sidecar = |path: &Path| {
        let extension = path.extension().unwrap_or_default();
        extension.eq_ignore_ascii_case("xmp")
    };
    match package {
        Package::Photos if path.is_dir() => return Some(count(photos_below::is_photo)),
        Package::Photos => return Some(1),
        Package::RealityCaptureXmp => return Some(count(is_sidecar)),
        Package::Colmap => {
            if let Some(count) = colmap::count_of_images(path) {
                return Some(count);
            }
        }
        _ => {}
    }
    // What the reader will read, not what else lies there.
    let params = path.join(pix4d::PARAMS);
    let (read, levels) = match package {
        Package::Opf => (path.parent()?, 2),
        Package::Pix4d if params.is_dir() => (params.as_path(), 1),
        Package::OpenDroneMap => return odm::count_of_photos(path, take(left)),
        Package::OpenSfm => return opensfm::count_of_photos(path, take(left)),
        _ => (path, 3),
    };
    let bytes = size(read, levels, &mut { LOOKED_AT });
    if bytes > COUNTED_BYTES.min(*left) {
        return None;
    }
    *left -= bytes;
    let project = package.read(path, &Progress::default()).ok()?;
    Some(project.reconstruction.photos.len())
}

/// Takes what one reconstruction may read from what is left.
fn take(left: &mut u64) -> u64 {
    let most = COUNTED_BYTES.min(*left);
    *left -= most;
    most
}

/// The bytes below a path that a reader may read: not those of photos and dense clouds. More than can
/// be counted where there are more than `left` entries.
fn size(path: &Path, levels: usize, left: &mut usize) -> u64 {
    const NOT_READ: [&str; 8] = ["laz", "las", "ply", "obj", "glb", "tif", "tiff", "pdf"];
    let Ok(metadata) = path.metadata() else {
        return 0;
    };
    if metadata.is_file() {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let is_left_out = photos_below::is_photo(path)
            || NOT_READ
                .iter()
                .any(|end| extension.eq_ignore_ascii_case(end));
        let own = if is_left_out { 0 } else { metadata.len() };
        // Metashape's documents lie in a folder beside.
        let documents = path.with_extension("files");
        let is_psx = extension.eq_ignore_ascii_case("psx") && documents.is_dir();
        return if is_psx {
            own.saturating_add(size(&documents, 3, left))
        } else {
            own
        };
    }
    if levels == 0 {
        return 0;
    }
    let mut sum = 0_u64;
    for entry in entries(path) {
        if *left == 0 {
            return u64::MAX;
        }
        if photos_below::is_photo(&entry) {
            continue;
        }
        *left -= 1;
        sum = sum.saturating_add(size(&entry, levels - 1, left));
    }
    sum
}

/// Why a folder cannot be opened that holds `several` reconstructions.
pub(crate) fn several(folder: &Path, several: Vec<(Package, PathBuf)>) -> FileError {
    let found = several.into_iter().map(|(p, path)| (Some(p), path));
    let what = format!(
        "several reconstructions ({})",
        list(folder, &counted(found.collect()))
    );
    FileError::new(folder, Fault::new(what, "open one of them by its path"))
}

/// Names what lies in the folders of a folder that holds nothing itself; `None` where there is nothing.
pub(crate) fn only_below(folder: &Path) -> Option<FileError> {
    let found = below(folder);
    let remedy = match found.len() {
        0 => return None,
        1 => "open it by its path",
        _ => "open one of them by its path",
    };
    let what = format!(
        "a folder with no flight.toml and no reconstruction in it, but in its folders ({})",
        list(folder, &counted(found))
    );
    Some(FileError::new(folder, Fault::new(what, remedy)))
}

fn list(folder: &Path, candidates: &[Candidate]) -> String {
    let named = candidates.iter().take(NAMED);
    let mut names: Vec<String> = named.map(|one| one.in_words(folder)).collect();
    if candidates.len() > NAMED {
        names.push(format!("{} more", candidates.len() - NAMED));
    }
    names.join("; ")
}

#[cfg(test)]
mod tests;
