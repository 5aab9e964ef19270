//! The folder of photos: which of its files are images, and which is the file of a photo.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::image_names::{is_image, readable};
use super::photo_size;
use super::photos_below::{
    LOOKED_THROUGH, folders_of_photos, images_below, is_cameras, is_companion, photos_in,
};
use crate::fault::{Fault, first_names};
use crate::files::{last_segment, open_file, same_name, unreadable_folder};
use crate::packages::reconstruction::Reconstruction;

/// How many files an error about a folder names.
const SHOWN: usize = 2;

/// A photo whose file is looked for: its name, and which size the file has, where that is known.
pub type WantedPhoto<'a> = (&'a str, Option<(u32, u32)>);

/// The folder of a flight's image files, if it has one.
pub struct PhotoFolder<'a> {
    /// Where they are, if a folder is known.
    pub folder: Option<&'a Path>,
    /// Its files by the keys of their names (`same_name`): those directly in it, and, where the photos are not among them, those in
    /// folders in it, too. Which of several is meant is not for us to say.
    files: HashMap<String, Vec<PathBuf>>,
    /// The names of those folders, by their keys.
    within: BTreeMap<String, String>,
    /// Of photos whose names several files have, the only one that has the size of the photo.
    by_size: BTreeMap<String, PathBuf>,
}

impl<'a> PhotoFolder<'a> {
    /// The files of a folder that a package leads to; where it has no images itself, those in the folders that a camera made in it.
    /// Others may be of other flights, whose photos have the same names.
    pub fn new(folder: Option<&'a Path>) -> Self {
        let mut files = Self::of_itself(folder);
        if let Some(folder) = folder
            && !files.files.keys().any(|name| is_image(name))
        {
            files.add_below(on_card(folder));
        }
        files
    }

