//! Which files of a folder are outlines of a photo, by their names.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};

use crate::files::{last_segment, unreadable_folder};
use crate::formats::{FileError, MaskFile};

/// More files are no folder of outlines.
const MOST_FILES: usize = 100_000;
/// How many files of many photos are looked into.
const MOST_OF_MANY: usize = 64;

/// Endings of a photo's files in a folder, behind its name without what follows the last dot: in this order they are looked
/// for. ImageGrains puts its model between: NAME_MODEL_pred.tif.
const ENDINGS: [&str; 20] = [
    "_labels.png",
    ".labels.png",
    "_labels.tif",
    "_labels.tiff",
    "_mask.png",
    "_masks.png",
    "_mask.tif",
    "_masks.tif",
    "_cp_masks.png",
    "_cp_masks.tif",
    "_pred.tif",
    "_pred.png",
    ".json",
    "_labelme.json",
    ".geojson",
    "_grains.geojson",
    "_fragments.geojson",
    ".xml",
    ".tif",
    ".png",
];

/// So many of them, the first, are of pictures that are no photos.
const OF_LABELS: usize = 12;

/// What fragscale writes beside label images, of which nobody reads fragments.
const BESIDE: [&str; 5] = [
    "_outlines.png",
    "_outlines.json",
    "_world.geojson",
    "fragments_coco.json",
    "fragments_cvat.xml",
];

/// The files of a folder and of those within, those nearer first, by name.
pub(super) fn files_below(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let mut files = Vec::new();
    let mut folders = VecDeque::from([folder.to_owned()]);
    while let Some(folder) = folders.pop_front() {
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if files.is_empty() && folders.is_empty() => {
                return Err(FileError::new(&folder, unreadable_folder(&error)));
            }
            // One within that is somebody else's.
            Err(_) => continue,
        };
        let mut entries: Vec<fs::DirEntry> = entries.flatten().collect();
        entries.sort_unstable_by_key(fs::DirEntry::file_name);
        for entry in entries {
            // Links to folders may lead in circles.
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => folders.push_back(entry.path()),
                _ if entry.path().is_file() => files.push(entry.path()),
                _ => {}
            }
        }
        if files.len() > MOST_FILES {
            break;
        }
    }
    Ok(files)
}

/// The files of many photos each, where a folder has no others of outlines: pictures that are called as photos are may be the
/// photos. An export lies in a folder of its own, perhaps in folders for outlines and photos.
pub(super) fn files_of_many(files: &[PathBuf]) -> Option<Vec<(PathBuf, MaskFile)>> {
    let may_be = files.iter().filter(|path| may_be_outlines(path));
    let (pictures, texts): (Vec<&PathBuf>, Vec<&PathBuf>) =
        may_be.partition(|path| is_picture(path));
    let is_of_one = |path: &&PathBuf| {
        let name = lower_name(path);
        ENDINGS[..OF_LABELS]
            .iter()
            .any(|ending| name.ends_with(ending))
    };
    if texts.is_empty() || texts.len() > MOST_OF_MANY || pictures.iter().any(is_of_one) {
        return None;
    }
    // What is wrong with one is said where a photo's outlines are asked for.
    let read = texts
        .into_iter()
        .map(|path| Some((path.clone(), MaskFile::read(path).ok()?)));
    let read: Vec<(PathBuf, MaskFile)> = read.collect::<Option<_>>()?;
    read.iter()
        .all(|(_, file)| !file.is_of_one())
        .then_some(read)
}

/// Whether a file of many photos has outlines of one that is called so.
pub(super) fn names(file: &MaskFile, photo: &str) -> bool {
    file.photos().any(|other| stem(other) == stem(photo))
}

/// Whether the files of two photos have one name, whatever folders they are in.
pub(super) fn is_namesake(one: &str, other: &str) -> bool {
    stem(one).eq_ignore_ascii_case(stem(other))
}

/// Whether a file of outlines lies in a folder that is called as the photo's, or has that folder in its name.
pub(super) fn is_told_by_folder(path: &Path, photo: &str) -> bool {
    let Some(folder) = photo.rsplit(['/', '\\']).nth(1) else {
        return false;
    };
    let parent = path.parent().and_then(Path::file_name).unwrap_or_default();
    parent.to_string_lossy().eq_ignore_ascii_case(folder)
        || lower_name(path).starts_with(&with_folders(photo))
}

/// A photo's name with its folders and without what is behind its last dot, as fragscale calls files of photos of one name.
fn with_folders(photo: &str) -> String {
    let whole = photo.rsplit_once('.').map_or(photo, |(whole, _)| whole);
    whole.replace(['/', '\\'], "_").to_lowercase()
}

fn lower_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .to_lowercase()
}

fn is_picture(path: &Path) -> bool {
    let name = lower_name(path);
    [".png", ".tif", ".tiff"]
        .iter()
        .any(|kind| name.ends_with(kind))
}

/// The files of a folder that may be a photo's outlines, the likeliest first: those that the photo's folder tells, then the nearer
/// ones.
pub(super) fn candidates<'a>(files: &'a [PathBuf], photo: &str) -> impl Iterator<Item = &'a Path> {
    let ranked = files.iter().filter_map(|path| {
        let rank = rank(path, photo)?;
        let depth = path.components().count();
        Some((
            (!is_told_by_folder(path, photo), depth, rank),
            path.as_path(),
        ))
    });
    let mut ranked: Vec<((bool, usize, usize), &Path)> = ranked.collect();
    ranked.sort();
    ranked.into_iter().map(|(_, path)| path)
}

/// Whether outlines may be in a file of this name: not what fragscale writes beside label images.
pub(super) fn may_be_outlines(path: &Path) -> bool {
    let name = lower_name(path);
    let kinds = [".png", ".tif", ".tiff", ".json", ".geojson", ".xml"];
    kinds.iter().any(|kind| name.ends_with(kind)) && !BESIDE.iter().any(|own| name.ends_with(own))
}

/// Whether a file is the photo itself.
pub(super) fn is_photo(path: &Path, photo: &str) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| name.to_lowercase() == last_segment(photo).to_lowercase())
}

/// Which ending a photo's file has; `None` where it is not named as the photo, or is the photo.
pub(super) fn rank(path: &Path, photo: &str) -> Option<usize> {
    let name = path.file_name()?.to_str()?.to_lowercase();
    if is_photo(path, photo) {
        return None;
    }
    let ending = [with_folders(photo), stem(photo).to_lowercase()]
        .iter()
        .find_map(|of_photo| name.strip_prefix(of_photo.as_str()))?;
    let known = ENDINGS.iter().position(|known| ending == *known);
    let of_model = ending.starts_with('_') && ending.ends_with("_pred.tif");
    known.or(of_model.then_some(ENDINGS.len()))
}

/// The last part of a path without what is behind its last dot.
pub(super) fn stem(name: &str) -> &str {
    let name = last_segment(name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}
