//! Outlines that another tool made, or a person with it: which file has those of a photo, and what they are in the
//! undistorted photo.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::{last_segment, unreadable_folder};
use crate::formats::{FileError, MaskFile, Masks, OutlinedPhoto};
use crate::picture;

/// `--masks`.
#[derive(Debug, Clone, Args)]
pub(super) struct MasksArguments {
    /// Outlines of another tool in place of an engine's: label images (PNG, TIFF), COCO, LabelMe, CVAT for images 1.1 or
    /// GeoJSON in pixels. A file, or a folder of files named as the photos (NAME.png, NAME_labels.png, NAME_mask.png,
    /// NAME_pred.tif, NAME.json, NAME.geojson, ...). Where they overlap, the smaller lies on top; what nobody outlined is
    /// fines, all of it; nothing smaller than the smallest outline is claimed.
    #[arg(long, value_name = "PATH", conflicts_with = "engine")]
    pub(super) masks: Option<PathBuf>,
    /// Which photo they were outlined in; without it, fragscale's own files are of the undistorted photo and all others of
    /// the original one.
    #[arg(long, value_enum, value_name = "PHOTO", requires = "masks")]
    masks_of: Option<MasksOf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum MasksOf {
    /// The photo as the camera took it.
    Original,
    /// The photo without its lens, as fragscale exports it.
    Undistorted,
}

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

/// Where outlines are looked for.
pub(super) struct OutlinesOfOthers {
    path: PathBuf,
    of: Option<MasksOf>,
    place: Place,
}

enum Place {
    File(MaskFile),
    /// The files of a folder, by name.
    Folder(Vec<PathBuf>),
}

impl OutlinesOfOthers {
    /// Reads the file, or lists the folder.
    ///
    /// # Errors
    /// Where it is neither, or the file has no outlines.
    pub(super) fn open(arguments: &MasksArguments) -> Result<Option<Self>, String> {
        let Some(path) = &arguments.masks else {
            return Ok(None);
        };
        let place = if path.is_dir() {
            let entries = fs::read_dir(path)
                .map_err(|error| FileError::new(path, unreadable_folder(&error)).to_string())?;
            let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
            files.retain(|file| file.is_file());
            files.sort_unstable();
            Place::Folder(files)
        } else {
            Place::File(MaskFile::read(path).map_err(|error| error.to_string())?)
        };
        Ok(Some(Self {
            path: path.clone(),
            of: arguments.masks_of,
            place,
        }))
    }

    /// The label image of the undistorted photo, with what is to be said about it. `is_only`: no other photo is asked for, so
    /// that a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read; the file is named.
    pub(super) fn of_photo(
        &self,
        name: &str,
        camera: &Camera,
        is_only: bool,
    ) -> Result<Masks, Fault> {
        let photo = OutlinedPhoto {
            name,
            width: camera.width,
            height: camera.height,
        };
        let named = |path: &Path, fault: Fault| {
            Fault::new(
                FileError::new(path, fault.clone())
                    .to_string()
                    .replace(&format!("; {}", fault.remedy), ""),
                fault.remedy,
            )
        };
        let mut passed_over = None;
        let read;
        let (path, file) = match &self.place {
            Place::File(file) => {
                if file.is_of_one() && !is_only && !self.is_named_for(&self.path, file, name) {
                    let what = "it has the outlines of one photo, which its name does not say to be this one";
                    let remedy = "name the photo (--photo), or name the file as the photo";
                    return Err(named(&self.path, Fault::new(what, remedy)));
                }
                (self.path.as_path(), file)
            }
            Place::Folder(files) => {
                let mut candidates = candidates(files, name);
                let path = candidates.next().ok_or_else(|| {
                    let what = format!("there are no outlines of it in {}", self.path.display());
                    let remedy = format!(
                        "put them there, named as the photo ({}_labels.png)",
                        stem(name)
                    );
                    Fault::new(what, remedy)
                })?;
                passed_over = candidates.next();
                read = MaskFile::read(path).map_err(|error| named(path, error.fault))?;
                (path, &read)
            }
        };
        let mut masks = file.of_photo(&photo).map_err(|fault| named(path, fault))?;
        if let Some(other) = passed_over {
            let file = |path: &Path| {
                path.file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned()
            };
            masks
                .notes
                .push(format!("{} is taken, not {}", file(path), file(other)));
        }
        let is_undistorted = match self.of {
            Some(of) => of == MasksOf::Undistorted,
            None => file.is_own(),
        };
        if !is_undistorted {
            masks.labels = picture::undistorted_labels(&masks.labels, camera);
        }
        Ok(masks)
    }

    /// Whether the name of a file of one photo, or the photo that it names, is this photo's.
    fn is_named_for(&self, path: &Path, file: &MaskFile, photo: &str) -> bool {
        let same = |other: &str| stem(other).eq_ignore_ascii_case(stem(photo));
        rank(path, photo).is_some() || file.photos().any(same)
    }
}

/// The files of a folder that may be a photo's outlines, the likeliest first.
fn candidates<'a>(files: &'a [PathBuf], photo: &str) -> impl Iterator<Item = &'a Path> {
    let ranked = files
        .iter()
        .filter_map(|path| Some((rank(path, photo)?, path.as_path())));
    let mut ranked: Vec<(usize, &Path)> = ranked.collect();
    ranked.sort();
    ranked.into_iter().map(|(_, path)| path)
}

/// Which ending a photo's file has; `None` where it is not named as the photo, or is the photo.
fn rank(path: &Path, photo: &str) -> Option<usize> {
    let name = path.file_name()?.to_str()?.to_lowercase();
    if name == last_segment(photo).to_lowercase() {
        return None;
    }
    let ending = name.strip_prefix(&stem(photo).to_lowercase())?;
    let known = ENDINGS.iter().position(|known| ending == *known);
    let of_model = ending.starts_with('_') && ending.ends_with("_pred.tif");
    known.or(of_model.then_some(ENDINGS.len()))
}

/// The last part of a path without what is behind its last dot.
fn stem(name: &str) -> &str {
    let name = last_segment(name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_known_by_the_name_of_their_photo() {
        let files = [
            "IMG_0005.jpg",
            "IMG_0005.json",
            "IMG_0005_labels.png",
            "IMG_00051_labels.png",
            "img_0005_full_set_pred.tif",
            "IMG_0005_outlines.png",
            "IMG_0005.png",
        ];
        let files: Vec<PathBuf> = files
            .iter()
            .map(|name| Path::new("masks").join(name))
            .collect();
        let found = |photo: &str| -> Vec<String> {
            let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
            candidates(&files, photo).map(name).collect()
        };
        assert_eq!(
            found("photos/IMG_0005.jpg"),
            [
                "IMG_0005_labels.png",
                "IMG_0005.json",
                "IMG_0005.png",
                "img_0005_full_set_pred.tif"
            ]
        );
        // The photo itself is no outline.
        assert_eq!(found("IMG_0005.png").len(), 3);
        assert!(found("IMG_0006.jpg").is_empty());
    }
}
