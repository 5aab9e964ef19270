//! The folder of photos: which of its files are images, and which is the file of a photo.

use std::collections::HashMap;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::image_names::{is_image, readable};
use super::photo_size;
use super::photos_below::folders_of_photos;
use crate::fault::{Fault, first_names};
use crate::files::{last_segment, open_file, unreadable_folder};
use crate::packages::reconstruction::Reconstruction;

/// How many files an error about a folder names.
const SHOWN: usize = 2;

/// The folder of a flight's image files, if it has one.
pub struct PhotoFolder<'a> {
    /// Where they are, if a folder is known.
    pub folder: Option<&'a Path>,
    /// The files directly in it by their names in lower case; of two that differ in nothing else,
    /// `None`: which is meant is not for us to say.
    in_any_case: HashMap<String, Option<PathBuf>>,
}

impl<'a> PhotoFolder<'a> {
    /// The files directly in `folder`.
    pub fn new(folder: Option<&'a Path>) -> Self {
        let mut in_any_case = HashMap::new();
        let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
        for entry in entries.into_iter().flatten().flatten() {
            let key = entry.file_name().to_string_lossy().to_lowercase();
            in_any_case
                .entry(key)
                .and_modify(|known| *known = None)
                .or_insert_with(|| Some(entry.path()));
        }
        Self {
            folder,
            in_any_case,
        }
    }

    /// The file of a photo: its name below the folder, or the last part of its name in the folder,
    /// whatever its case, perhaps with an ending more. Where the photo's own name has two endings
    /// ("DJI_0025.JPG.tif"), the file may have the first alone.
    pub fn find(&self, photo: &str) -> Option<PathBuf> {
        let folder = self.folder?;
        let last = last_segment(photo);
        if last.is_empty() {
            return None;
        }
        let as_named = [photo, last].map(|name| folder.join(name));
        let first_ending = last.rsplit_once('.').map(|(stem, _)| stem);
        let bare = first_ending.filter(|stem| is_image(stem));
        // Lists of poses and labels leave endings out, and programs put theirs behind the photo's own.
        let longer = readable().map(|ending| format!("{last}.{ending}"));
        let in_any_case = |name: String| self.in_any_case.get(&name.to_lowercase())?.clone();
        as_named
            .into_iter()
            .find(|path| path.is_file())
            .or_else(|| {
                let mut found = std::iter::once(last.to_owned())
                    .chain(longer)
                    .filter_map(in_any_case);
                found.find(|path| path.is_file())
            })
            .or_else(|| in_any_case(bare?.to_owned()).filter(|path| path.is_file()))
    }

    /// Refuses a folder that somebody named for the photos and that cannot be theirs.
    ///
    /// # Errors
    /// Where it is not there, is no folder, or holds none of them.
    pub fn check(&self, photos: &[&str]) -> Result<(), Fault> {
        let Some(folder) = self.folder else {
            return Ok(());
        };
        let refuse = |what: String| Err(Fault::new(what, "name the folder of the photos"));
        if folder.is_file() {
            return refuse("a file, where the folder of the photos is needed".to_owned());
        }
        if let Err(e) = std::fs::read_dir(folder) {
            return refuse(unreadable_folder(&e).what);
        }
        if photos.iter().any(|photo| self.find(photo).is_some()) {
            return Ok(());
        }
        let mut there: Vec<&str> = self.in_any_case.keys().map(String::as_str).collect();
        there.retain(|name| is_image(name));
        there.sort_unstable();
        let images = there.len();
        there.truncate(SHOWN);
        let within = folders_of_photos(folder);
        let there = match (images, within.is_empty()) {
            (0, true) => "no images, and so".to_owned(),
            (0, false) => format!(
                "no images itself (but folders within it: {}), and",
                first_names(&within)
            ),
            (n, _) => format!("{n} images ({}, ...), but", there.join(", ")),
        };
        refuse(format!(
            "it holds {there} none of the flight's {} photos ({}, ...)",
            photos.len(),
            photos
                .iter()
                .take(SHOWN)
                .copied()
                .collect::<Vec<_>>()
                .join(", ")
        ))
    }

    /// Width and height of a photo's file; `None` where there is no file.
    pub fn size_of(&self, photo: &str) -> Option<Result<(u32, u32), Fault>> {
        self.find(photo).map(|path| size_of_file(&path))
    }
}

/// Width and height of an image file.
///
/// # Errors
/// Where it cannot be opened, or is no image whose size can be read.
pub fn size_of_file(path: &Path) -> Result<(u32, u32), Fault> {
    open_file(path)
        .map_err(|error| error.fault)
        .and_then(|file| photo_size::read(BufReader::new(file)))
}

/// The first of `folders` that holds the file of one of the first photos.
pub fn folder_of_photos(
    folders: impl IntoIterator<Item = PathBuf>,
    reconstruction: &Reconstruction,
) -> Option<PathBuf> {
    /// Some photos may have been moved; to look for all could take long on a network drive.
    const TRIED: usize = 3;
    folders.into_iter().find(|folder| {
        let files = PhotoFolder::new(Some(folder));
        let mut photos = reconstruction.photos.iter().take(TRIED);
        photos.any(|photo| files.find(&photo.name).is_some())
    })
}
