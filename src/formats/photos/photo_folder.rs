//! The folder of photos: which of its files are images, and which is the file of a photo.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::image_names::{is_image, readable};
use super::photo_size;
use super::photos_below::{
    LOOKED_THROUGH, PhotosBelow, folders_of_photos, images_below, is_cameras, is_companion,
};
use crate::fault::{Fault, first_names};
use crate::files::{last_segment, open_file, same_name, unreadable_folder};
use crate::packages::reconstruction::Reconstruction;

/// How many files an error about a folder names.
const SHOWN: usize = 2;

/// The folder of a flight's image files, if it has one.
pub struct PhotoFolder<'a> {
    /// Where they are, if a folder is known.
    pub folder: Option<&'a Path>,
    /// Its files by the keys of their names (`same_name`): those directly in it, or, where no image is among them, those in folders
    /// in it, too. Which of several is meant is not for us to say.
    files: HashMap<String, Vec<PathBuf>>,
    /// The names of those folders, by their keys.
    within: BTreeMap<String, String>,
}

impl<'a> PhotoFolder<'a> {
    /// The files of a folder that a package leads to; where it has no images itself, those in the folders that a camera made in it.
    /// Others may be of other flights, whose photos have the same names.
    pub fn new(folder: Option<&'a Path>) -> Self {
        Self::with(folder, on_card)
    }

    /// The files of a folder that somebody named for the photos; where it has no images itself, those in all folders right below it, or,
    /// of very many files, in those that a camera made.
    pub fn named(folder: Option<&'a Path>) -> Self {
        Self::with(folder, |folder| {
            images_below(folder, LOOKED_THROUGH).unwrap_or_else(|| on_card(folder))
        })
    }

