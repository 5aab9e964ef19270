//! The photos of a folder: those that lie in it, or, where it has none, those in the folders that a camera made in it
//! (a drone begins a new one after 999 photos, and counts anew).

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::files::{FileError, unreadable_folder};
use crate::photos::image_names::{Ending, is_ending, is_image};

/// How many files in the folders of a folder are looked through for a flight's photos: a flight has some thousand, and a disk with
/// the flights of a year is no flight's folder.
pub(crate) const LOOKED_THROUGH: usize = 20_000;

/// What a folder has of photos.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PhotosBelow {
    /// Their names, behind a folder's and a slash where they lie in one, and their files, in that order.
    pub photos: Vec<(String, PathBuf)>,
    /// The folders within that have photos that are not among these, by name.
    pub others: Vec<String>,
    /// Files that may be photos, of an ending whose metadata are not read, and that lie beside none of the same name, by name.
    pub of_other_endings: Vec<String>,
}

impl PhotosBelow {
    /// Of a folder.
    ///
    /// # Errors
    /// Where it, or one that a camera made in it, cannot be read.
    pub fn read(folder: &Path) -> Result<Self, FileError> {
        let named = |path: PathBuf, within: Option<&str>| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let name = match within {
                Some(within) => format!("{within}/{name}"),
                None => name.into_owned(),
            };
            (name, path)
        };
        let own = photos_in(folder)?;
        let (cameras, others): (Vec<String>, Vec<String>) = folders_of_photos(folder)
            .into_iter()
            .partition(|name| own.is_empty() && is_cameras(name));
        let mut photos: Vec<_> = own.into_iter().map(|path| named(path, None)).collect();
        for within in &cameras {
            let found = photos_in(&folder.join(within))?;
            photos.extend(found.into_iter().map(|path| named(path, Some(within))));
        }
        let of_other_endings = of_other_endings(folder, &photos);
        Ok(Self {
            photos,
            others,
            of_other_endings,
        })
    }
}

