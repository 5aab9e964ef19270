//! What goes to a node: photos, where they were taken, control points.
//!
//! The user's own lists go along under the names that NodeODM knows them by, in the photos' names on the node
//! (`names`): `geo.txt` and `image_groups.txt`, whatever their case, and control points.

use std::fs;
use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::files::{FileError, read_small};
use crate::formats::control_list_text;
use crate::formats::photos::photo_metadata;
use crate::geo_txt::geo_txt;
use crate::jobs::Progress;
use crate::names::Names;
use crate::opening::read_control;
use crate::reconstruct::PhotoSet;

/// What is sent.
pub(crate) struct Sent {
    /// The photos.
    pub(crate) set: PhotoSet,
    /// What they are called on the node.
    pub(crate) names: Names,
    /// In the order of their sending.
    pub(crate) files: Vec<SentFile>,
    /// What is to be said, one sentence each.
    pub(crate) warnings: Vec<String>,
}

/// A file that is sent.
pub(crate) struct SentFile {
    pub(crate) name: String,
    pub(crate) kind: &'static str,
    pub(crate) from: Origin,
    /// Bytes.
    pub(crate) size: u64,
}

/// Where its bytes are.
pub(crate) enum Origin {
    Path(PathBuf),
    Bytes(Vec<u8>),
}

/// Where photos were taken; NodeODM knows it by this name.
const GEO: &str = "geo.txt";
/// Which photos are reconstructed together, of surveys that a cluster splits.
const GROUPS: &str = "image_groups.txt";
/// Control points.
const GCP: &str = "gcp_list.txt";
/// A list of places or points has some lines a photo.
const LIST: u64 = 64 << 20;

impl Sent {
    /// Looks what a folder of photos holds, with the control points of a file, or of the folder's `gcp_list.txt`.
    ///
    /// # Errors
    /// Where fewer than three photos can be read, or a list is none or of other photos.
    pub(crate) fn read(
        folder: &Path,
        control: Option<&Path>,
        progress: &Progress,
    ) -> Result<Self, FileError> {
        let set = PhotoSet::read(folder, None, progress)?;
        let names = Names::of(set.photos.iter().map(|photo| photo.name.as_str()));
        let mut files = Vec::new();
        for (photo, name) in set.photos.iter().zip(names.sent()) {
            let size = fs::metadata(&photo.path).map_err(|error| {
                let what = format!("it cannot be read ({error})");
                FileError::new(&photo.path, Fault::new(what, "check the disk"))
            })?;
            files.push(SentFile {
                name: name.to_owned(),
                kind: kind_of(name),
                from: Origin::Path(photo.path.clone()),
                size: size.len(),
            });
        }
        let mut sent = Self {
            set,
            names,
            files,
            warnings: Vec::new(),
        };
        sent.add_places(folder)?;
        if let Some(own) = own_list(folder, GROUPS) {
            let text = sent.own_text(&own, "list of groups")?;
            sent.add(GROUPS, text);
        }
        let beside = folder.join(GCP);
        match control {
            Some(path) => sent.add_control(path)?,
            None if beside.is_file() => sent.add_control(&beside)?,
            None => {}
        }
        Ok(sent)
    }

    fn add(&mut self, name: &str, bytes: Vec<u8>) {
        self.files.push(SentFile {
            name: name.to_owned(),
            kind: "text/plain",
            size: bytes.len() as u64,
            from: Origin::Bytes(bytes),
        });
    }

    /// The folder's own `geo.txt`, or one of what the photos say.
    fn add_places(&mut self, folder: &Path) -> Result<(), FileError> {
        if let Some(own) = own_list(folder, GEO) {
            let text = self.own_text(&own, "list of places")?;
            self.add(GEO, text);
            return Ok(());
        }
        let mut photos = Vec::new();
        for (photo, name) in self.set.photos.iter().zip(self.names.sent()) {
            photos.push((name, photo_metadata::read_file(&photo.path)?));
        }
        if let Some(text) = geo_txt(photos.iter().map(|(name, photo)| (*name, photo))) {
            self.add(GEO, text.into_bytes());
        }
        Ok(())
    }

