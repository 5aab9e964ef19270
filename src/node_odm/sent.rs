//! What goes to a node: photos, where they were taken, control points.
//!
//! Whatever the node makes of a file's name comes back in its results, by which the photos are found again. NodeODM
//! turns slashes into underscores, and OpenDroneMap's lists are apart by blanks: so names of photos have to be of
//! letters, digits, `-`, `_` and `.`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::fault::{Fault, first_names};
use crate::files::{FileError, last_segment, read_small};
use crate::formats::photos::photo_metadata;
use crate::geo_txt::geo_txt;
use crate::jobs::Progress;
use crate::opening::read_control;
use crate::reconstruct::PhotoSet;

/// What is sent.
pub(crate) struct Sent {
    /// The photos.
    pub(crate) set: PhotoSet,
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
/// Control points.
const GCP: &str = "gcp_list.txt";
/// A list of places or points has some lines a photo.
const LIST: u64 = 64 << 20;

impl Sent {
    /// Looks what a folder of photos holds, with the control points of a file, or of the folder's `gcp_list.txt`.
    ///
    /// # Errors
    /// Where fewer than three photos can be read, names cannot be sent, or a list is none.
    pub(crate) fn read(
        folder: &Path,
        control: Option<&Path>,
        progress: &Progress,
    ) -> Result<Self, FileError> {
        let at = |fault| FileError::new(folder, fault);
        let set = PhotoSet::read(folder, None, progress)?;
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        let odd: Vec<&str> = (set.photos.iter())
            .map(|photo| photo.name.as_str())
            .filter(|name| !name.chars().all(is_plain))
            .collect();
        if !odd.is_empty() {
            let what = format!(
                "a node changes the names of {} of {} photos ({})",
                odd.len(),
                set.photos.len(),
                first_names(&odd)
            );
            return Err(at(Fault::new(
                what,
                "rename them, of letters A to Z, digits, - and _ alone",
            )));
        }
        let mut files = Vec::new();
        for photo in &set.photos {
            let size = fs::metadata(&photo.path).map_err(|error| {
                let what = format!("it cannot be read ({error})");
                FileError::new(&photo.path, Fault::new(what, "check the disk"))
            })?;
            files.push(SentFile {
                name: photo.name.clone(),
                kind: kind_of(&photo.name),
                from: Origin::Path(photo.path.clone()),
                size: size.len(),
            });
        }
        let mut sent = Self {
            set,
            files,
            warnings: Vec::new(),
        };
        sent.add_places(folder)?;
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
        let own = folder.join(GEO);
        if own.is_file() {
            let text = read_small(&own, LIST, "list of places", "name a smaller one")?;
            self.add(GEO, text);
            return Ok(());
        }
        let mut photos = Vec::new();
        for photo in &self.set.photos {
            photos.push((photo.name.as_str(), photo_metadata::read_file(&photo.path)?));
        }
        if let Some(text) = geo_txt(photos.iter().map(|(name, photo)| (*name, photo))) {
            self.add(GEO, text.into_bytes());
        }
        Ok(())
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
            .map(|(photo, _)| last_segment(photo));
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