/// Those of a folder; a raw one beside its JPEG is that photo.
fn of_other_endings(folder: &Path, photos: &[(String, PathBuf)]) -> Vec<String> {
    let stem = |path: &Path| path.file_stem().unwrap_or_default().to_ascii_lowercase();
    let known: HashSet<OsString> = photos.iter().map(|(_, path)| stem(path)).collect();
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let others = entries.map(|entry| entry.path()).filter(|path| {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        is_ending(&ending, Ending::Unread)
            && !is_photo(path)
            && is_no_other(path)
            && !known.contains(&stem(path))
            && path.is_file()
    });
    let mut names: Vec<String> = others
        .map(|path| {
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

/// Whether a file is named like a photo.
pub(crate) fn is_photo(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    is_ending(&ending, Ending::Photo) && path.is_file()
}

/// Whether macOS put a file beside another one, on a card or a server that cannot keep what it knows of that: of the same name behind
/// "._", and no photo (AppleDouble, RFC 1740).
pub(crate) fn is_companion(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().starts_with("._")
}

/// Whether a file is called as a label image of fragments: no photo, though it lies beside them.
pub fn is_label_image(path: &Path) -> bool {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let stem = stem.to_ascii_lowercase();
    stem.ends_with("_labels") || stem.ends_with(".labels")
}

/// Whether what is named like a photo is one.
fn is_no_other(path: &Path) -> bool {
    !is_companion(path) && !is_label_image(path)
}

/// Whether a folder has photos in it.
pub(crate) fn has_photos(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries
        .map(|entry| entry.path())
        .any(|path| is_photo(&path) && is_no_other(&path))
}

/// The photos that lie in a folder itself, by name.
///
/// # Errors
/// Where it cannot be read.
pub(crate) fn photos_in(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let failed = |e: std::io::Error| {
        let fault = match e.kind() {
            std::io::ErrorKind::NotADirectory => Fault::new(
                "a file, where a folder of photos is needed",
                "name the folder that it lies in",
            ),
            _ => unreadable_folder(&e),
        };
        FileError::new(folder, fault)
    };
    let mut photos = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if is_photo(&path) && is_no_other(&path) {
            photos.push(path);
        }
    }
    photos.sort();
    Ok(photos)
}

/// The folders within a folder that have photos of their own, by name, sorted.
pub(crate) fn folders_of_photos(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.path().is_dir() && has_photos(&entry.path()));
    let mut names: Vec<String> = folders
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// The images in the folders right below a folder, by their paths; folders that are hidden (of thumbnails, of what was deleted) are
/// passed over. `None` where there are more than `most` files: of the rest one could be called as another one is.
pub(crate) fn images_below(folder: &Path, most: usize) -> Option<Vec<PathBuf>> {
    let entries = |folder: &Path| fs::read_dir(folder).into_iter().flatten().flatten();
    let name = |entry: &fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let within = entries(folder).filter(|entry| !name(entry).starts_with('.'));
    let within = within
        .map(|entry| entry.path())
        .filter(|path| path.is_dir());
    let mut images = Vec::new();
    let mut seen = 0;
    for folder in within {
        for entry in entries(&folder) {
            seen += 1;
            if seen > most {
                return None;
            }
            if is_image(&name(&entry)) && !is_companion(&entry.path()) {
                images.push(entry.path());
            }
        }
    }
    images.sort();
    Some(images)
}

/// Whether a folder is called as cameras call theirs: by three digits and five letters (the rule of memory cards, DCF 2.0:
/// 100MEDIA), or as DJI's drones call those of a mission.
pub(crate) fn is_cameras(name: &str) -> bool {
    let by_rule = name.len() == 8
        && name.bytes().take(3).all(|byte| byte.is_ascii_digit())
        && name
            .bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    by_rule || name.starts_with("DJI_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_all_folders_below_or_none() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "b/2.JPG",
            "a/1.tif",
            "a/notes.txt",
            "b/._2.JPG",
            ".thumbnails/3.jpg",
            "a/deeper/4.jpg",
            "own.jpg",
        ] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let expected = ["a/1.tif", "b/2.JPG"].map(|name| folder.path().join(name));
        // Two images, what macOS keeps of one, a text and a folder.
        assert_eq!(images_below(folder.path(), 5), Some(expected.to_vec()));
        assert_eq!(images_below(folder.path(), 4), None);
        let none = folder.path().join("none");
        assert_eq!(images_below(&none, 4), Some(Vec::new()));
    }

    #[test]
    fn folders_that_a_camera_made_are_one() {
        let folder = tempfile::tempdir().unwrap();
        let add = |within: &str, name: &str| {
            let within = folder.path().join(within);
            fs::create_dir_all(&within).unwrap();
            fs::write(within.join(name), "").unwrap();
        };
        let found = || {
            let found = PhotosBelow::read(folder.path()).unwrap();
            let names: Vec<String> = found.photos.into_iter().map(|(name, _)| name).collect();
            (names.join(" "), found.others.join(" "))
        };
        let pair = |photos: &str, others: &str| (photos.to_owned(), others.to_owned());
        assert_eq!(found(), pair("", ""));
        add("101MEDIA", "DJI_0001.JPG");
        add("100MEDIA", "DJI_0001.JPG");
        add("100MEDIA", "DJI_0001.MOV");
        add("DJI_202605011200_001", "a.jpg");
        add("empty", "a.txt");
        let all = "100MEDIA/DJI_0001.JPG 101MEDIA/DJI_0001.JPG DJI_202605011200_001/a.jpg";
        assert_eq!(found(), pair(all, ""));
        // What else lies on a card is named.
        add("labels", "a.png");
        add("labels", "._a.png");
        add("of macOS", "._a.png");
        assert_eq!(found(), pair(all, "labels"));
        let others = "100MEDIA 101MEDIA DJI_202605011200_001 labels";
        add("", "own.DNG");
        add("", "ortho.TIF");
        add("", "IMG_1.HEIC");
        add("", "own.jpg");
        add("", "own_labels.png");
        add("", "own.labels.PNG");
        add("", "._own.jpg");
        add("", "._IMG_1.HEIC");
        assert_eq!(found(), pair("own.jpg", others));
        let file = PhotosBelow::read(&folder.path().join("own.jpg")).unwrap_err();
        assert!(file.to_string().contains("a folder of photos is needed"));
        // A raw file beside its JPEG is the same photo.
        let found = PhotosBelow::read(folder.path()).unwrap();
        assert_eq!(found.of_other_endings, ["IMG_1.HEIC", "ortho.TIF"]);
    }
}