    /// A list of the user's whose lines begin with a photo's name.
    fn own_text(&self, path: &Path, what: &str) -> Result<Vec<u8>, FileError> {
        let text = read_small(path, LIST, what, "name a smaller one")?;
        let (text, named) = self.names.in_list(text, 0);
        if named > 0 {
            return Ok(text);
        }
        let fault = Fault::new(
            "none of its lines begins with the name of one of the photos",
            "write the names as the files are called, or move it elsewhere",
        );
        Err(FileError::new(path, fault))
    }

    fn add_control(&mut self, path: &Path) -> Result<(), FileError> {
        let at = |fault| FileError::new(path, fault);
        let names: Vec<&str> = self
            .set
            .photos
            .iter()
            .map(|photo| photo.name.as_str())
            .collect();
        let (list, warnings) = read_control(path, &names)?;
        let marks = list.points.iter().filter(|point| point.position.is_some());
        let marked = marks
            .flat_map(|point| &point.marks)
            .map(|(photo, _)| photo.as_str());
        // (Marks in the photos have their names by now.)
        let ours = marked.filter(|photo| names.contains(photo)).count();
        if list.crs.is_none() || ours == 0 {
            let what = match list.crs {
                None => {
                    "its first line states no coordinate system, without which OpenDroneMap takes no control points"
                }
                Some(_) => "none of its surveyed points is marked in one of the photos",
            };
            return Err(at(Fault::new(what, "mend it, or leave it out")));
        }
        self.warnings.extend(
            warnings
                .into_iter()
                .map(|warning| format!("{}: {warning}", path.display())),
        );
        let text = read_small(path, LIST, "list of control points", "name a smaller one")?;
        // Behind place and pixel.
        let (text, named) = self.names.in_list(text, 5);
        // OpenDroneMap takes no commas, and passes over what it does not understand: the marks are written for it then.
        let text = match named < ours {
            true => {
                let name_of = |photo: &str| self.names.of_photo(photo).to_owned();
                control_list_text(&list, name_of).into_bytes()
            }
            false => text,
        };
        self.add(GCP, text);
        Ok(())
    }

    /// How many photos there are.
    pub(crate) fn photos(&self) -> usize {
        self.set.photos.len()
    }

    /// How many bytes.
    pub(crate) fn size(&self) -> u64 {
        self.files.iter().map(|file| file.size).sum()
    }

    /// What tells it from other photos and lists: a line a file.
    pub(crate) fn told(&self) -> String {
        let line = |file: &SentFile| match &file.from {
            Origin::Path(_) => format!("{} {}\n", file.size, file.name),
            Origin::Bytes(bytes) => format!(
                "{} {}\n{}\n",
                file.size,
                file.name,
                String::from_utf8_lossy(bytes)
            ),
        };
        self.files.iter().map(line).collect()
    }
}

/// A list of the user's among the photos, whatever its case, as a node finds it.
fn own_list(folder: &Path, name: &str) -> Option<PathBuf> {
    let files = fs::read_dir(folder).ok()?.flatten();
    let is_it = |path: &PathBuf| {
        let file = path.file_name().and_then(|file| file.to_str());
        file.is_some_and(|file| file.eq_ignore_ascii_case(name)) && path.is_file()
    };
    // Of several always the same.
    files.map(|file| file.path()).filter(is_it).min()
}

fn kind_of(name: &str) -> &'static str {
    let ending = name
        .rsplit('.')
        .next()
        .unwrap_or_default()
        .to_ascii_lowercase();
    match ending.as_str() {
        "jpg" | "jpeg" => "image/jpeg",
        "png" => "image/png",
        "tif" | "tiff" => "image/tiff",
        _ => "application/octet-stream",
    }
}
