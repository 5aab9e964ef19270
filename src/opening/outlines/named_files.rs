//! Which files of a folder are outlines of a photo, by their names.

use std::cmp::Reverse;
use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};

use crate::files::same_name::{self, is_same_stem};
use crate::files::{last_segment, stem, unreadable_folder};
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
const BESIDE: [&str; 3] = ["_outlines.png", "_outlines.json", "_world.geojson"];

/// What it writes of all photos beside label images: it says the same as they do, and is read where they are not there.
const OWN_OF_MANY: [&str; 2] = ["fragments_coco.json", "fragments_cvat.xml"];

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
/// photos. An export lies in a folder of its own, perhaps in folders for outlines and photos. Fragscale's own are read where nothing
/// else may be outlines.
///
/// # Errors
/// Where one of fragscale's own cannot be read.
pub(super) fn files_of_many(
    files: &[PathBuf],
) -> Result<Option<Vec<(PathBuf, MaskFile)>>, FileError> {
    if files.iter().any(|path| may_be_outlines(path)) {
        return Ok(others_of_many(files));
    }
    let own = files.iter().filter(|path| ends_as(path, &OWN_OF_MANY));
    let own: Vec<&PathBuf> = own.collect();
    if own.is_empty() || own.len() > MOST_OF_MANY {
        return Ok(None);
    }
    let read = own
        .into_iter()
        .map(|path| MaskFile::read(path).map(|file| (path.clone(), file)));
    read.collect::<Result<Vec<_>, FileError>>().map(Some)
}

/// The files of many photos that others wrote.
fn others_of_many(files: &[PathBuf]) -> Option<Vec<(PathBuf, MaskFile)>> {
    let may_be = files.iter().filter(|path| may_be_outlines(path));
    let (pictures, texts): (Vec<&PathBuf>, Vec<&PathBuf>) =
        may_be.partition(|path| is_picture(path));
    let is_of_one = |path: &&PathBuf| ends_as(path, &ENDINGS[..OF_LABELS]);
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

/// Whether a file of many photos has outlines that may be of one that is called so: not those that name another of the `photos`, nor a
/// file that lies with another of this name.
pub(super) fn names(path: &Path, file: &MaskFile, photo: &str, photos: &[&str]) -> bool {
    let shared = folders_shared(path, photo);
    let lies_with_another = photos
        .iter()
        .any(|other| is_namesake(other, photo) && folders_shared(path, other) > shared);
    let may_name =
        |other: &str| is_same_stem(other, photo) && (other == photo || !photos.contains(&other));
    !lies_with_another && file.photos().any(may_name)
}

/// Those of many files of many photos that may be of one, those that lie in its folders first.
pub(super) fn with_photo<'a>(
    files: &'a [(PathBuf, MaskFile)],
    photo: &str,
    photos: &[&str],
) -> Vec<&'a (PathBuf, MaskFile)> {
    let mut its: Vec<&(PathBuf, MaskFile)> = files
        .iter()
        .filter(|(path, file)| names(path, file, photo, photos))
        .collect();
    its.sort_by_key(|(path, _)| Reverse(folders_shared(path, photo)));
    its
}

/// Whether the files of two photos have one name, whatever folders they are in.
pub(super) fn is_namesake(one: &str, other: &str) -> bool {
    same_name::key(stem(one)) == same_name::key(stem(other))
}

/// Whether a file that calls its photo so may be of this one: letter case, ending and folder make no difference, and in fragscale's
/// exports the folders stand in the name.
pub(super) fn may_be_called(photo: &str, stated: &str) -> bool {
    is_namesake(stated, photo) || same_name::key(stem(stated)) == with_folders(photo)
}

/// The folders of a photo's name, the last first.
fn folders(photo: &str) -> impl Iterator<Item = &str> {
    let above = photo.rsplit(['/', '\\']).skip(1);
    above.filter(|folder| !folder.is_empty() && *folder != ".")
}

/// Whether a photo's name says a folder.
pub(super) fn has_folder(photo: &str) -> bool {
    folders(photo).next().is_some()
}

/// In how many folders a file lies that are called as the photo's, from the last.
pub(super) fn folders_shared(path: &Path, photo: &str) -> usize {
    let above = path.ancestors().skip(1).filter_map(Path::file_name);
    folders(photo)
        .zip(above)
        .take_while(|(its, own)| same_name::key(&own.to_string_lossy()) == same_name::key(its))
        .count()
}

