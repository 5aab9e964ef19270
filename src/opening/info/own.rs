//! What fragscale wrote itself, and label images: files and folders that are there to be looked at or given to one command, and
//! that look like photos, cameras or clouds to who does not know them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::files::result_in_words;
use crate::formats::photos::image_names::is_image;
use crate::formats::photos::photos_below::is_label_image;
use crate::formats::{Candidate, CloudFormat, Kind, Package, candidates};

/// Files of our folders without a mark.
const UNMARKED: [&str; 3] = ["season.lock", "export.json", "footprints.geojson"];

/// Files of the folder of a season's results, in whose folders each flight's lie.
const OF_SEASONS: [&str; 2] = ["season.lock", "season.csv"];

/// What a file or folder is that fragscale wrote, or a label image; `None` of any other, and of what is read by its `kind`.
pub(super) fn own_info(path: &Path, kind: Option<&Kind>) -> Option<Value> {
    match kind {
        // Photos may be pictures of ours; what has words or points may be our words.
        None | Some(Kind::Camera | Kind::Cloud(_) | Kind::Reconstruction(Package::Photos, _)) => {}
        Some(_) => return None,
    }
    if path.is_dir() {
        return folder_info(path);
    }
    let is_picture = matches!(
        kind,
        Some(Kind::Cloud(CloudFormat::GeoTiff) | Kind::Reconstruction(Package::Photos, _))
    );
    if is_picture && is_label_image(path) {
        let what =
            "a label image of fragments, no photo: 'fragscale delineate' takes it as --masks";
        return Some(said("label-image", what));
    }
    let words = result_in_words(path)?;
    Some(said("result", &format!("{words} that fragscale wrote")))
}

fn said(kind: &str, what: &str) -> Value {
    let warnings: [&str; 0] = [];
    json!({"kind": kind, "what": what, "warnings": warnings})
}

/// A folder in which nothing lies but what fragscale wrote, tables or pages among it: pictures alone may be photos to somebody. One above
/// flights is theirs, a plan or report in it or not, but for the results of a season.
fn folder_info(folder: &Path) -> Option<Value> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    let mut words = BTreeSet::new();
    for file in files.iter().filter(|path| path.is_file()) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.') || UNMARKED.contains(&&*name) {
            continue;
        }
        match result_in_words(file) {
            Some(_) if is_image(&name) => {}
            Some(result) => {
                words.insert(result);
            }
            None => return None,
        }
    }
    let is_season = || OF_SEASONS.iter().any(|name| folder.join(name).is_file());
    if words.is_empty() || !is_season() && candidates(folder).iter().any(is_others) {
        return None;
    }
    let words: Vec<&str> = words.into_iter().collect();
    let what = format!("results of fragscale ({})", words.join(", "));
    Some(said("results", &what))
}

/// Whether a flight or reconstruction in a folder or below is one to open: pictures of ours are none.
fn is_others(candidate: &Candidate) -> bool {
    if candidate.package != Some(Package::Photos) {
        return true;
    }
    let entries = fs::read_dir(&candidate.path)
        .into_iter()
        .flatten()
        .flatten();
    let mut files = entries.map(|entry| entry.path());
    files.any(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        is_image(&name) && !is_label_image(&file) && result_in_words(&file).is_none()
    })
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

    use super::*;
    use crate::files::{HTML_MARK, marked_png};
    use crate::info;
    use crate::jobs::Progress;

    const SCALES: &str = "photo,width_px,height_px,top_px_per_cm,bottom_px_per_cm\n";

    fn png() -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        RgbImage::new(8, 6)
            .write_to(&mut bytes, image::ImageFormat::Png)
            .unwrap();
        bytes.into_inner()
    }

    #[test]
    fn what_fragscale_wrote_is_said_to_be_that() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            fs::write(&path, bytes).unwrap();
            path
        };
        let said = |path: &Path| {
            let said = info(path, &Progress::default()).unwrap();
            let words = |key: &str| said[key].as_str().unwrap().to_owned();
            (words("kind"), words("what"))
        };
        let result = |what: &str| ("result".to_owned(), what.to_owned());
        let scales = write("scales.csv", SCALES.as_bytes());
        let of_scales = result("a table of scales that fragscale wrote");
        assert_eq!(said(&scales), of_scales);
        let outlines = write("a_outlines.png", &marked_png(png()));
        let of_picture = result("a picture that fragscale wrote");
        assert_eq!(said(&outlines), of_picture);
        let labels = write("a_labels.png", &marked_png(png()));
        assert_eq!(said(&labels).0, "label-image");
        let (kind, what) = said(folder.path());
        assert_eq!(
            (kind.as_str(), what.as_str()),
            ("results", "results of fragscale (a table of scales)")
        );
        // With a photo of somebody's beside it the folder is one of photos.
        write("photo.png", &png());
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["kind"], "photos");
    }

    /// A plan that was put above the flights, and the page of a season's results.
    #[test]
    fn a_page_above_flights_hides_them_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let page = format!("<!DOCTYPE html>\n<html>\n<head>\n{HTML_MARK}\n");
        fs::write(path("plan.html"), page).unwrap();
        let of_page = "results of fragscale (a page)";
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["what"], of_page);
        // Pictures of ours in a folder within it change nothing.
        fs::create_dir(path("pictures")).unwrap();
        fs::write(path("pictures/a.png"), marked_png(png())).unwrap();
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["what"], of_page);
        fs::create_dir(path("a")).unwrap();
        fs::write(path("a/flight.toml"), "format = 1\n").unwrap();
        let error = info(folder.path(), &Progress::default()).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("but in its folders (a/flight.toml"),
            "{error}"
        );
        fs::write(path("season.lock"), "").unwrap();
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["what"], of_page);
    }

    /// Labels of others lie beside photos or alone.
    #[test]
    fn label_images_are_no_photos() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        fs::write(path("a.labels.png"), png()).unwrap();
        let said = info(&path("a.labels.png"), &Progress::default()).unwrap();
        assert!(said["what"].as_str().unwrap().contains("--masks"), "{said}");
        assert!(info(folder.path(), &Progress::default()).is_err());
        fs::write(path("a.png"), png()).unwrap();
        let said = info(folder.path(), &Progress::default()).unwrap();
        assert_eq!(said["photos"].as_array().map(Vec::len), Some(1));
    }
}
