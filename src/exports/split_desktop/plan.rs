//! What an export consists of: its files, before any of them is made.

use std::path::{Path, PathBuf};

use super::ExportRequest;
use super::objects::PhotoObject;
use super::photo_names::PhotoNames;
use super::rectified;
use crate::flight::Outcome;
use crate::photo_file_names::file_names;

/// The fixed files.
pub(super) const CSV: &str = "scales.csv";
pub(super) const SHEET: &str = "scales.html";
pub(super) const GEOJSON: &str = "footprints.geojson";
pub(super) const KML: &str = "footprints.kml";

/// The folders of pictures.
const PHOTOS: &str = "photos";
const OVERLAYS: &str = "overlays";
const THUMBNAILS: &str = "thumbnails";
const MASKS: &str = "masks";
const RECTIFIED: &str = "rectified";

/// The folders that an export into `dir` may write into.
pub fn export_folders(dir: &Path) -> Vec<PathBuf> {
    let below = [PHOTOS, OVERLAYS, THUMBNAILS, MASKS, RECTIFIED];
    let below = below.map(|name| dir.join(name));
    std::iter::once(dir.to_owned()).chain(below).collect()
}

/// For each photo of the flight the names of its pictures, or why it has none. `objects` are those of
/// each photo.
pub(super) fn pictures(
    request: &ExportRequest<'_>,
    objects: &[Vec<PhotoObject<'_>>],
) -> Vec<Result<PhotoNames, String>> {
    let parts = request.review.flight().parts();
    let outcomes = request.review.outcomes();
    let photos = &parts.photos;
    let names: Vec<&str> = photos.iter().map(|photo| photo.name.as_str()).collect();
    let names = file_names(&names).into_iter();
    names
        .enumerate()
        .map(|(index, (stem, extension))| match outcomes.get(index) {
            Some(Outcome::Trouble(trouble)) => Err(format!("no pictures: {trouble}")),
            // They would show bars of a length that nobody knows.
            _ if !parts.unit_known => Err("no pictures: the model's unit is not known".to_owned()),
            _ if request
                .from
                .photo_files
                .get(index)
                .is_none_or(Option::is_none) =>
            {
                Err("no pictures: the photo file is missing".to_owned())
            }
            _ => Ok(PhotoNames {
                photo: format!("{PHOTOS}/{stem}{extension}"),
                overlay: format!("{OVERLAYS}/{stem}.jpg"),
                thumbnail: format!("{THUMBNAILS}/{stem}.jpg"),
                mask: objects
                    .get(index)
                    .is_some_and(|objects| objects.iter().any(PhotoObject::is_masked))
                    .then(|| format!("{MASKS}/{stem}.png")),
                rectified: (request.rectified.is_some()).then(|| {
                    rectified::FORMAT
                        .endings()
                        .map(|end| format!("{RECTIFIED}/{stem}.{end}"))
                }),
            }),
        })
        .collect()
}