    fn with(folder: Option<&'a Path>, below: impl FnOnce(&Path) -> Vec<PathBuf>) -> Self {
        let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
        let entries = entries.into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        let mut paths: Vec<PathBuf> = paths.filter(|path| !is_companion(path)).collect();
        let mut within = BTreeMap::new();
        if let Some(folder) = folder
            && !paths.iter().any(|path| is_image(&name_of(path)))
        {
            let found = below(folder);
            let names = found.iter().map(|path| folder_of(path));
            within.extend(names.map(|name| (same_name::key(&name), name)));
            paths.extend(found);
        }
        let mut files: HashMap<String, Vec<PathBuf>> = HashMap::new();
        for path in paths {
            let key = same_name::key(&name_of(&path));
            files.entry(key).or_default().push(path);
        }
        Self {
            folder,
            files,
            within,
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
        let found = as_named.find(|path| path.is_file());
        found.or_else(|| match self.called(photo)[..] {
            [only] => Some(only.to_owned()),
            _ => None,
        })
    }

    /// The files that are called as a photo is: those of the first way to write the last part of its name that any has.
    fn called(&self, photo: &str) -> Vec<&Path> {
        let last = last_segment(photo);
        let first_ending = last.rsplit_once('.').map(|(stem, _)| stem);
        let bare = first_ending.filter(|stem| is_image(stem));
        // Lists of poses and labels leave endings out, and programs put theirs behind the photo's own.
        let longer = readable().map(|ending| format!("{last}.{ending}"));
        let names = std::iter::once(last.to_owned())
            .chain(longer)
            .chain(spelt_otherwise(last))
            .chain(bare.map(str::to_owned));
        let files = |name: String| -> Vec<&Path> {
            let files = self.files.get(&same_name::key(&name));
            let files = files.into_iter().flatten().map(PathBuf::as_path);
            let files = files.filter(|path| self.may_be(path, photo));
            files.filter(|path| path.is_file()).collect()
        };
        let mut files = names.map(files).filter(|files| !files.is_empty());
        files.next().unwrap_or_default()
    }

    /// Whether a file in a folder within may be a photo's. A camera counts anew in each of its folders: where the photo's name says
    /// one that is there, or one of a camera's, the same name in another one is another photo's.
    fn may_be(&self, path: &Path, photo: &str) -> bool {
        let said = photo.rsplit(['/', '\\']).nth(1).unwrap_or_default();
        if self.within.is_empty() || said.is_empty() {
            return true;
        }
        let own = folder_of(path);
        let key = same_name::key(said);
        let is_another = self.within.contains_key(&key) || is_cameras(said) && is_cameras(&own);
        key == same_name::key(&own) || !is_another
    }

    /// What there is to say of photos whose names are in several folders within it, so that none of their files is taken; `None`
    /// where there are no such photos.
    pub fn in_several(&self, photos: &[&str]) -> Option<Fault> {
        let mut names = Vec::new();
        let mut folders = BTreeSet::new();
        for photo in photos {
            let its: BTreeSet<String> = self.called(photo).into_iter().map(folder_of).collect();
            if its.len() > 1 && self.find(photo).is_none() {
                names.push(*photo);
                folders.extend(its);
            }
        }
        let last = last_segment(names.first()?);
        let example = format!("{}/{last}", folders.first()?);
        Some(Fault::new(
            format!(
                "several folders within it ({}) have files called as the flight's photos ({}), and nothing says which of them are meant",
                first_names(&folders),
                first_names(&names)
            ),
            format!(
                "name the folder of the photos, or write it before their names where their poses are ({example})"
            ),
        ))
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
        if let Some(fault) = self.in_several(photos) {
            return Err(fault);
        }
        let mut there: Vec<&str> = self.files.keys().map(String::as_str).collect();
        there.retain(|name| is_image(name));
        there.sort_unstable();
        let images = there.len();
        there.truncate(SHOWN);
        let not_looked_into = folders_of_photos(folder);
        let there = match (images, self.within.is_empty(), not_looked_into.is_empty()) {
            (_, false, _) => format!(
                "no images itself, and in the folders within it ({})",
                first_names(self.within.values())
            ),
            (0, _, true) => "no images, and so".to_owned(),
            (0, _, false) => format!(
                "no images itself (but folders within it, which were not looked into: {}), and so",
                first_names(&not_looked_into)
            ),
            (n, ..) => format!("{n} images ({}, ...), but", there.join(", ")),
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

/// The photos in the folders that a camera made in a folder.
fn on_card(card: &Path) -> Vec<PathBuf> {
    let below = PhotosBelow::read(card).unwrap_or_default();
    below.photos.into_iter().map(|(_, path)| path).collect()
}

/// The name of a file.
fn name_of(path: &Path) -> Cow<'_, str> {
    path.file_name().unwrap_or_default().to_string_lossy()
}

/// The name of the folder that a file lies in.
fn folder_of(path: &Path) -> String {
    name_of(path.parent().unwrap_or(Path::new(""))).into_owned()
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

    /// Folders of an engineer's own: the photos of a folder that is named lie right below it. A package's may hold other flights'.
    #[test]
    fn a_named_folder_has_the_photos_in_its_folders() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "sub1/IMG_0001.JPG",
            "sub1/IMG_0003.jpg",
            "sub2/IMG_0002.jpg",
            "sub2/IMG_0003.jpg",
            "sub2/IMG_0003.jpeg",
            "100MEDIA/DJI_0500.JPG",
            "sub2/deeper/IMG_0004.jpg",
        ] {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "a photo").unwrap();
        }
        let named = PhotoFolder::named(Some(folder.path()));
        for (photo, file) in [
            ("IMG_0001.jpg", Some("sub1/IMG_0001.JPG")),
            ("img_0002", Some("sub2/IMG_0002.jpg")),
            // In both; the folder before it tells, as other systems write it, too.
            ("IMG_0003.jpg", None),
            ("sub2/IMG_0003.jpg", Some("sub2/IMG_0003.jpg")),
            (r"D:\flug\SUB1\IMG_0003.jpg", Some("sub1/IMG_0003.jpg")),
            // Not there, whatever the other folder has.
            ("sub1/IMG_0002.jpg", None),
            ("101MEDIA/DJI_0500.JPG", None),
            // A folder that nothing is known of does not tell.
            ("photos/IMG_0001.jpg", Some("sub1/IMG_0001.JPG")),
            ("photos/DJI_0500.JPG", Some("100MEDIA/DJI_0500.JPG")),
            ("IMG_0004.jpg", None),
        ] {
            let expected = file.map(|file| folder.path().join(file));
            assert_eq!(named.find(photo), expected, "{photo}");
        }
        assert!(named.check(&["IMG_0001.jpg", "IMG_0003.jpg"]).is_ok());
        let fault = named.check(&["IMG_0003.jpg"]).unwrap_err();
        let words = "several folders within it (sub1, sub2) have files called as the flight's photos (IMG_0003.jpg)";
        assert!(fault.what.starts_with(words), "{fault}");
        assert!(fault.remedy.contains("(sub1/IMG_0003.jpg)"), "{fault}");
        assert_eq!(named.in_several(&["IMG_0001.jpg", "IMG_0004.jpg"]), None);
        let found = PhotoFolder::new(Some(folder.path()));
        assert_eq!(found.find("IMG_0001.jpg"), None);
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
