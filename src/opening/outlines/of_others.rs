//! Outlines that another tool made, or a person with it: which file has those of a photo, and what they are in the
//! undistorted photo.

use std::fs;
use std::path::{Path, PathBuf};

use crate::camera::Camera;
use crate::delineation::leave_out;
use crate::fault::Fault;
use crate::files::{last_segment, unreadable_folder};
use crate::flight::Flight;
use crate::formats::{FileError, MaskFile, Masks, OutlinedPhoto};
use crate::picture;
use crate::scale::ImageKind;

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

/// What fragscale writes beside label images, of which nobody reads fragments.
const BESIDE: [&str; 5] = [
    "_outlines.png",
    "_outlines.json",
    "_world.geojson",
    "fragments_coco.json",
    "fragments_cvat.xml",
];

/// Where outlines are looked for.
#[derive(Debug)]
pub struct OutlinesOfOthers {
    path: PathBuf,
    of: Option<ImageKind>,
    place: Place,
}

#[derive(Debug)]
enum Place {
    File(MaskFile),
    /// The files of a folder, by name.
    Folder(Vec<PathBuf>),
}

impl OutlinesOfOthers {
    /// Reads the file, or lists the folder. `of` is the photo that they were outlined in; without it, fragscale's own files are
    /// of the undistorted photo and all others of the original one.
    ///
    /// # Errors
    /// Where it is neither, or the file has no outlines.
    pub fn open(path: &Path, of: Option<ImageKind>) -> Result<Self, FileError> {
        let mut path = path.to_owned();
        let place = if path.is_dir() {
            let entries = fs::read_dir(&path)
                .map_err(|error| FileError::new(&path, unreadable_folder(&error)))?;
            let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
            files.retain(|file| file.is_file());
            files.sort_unstable();
            match the_one_of_many_photos(&files) {
                Some((one, file)) => {
                    path = one;
                    Place::File(file)
                }
                None => Place::Folder(files),
            }
        } else {
            Place::File(MaskFile::read(&path)?)
        };
        Ok(Self { path, of, place })
    }

    /// Whether it has outlines that are said to be of this photo.
    pub fn is_of(&self, name: &str) -> bool {
        match &self.place {
            Place::File(file) if file.is_of_one() => self.is_named_for(&self.path, file, name),
            Place::File(file) => file.photos().any(|other| stem(other) == stem(name)),
            Place::Folder(files) => candidates(files, name).next().is_some(),
        }
    }

    /// All files that may be read.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let files = match &self.place {
            Place::File(_) => std::slice::from_ref(&self.path),
            Place::Folder(files) => files,
        };
        files.iter()
    }

    /// That a file of one photo, which is taken for `name`, is named as the outlines of another of these photos.
    fn named_for_another<'p>(
        &self,
        name: &str,
        mut photos: impl Iterator<Item = &'p str>,
    ) -> Option<String> {
        let Place::File(file) = &self.place else {
            return None;
        };
        // What a file says itself of its photo is said elsewhere.
        if !file.is_of_one() || file.photos().next().is_some() || rank(&self.path, name).is_some() {
            return None;
        }
        let other = photos.find(|other| rank(&self.path, other).is_some())?;
        Some(format!(
            "{} is named as the outlines of {other}",
            self.path.display()
        ))
    }

    /// What of it is of none of these photos, by the names of files in a folder, or of the photos in a file.
    pub fn of_no_photo(&self, photos: &[&str]) -> Vec<String> {
        let of_none = |is_of: &dyn Fn(&str) -> bool| !photos.iter().any(|photo| is_of(photo));
        match &self.place {
            Place::File(file) if file.is_of_one() => Vec::new(),
            Place::File(file) => file
                .photos()
                .filter(|other| of_none(&|photo| stem(photo) == stem(other)))
                .map(str::to_owned)
                .collect(),
            Place::Folder(files) => files
                .iter()
                .filter(|path| may_be_outlines(path))
                .filter(|path| {
                    of_none(&|photo| rank(path, photo).is_some() || is_photo(path, photo))
                })
                .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
                .collect(),
        }
    }

    /// The label image of a flight's undistorted photo without what of it is `left_out` (`delineation::photo::left_out`), with what
    /// is to be said about it. `is_only`: no other photo is asked for, so that a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read; the file is named.
    pub fn of_flights_photo(
        &self,
        flight: &Flight,
        index: usize,
        left_out: &[bool],
        is_only: bool,
    ) -> Result<Masks, Fault> {
        let photos = &flight.parts().photos;
        let photo = &photos[index];
        let mut masks = self.of_photo(&photo.name, flight.camera(photo), is_only)?;
        leave_out(&mut masks.labels, left_out);
        if is_only {
            let names = photos.iter().map(|photo| photo.name.as_str());
            masks
                .notes
                .extend(self.named_for_another(&photo.name, names));
        }
        Ok(masks)
    }

    /// The label image of the undistorted photo, with what is to be said about it. `is_only`: no other photo is asked for, so
    /// that a file of one photo is of this one.
    ///
    /// # Errors
    /// Where there is none of this photo, or it cannot be read; the file is named.
    fn of_photo(&self, name: &str, camera: &Camera, is_only: bool) -> Result<Masks, Fault> {
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
                    // The same of all photos: it is said once.
                    Fault::new(what, "put them there, named as the photo (NAME_labels.png)")
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
            Some(of) => of == ImageKind::Undistorted,
            None => file.is_own(),
        };
        if self.of.is_none() {
            let note = match is_undistorted {
                true => "fragscale's own outlines: taken as those of the undistorted photo",
                false => "taken as outlines of the photo as shot, not of the undistorted one",
            };
            masks.notes.push(note.to_owned());
        }
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