/// Whether the folders that a file lies in tell a photo from all others of its name.
pub(super) fn is_told_apart(path: &Path, photo: &str, photos: &[&str]) -> bool {
    let shared = folders_shared(path, photo);
    let is_as_near = |other: &&str| {
        *other != photo && is_namesake(other, photo) && folders_shared(path, other) >= shared
    };
    shared > 0 && !photos.iter().any(is_as_near)
}

/// A photo's name with its folders and without what is behind its last dot, as fragscale calls files of photos of one name.
fn with_folders(photo: &str) -> String {
    let whole = photo.rsplit_once('.').map_or(photo, |(whole, _)| whole);
    same_name::key(&whole.replace(['/', '\\'], "_"))
}

fn lower_name(path: &Path) -> String {
    same_name::key(&path.file_name().unwrap_or_default().to_string_lossy())
}

fn is_picture(path: &Path) -> bool {
    ends_as(path, &[".png", ".tif", ".tiff"])
}

/// Whether a file's name has one of these endings, in letters of any case.
fn ends_as(path: &Path, endings: &[&str]) -> bool {
    let name = lower_name(path);
    endings.iter().any(|ending| name.ends_with(ending))
}

/// The files of a folder that may be a photo's outlines, the likeliest first: those that the photo's folders tell, then the nearer
/// ones. Those that another of the `photos` is told better by are that one's.
pub(super) fn candidates<'a>(
    files: &'a [PathBuf],
    photo: &str,
    photos: &[&str],
) -> impl Iterator<Item = &'a Path> {
    let ranked = files.iter().filter_map(|path| {
        let told = told(path, photo).filter(|_| !is_anothers(path, photo, photos))?;
        let depth = path.components().count();
        let by_folders = Reverse((told.folders, told.is_by_name_alone));
        Some((by_folders, depth, told.ending, path.as_path()))
    });
    let mut ranked: Vec<_> = ranked.collect();
    ranked.sort();
    ranked.into_iter().map(|(.., path)| path)
}

/// Whether a file tells another photo better than this one: by its whole name (a_IMG.jpg before a/IMG.jpg), then by more folders.
pub(super) fn is_anothers(path: &Path, photo: &str, photos: &[&str]) -> bool {
    let claim = |photo: &str| told(path, photo).map(|told| (told.is_by_name_alone, told.folders));
    let own = claim(photo);
    photos.iter().any(|other| claim(other) > own)
}

/// Another photo that takes the same file of a folder for its own.
pub(super) fn also_taken_by<'p>(
    path: &Path,
    files: &[PathBuf],
    photo: &str,
    photos: &[&'p str],
) -> Option<&'p str> {
    let mut others = photos
        .iter()
        .filter(|other| **other != photo && told(path, other).is_some());
    let takes = |other: &&&str| candidates(files, other, photos).next() == Some(path);
    others.find(takes).copied()
}

/// Whether outlines may be in a file of this name: not what fragscale writes beside label images.
pub(super) fn may_be_outlines(path: &Path) -> bool {
    let kinds = [".png", ".tif", ".tiff", ".json", ".geojson", ".xml"];
    ends_as(path, &kinds) && !ends_as(path, &BESIDE) && !ends_as(path, &OWN_OF_MANY)
}

/// Whether a file is the photo itself.
pub(super) fn is_photo(path: &Path, photo: &str) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| same_name::key(name) == same_name::key(last_segment(photo)))
}

/// How a file of one photo tells which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Told {
    /// So many of the photo's folders: those that it lies in, or all that stand in its name.
    pub(super) folders: usize,
    /// Whether it is named as the photo without its folders.
    pub(super) is_by_name_alone: bool,
    /// Which ending it has, in the order in which they are looked for.
    pub(super) ending: usize,
}

/// How a file tells that it is of a photo; `None` where it is not named as the photo, or is the photo.
pub(super) fn told(path: &Path, photo: &str) -> Option<Told> {
    if is_photo(path, photo) {
        return None;
    }
    let name = same_name::key(path.file_name()?.to_str()?);
    let ending = |of_photo: String| {
        let ending = name.strip_prefix(of_photo.as_str())?;
        let known = ENDINGS.iter().position(|known| ending == *known);
        let of_model = ending.starts_with('_') && ending.ends_with("_pred.tif");
        known.or(of_model.then_some(ENDINGS.len()))
    };
    if let Some(ending) = ending(same_name::key(stem(photo))) {
        return Some(Told {
            folders: folders_shared(path, photo),
            is_by_name_alone: true,
            ending,
        });
    }
    Some(Told {
        folders: folders(photo).count(),
        is_by_name_alone: false,
        ending: ending(with_folders(photo))?,
    })
}
