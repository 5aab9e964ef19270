//! Outlines of fragments that were saved beside a flight.toml to go on with: `fragments/NAME.png`, a label image, with
//! `fragments/NAME_outlines.json`, which says what it is of.

mod followed;
mod named_files;
mod of_others;
mod turned;

use std::path::{Path, PathBuf};

use crate::camera::Camera;
use crate::delineation::Outliner;
use crate::delineation::saved::SavedOutlines;
use crate::fault::Fault;
use crate::files::sha256_of_file;
use crate::formats::{FileError, OutlinedPhoto, read_bytes, read_masks};
use crate::labels::Outlines;

pub use self::of_others::OutlinesOfOthers;

/// The folder beside flight.toml.
const FOLDER: &str = "fragments";

/// What of a photo was saved.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlinesRead {
    /// The fragments.
    pub outlines: Outlines,
    /// What outlined them first, and how it errs as far as that is known today.
    pub by: Outliner,
    /// What was mended.
    pub notes: Vec<String>,
}

/// A photo's two files beside a flight.toml: the label image, and what it is of. `stem` is what the photo's files are
/// called.
pub fn outline_files(flight_file: &Path, stem: &str) -> [PathBuf; 2] {
    let folder = flight_file.with_file_name(FOLDER);
    [
        folder.join(format!("{stem}.png")),
        folder.join(format!("{stem}_outlines.json")),
    ]
}

/// The same where they are there.
pub fn saved_outlines(flight_file: &Path, stem: &str) -> Option<[PathBuf; 2]> {
    Some(outline_files(flight_file, stem)).filter(|[picture, _]| picture.is_file())
}

/// Reads them. `photo` is what the flight calls it, `photo_file` where it is, if it is there.
///
/// # Errors
/// Where a file is missing or broken, or of the photo of another size or lens, or of another photo of that name.
pub fn read_outlines(
    files: &[PathBuf; 2],
    photo: &str,
    camera: &Camera,
    photo_file: Option<&Path>,
) -> Result<OutlinesRead, FileError> {
    let [picture, json] = files;
    let text = read_bytes(json)?;
    let at = |fault| FileError::new(json, fault);
    let saved = SavedOutlines::from_json(&String::from_utf8_lossy(&text)).map_err(at)?;
    if !saved.is_of(camera) {
        let what = "these outlines are of the photo with another lens";
        let remedy =
            "outline the photo anew, or take the calibration back that it was outlined with";
        return Err(at(Fault::new(what, remedy)));
    }
    // What cannot be read is said where its pixels are wanted.
    let now = photo_file.and_then(|file| sha256_of_file(file, || false).ok());
    if let (Some(then), Some(now)) = (&saved.picture, now)
        && *then != now
    {
        let what = "these outlines are of another picture with the photo's name: of another flight that was saved in this folder, or the photo's file \
                    was replaced";
        let remedy = "outline the photo anew, or save the flight in a folder of its own";
        return Err(at(Fault::new(what, remedy)));
    }
    let of = OutlinedPhoto {
        name: photo,
        width: camera.width,
        height: camera.height,
    };
    let masks = read_masks(picture, &of)?;
    Ok(OutlinesRead {
        outlines: Outlines::new(masks.labels, saved.sure),
        by: saved.by.of_today(camera.width, camera.height),
        notes: masks.notes,
    })
}