/// The one file of a folder that may be outlines, where it has those of many photos: an export of COCO or CVAT lies in a folder of its
/// own, perhaps beside its photos.
fn the_one_of_many_photos(files: &[PathBuf]) -> Option<(PathBuf, MaskFile)> {
    let mut may_be = files.iter().filter(|path| may_be_outlines(path));
    let (Some(one), None) = (may_be.next(), may_be.next()) else {
        return None;
    };
    // What is wrong with it is said where a photo's outlines are asked for.
    let file = MaskFile::read(one).ok()?;
    (!file.is_of_one()).then(|| (one.clone(), file))
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

/// Whether outlines may be in a file of this name: not what fragscale writes beside label images.
fn may_be_outlines(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_lowercase();
    let kinds = [".png", ".tif", ".tiff", ".json", ".geojson", ".xml"];
    kinds.iter().any(|kind| name.ends_with(kind)) && !BESIDE.iter().any(|own| name.ends_with(own))
}

/// Whether a file is the photo itself.
fn is_photo(path: &Path, photo: &str) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| name.to_lowercase() == last_segment(photo).to_lowercase())
}

/// Which ending a photo's file has; `None` where it is not named as the photo, or is the photo.
fn rank(path: &Path, photo: &str) -> Option<usize> {
    let name = path.file_name()?.to_str()?.to_lowercase();
    if is_photo(path, photo) {
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
        // What is of no photo is named: neither photos nor what lies beside label images.
        let folder = OutlinesOfOthers {
            path: "masks".into(),
            of: None,
            place: Place::Folder(files),
        };
        assert!(folder.is_of("IMG_00051.jpg") && !folder.is_of("IMG_0006.jpg"));
        let of_none = folder.of_no_photo(&["a/IMG_0005.jpg", "b.jpg"]);
        assert_eq!(of_none, ["IMG_00051_labels.png"]);
    }

    /// As Roboflow and CVAT export it: one file of all photos, perhaps beside them.
    #[test]
    fn a_folder_may_hold_one_file_of_many_photos() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("DJI_0005.jpg", "a photo");
        write(
            "_annotations.coco.json",
            r#"{"images": [{"id": 1, "file_name": "DJI_0005.jpg", "width": 4, "height": 4}], "categories": [], "annotations": []}"#,
        );
        let open = || OutlinesOfOthers::open(folder.path(), None).unwrap();
        assert!(open().is_of("DJI_0005.jpg"));
        assert!(!open().is_of("DJI_0006.jpg"));
        // Beside files of single photos their names count.
        write("DJI_0006_labels.png", "a label image");
        assert!(!open().is_of("DJI_0005.jpg"));
        assert!(open().is_of("DJI_0006.jpg"));
    }
}
