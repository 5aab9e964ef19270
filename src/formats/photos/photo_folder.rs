//! The folder of photos: which of its files are images, and which is the file of a photo.

use std::collections::HashMap;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::image_names::{is_image, readable};
use super::photo_size;
use super::photos_below::{PhotosBelow, folders_of_photos};
use crate::fault::{Fault, first_names};
use crate::files::{last_segment, open_file, same_name, unreadable_folder};
use crate::packages::reconstruction::Reconstruction;

/// How many files an error about a folder names.
const SHOWN: usize = 2;

/// The folder of a flight's image files, if it has one.
pub struct PhotoFolder<'a> {
    /// Where they are, if a folder is known.
    pub folder: Option<&'a Path>,
    /// Its files by the keys of their names (`same_name`): those directly in it, or, where no image is among them, those in the folders
    /// that a camera made in it. Of two that differ in nothing else `None`: which is meant is not for us to say.
    in_any_case: HashMap<String, Option<PathBuf>>,
}

impl<'a> PhotoFolder<'a> {
    /// The files of `folder`.
    pub fn new(folder: Option<&'a Path>) -> Self {
        let mut in_any_case = HashMap::new();
        let mut add = |path: PathBuf| {
            let key = same_name::key(&path.file_name().unwrap_or_default().to_string_lossy());
            let is_photo = is_image(&key);
            let known = in_any_case.entry(key);
            known
                .and_modify(|known| *known = None)
                .or_insert(Some(path));
            is_photo
        };
        let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
        let mut has_photos = false;
        for entry in entries.into_iter().flatten().flatten() {
            has_photos |= add(entry.path());
        }
        if let Some(card) = folder.filter(|_| !has_photos)
            && let Ok(below) = PhotosBelow::read(card)
        {
            below.photos.into_iter().for_each(|(_, path)| {
                add(path);
            });
        }
        Self {
            folder,
            in_any_case,
        }
    }

    /// The file of a photo: its name below the folder, or the last part of its name in the folder,
    /// whatever its case and whether its accents stand apart, perhaps with an ending more, or with its ending spelt otherwise (jpeg for jpg). Where the photo's own name has
    /// two endings ("DJI_0025.JPG.tif"), the file may have the first alone.
    pub fn find(&self, photo: &str) -> Option<PathBuf> {
        let folder = self.folder?;
        let last = last_segment(photo);
        if last.is_empty() {
            return None;
        }
        let mut as_named = std::iter::once(photo.to_owned())
            .chain(same_name::other_spellings(photo))
            .chain(std::iter::once(last.to_owned()))
            .map(|name| folder.join(name));
        let first_ending = last.rsplit_once('.').map(|(stem, _)| stem);
        let bare = first_ending.filter(|stem| is_image(stem));
        // Lists of poses and labels leave endings out, and programs put theirs behind the photo's own.
        let longer = readable().map(|ending| format!("{last}.{ending}"));
        let in_any_case = |name: String| self.in_any_case.get(&same_name::key(&name))?.clone();
        as_named
            .find(|path| path.is_file())
            .or_else(|| {
                let mut found = std::iter::once(last.to_owned())
                    .chain(longer)
                    .chain(spelt_otherwise(last))
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

/// The name with the other spelling of its ending. A file of another kind may be another photo: of a thermal camera beside it.
fn spelt_otherwise(name: &str) -> Option<String> {
    const SPELT: [[&str; 2]; 2] = [["jpg", "jpeg"], ["tif", "tiff"]];
    let (stem, ending) = name.rsplit_once('.')?;
    let of_kind = |[short, long]: [&str; 2]| {
        let is = |spelt: &str| ending.eq_ignore_ascii_case(spelt);
        match (is(short), is(long)) {
            (true, _) => Some(format!("{stem}.{long}")),
            (_, true) => Some(format!("{stem}.{short}")),
            _ => None,
        }
    };
    SPELT.into_iter().find_map(of_kind)
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// One format, spelt in two ways; the same name of another format is another photo, as a thermal camera's beside it.
    #[test]
    fn an_ending_spelt_otherwise_is_found() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.JPEG", "b.jpg", "c.tif", "d.png"] {
            fs::write(folder.path().join(name), "a photo").unwrap();
        }
        let files = PhotoFolder::new(Some(folder.path()));
        let found = ["a.jpg", "b.jpeg", "c.TIFF", "d.jpg"].map(|name| files.find(name).is_some());
        assert_eq!(found, [true, true, true, false]);
    }

    /// A folder as macOS wrote it beside a list of poses from elsewhere, and the other way round; also where a folder's name has
    /// accents.
    #[test]
    fn accents_apart_are_the_same_letters() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "Bo\u{308}schung 1.JPG",
            "B\u{f6}schung 2.JPG",
            "Su\u{308}d/3.jpg",
            "N\u{f6}rd/4.jpg",
        ] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, &name[name.len() - 5..]).unwrap();
        }
        let files = PhotoFolder::new(Some(folder.path()));
        for (asked, found) in [
            ("B\u{f6}schung 1.JPG", "1.JPG"),
            ("b\u{f6}schung 1", "1.JPG"),
            ("D:\\flug\\Bo\u{308}schung 2.JPG", "2.JPG"),
            ("S\u{fc}d/3.jpg", "3.jpg"),
            ("No\u{308}rd/4.jpg", "4.jpg"),
        ] {
            let path = files.find(asked).expect(asked);
            assert_eq!(fs::read_to_string(path).unwrap(), found, "{asked}");
        }
        assert_eq!(files.find("Boschung 1.JPG"), None);
    }

    /// A memory card's DCIM, of which a package kept the names of files alone: what two of its folders have is nobody's.
    #[test]
    fn a_card_is_the_folder_of_the_photos_in_its_folders() {
        let card = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = card.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "a photo").unwrap();
        };
        for name in [
            "100MEDIA/DJI_0998.JPG",
            "101MEDIA/DJI_0999.JPG",
            "north/DJI_0001.JPG",
        ] {
            write(name);
        }
        for folder in ["100MEDIA", "101MEDIA"] {
            write(&format!("{folder}/DJI_0500.JPG"));
        }
        let found = |photo: &str| {
            let path = PhotoFolder::new(Some(card.path())).find(photo)?;
            Some(path.strip_prefix(card.path()).unwrap().to_owned())
        };
        assert_eq!(found("DJI_0998.JPG"), Some("100MEDIA/DJI_0998.JPG".into()));
        assert_eq!(found("dji_0999"), Some("101MEDIA/DJI_0999.JPG".into()));
        assert_eq!(found("DJI_0500.JPG"), None);
        assert_eq!(
            found("101MEDIA/DJI_0500.JPG"),
            Some("101MEDIA/DJI_0500.JPG".into())
        );
        // No camera made it.
        assert_eq!(found("DJI_0001.JPG"), None);
        // Photos of its own are those that are meant.
        write("DJI_0500.JPG");
        assert_eq!(found("DJI_0500.JPG"), Some("DJI_0500.JPG".into()));
        assert_eq!(found("DJI_0998.JPG"), None);
    }
}