    /// The files of a folder that somebody named for these photos; where none of them lies in it, whatever pictures else do, those in
    /// all folders right below it, or, of very many files, in those that a camera made. Where several of these have the name of a
    /// photo, as those of thumbnails do, the only one that has its size is taken, if none is larger.
    pub fn named(folder: Option<&'a Path>, photos: &[WantedPhoto<'_>]) -> Self {
        let mut files = Self::of_itself(folder);
        if let Some(folder) = folder
            && !photos
                .iter()
                .any(|(name, _)| !files.called(name).is_empty())
        {
            let below = images_below(folder, LOOKED_THROUGH);
            files.add_below(below.unwrap_or_else(|| on_card(folder)));
            let of_size = photos.iter().filter_map(|(name, size)| {
                let path = only_of_size(&files.called(name), (*size)?)?;
                Some(((*name).to_owned(), path.to_owned()))
            });
            files.by_size = of_size.collect();
        }
        files
    }

    /// The files that lie in a folder itself.
    fn of_itself(folder: Option<&'a Path>) -> Self {
        let mut files = Self {
            folder,
            files: HashMap::new(),
            within: BTreeMap::new(),
            by_size: BTreeMap::new(),
        };
        let entries = folder.and_then(|folder| std::fs::read_dir(folder).ok());
        let entries = entries.into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        files.add(paths.filter(|path| !is_companion(path)));
        files
    }

    fn add(&mut self, paths: impl IntoIterator<Item = PathBuf>) {
        for path in paths {
            let key = same_name::key(&name_of(&path));
            self.files.entry(key).or_default().push(path);
        }
    }

    fn add_below(&mut self, paths: Vec<PathBuf>) {
        let names = paths.iter().map(|path| folder_of(path));
        self.within
            .extend(names.map(|name| (same_name::key(&name), name)));
        self.add(paths);
    }

    /// Whether the files of folders within it were looked through, because the photos do not lie in it itself.
    pub fn is_looked_through(&self) -> bool {
        !self.within.is_empty()
    }

    /// The file of a photo: its name below the folder, or the last part of its name in the folder,
    /// whatever its case and whether its accents stand apart, perhaps with an ending more, or with its ending spelt otherwise (jpeg for
    /// jpg). Where the photo's own name has two endings ("DJI_0025.JPG.tif"), the file may have the first alone. Of several files of its
    /// name none, but where one alone has its size.
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
        let found = found.or_else(|| self.by_size.get(photo).cloned());
        found.or_else(|| match self.called(photo)[..] {
            [only] => Some(only.to_owned()),
            _ => None,
        })
    }

    /// The files that are called as a photo is: those of the first way to write the last part of its name that any has.
    fn called(&self, photo: &str) -> Vec<&Path> {
        self.called_where(photo, Path::is_file)
    }

    /// The same of entries of a folder that are something else.
    fn called_where(&self, photo: &str, is_it: fn(&Path) -> bool) -> Vec<&Path> {
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
            files.filter(|path| is_it(path)).collect()
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

    /// That photos whose names are in several folders within it are known by their size; `None` where there are no such photos.
    pub fn chosen_by_size(&self) -> Option<String> {
        let names = self.by_size.keys();
        let folders = names.clone().flat_map(|photo| self.called(photo));
        let folders: BTreeSet<String> = folders.map(folder_of).collect();
        let taken: BTreeSet<String> = self.by_size.values().map(|path| folder_of(path)).collect();
        (!taken.is_empty()).then(|| {
            format!(
                "several folders within it ({}) have files called as the flight's photos ({}): those of the photos' size in pixels are \
                 taken ({})",
                first_names(&folders),
                first_names(names),
                first_names(&taken)
            )
        })
    }

    /// That the files of photos are links to what is not there; `None` where there are no such photos.
    pub fn dead_links(&self, photos: &[&str]) -> Option<Fault> {
        let is_dead = |photo: &&&str| {
            self.find(photo).is_none() && !self.called_where(photo, is_dead_link).is_empty()
        };
        let names: Vec<&str> = photos.iter().filter(is_dead).copied().collect();
        let what = match names[..] {
            [] => return None,
            [name] => format!("the file of the flight's photo {name} is a link that leads nowhere"),
            _ => format!(
                "the files of {} of the flight's photos ({}) are links that lead nowhere",
                names.len(),
                first_names(&names)
            ),
        };
        let remedy = "put the photos themselves there, or connect the disk that the links lead to";
        Some(Fault::new(what, remedy))
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
        if let Some(fault) = self.dead_links(photos) {
            return Err(fault);
        }
        let own = self.files.iter().filter(|(name, paths)| {
            is_image(name) && paths.iter().any(|path| path.parent() == Some(folder))
        });
        let mut there: Vec<&str> = own.map(|(name, _)| name.as_str()).collect();
        there.sort_unstable();
        let images = there.len();
        there.truncate(SHOWN);
        let not_looked_into = folders_of_photos(folder);
        let there = match (images, self.within.is_empty(), not_looked_into.is_empty()) {
            (0, false, _) => format!(
                "no images itself, and in the folders within it ({})",
                first_names(self.within.values())
            ),
            (n, false, _) => format!(
                "{n} images ({}, ...), but also in the folders within it ({})",
                there.join(", "),
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
    let cameras = folders_of_photos(card).into_iter();
    let cameras = cameras.filter(|name| is_cameras(name));
    // One that cannot be read has no photos that anybody could take.
    let photos = cameras.flat_map(|name| photos_in(&card.join(name)).unwrap_or_default());
    photos.collect()
}

/// The only one of several files that has a size in pixels; of one alone nothing is asked. Where another one is larger, the size may be
/// that of reduced photos, on which a package solved, and not of those that were shot: then none is taken.
fn only_of_size<'f>(files: &[&'f Path], size: (u32, u32)) -> Option<&'f Path> {
    if files.len() < 2 {
        return None;
    }
    let sizes = files.iter().map(|path| size_of_file(path).ok());
    let sizes: Vec<Option<(u32, u32)>> = sizes.collect();
    let pixels = |(width, height): (u32, u32)| u64::from(width) * u64::from(height);
    let mut known = sizes.iter().flatten();
    if known.any(|its| pixels(*its) > pixels(size)) {
        return None;
    }
    let all = files.iter().zip(&sizes);
    let mut fitting = all.filter(|(_, its)| **its == Some(size));
    let (path, _) = fitting.next()?;
    fitting.next().is_none().then_some(*path)
}

/// Whether a path is a link to what is not there.
fn is_dead_link(path: &Path) -> bool {
    path.is_symlink() && !path.exists()
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
mod tests;
