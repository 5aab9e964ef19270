//! Around the params folder: the .p4d project, an XML list of photos, and its results.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::files::{last_segment, read_text};
use crate::packages::reconstruction::Reconstruction;
use crate::text::xml_document;

/// The one .p4d of a folder.
pub(super) fn file_in(folder: &Path) -> Option<PathBuf> {
    let mut projects = files(folder, &["p4d"]).into_iter();
    let first = projects.next()?;
    projects.next().is_none().then_some(first)
}

/// Where the results of a .p4d lie: in the folder of its name beside it, or around it.
pub(super) fn results(project: &Path) -> Option<PathBuf> {
    let folder = project.parent()?;
    [folder.join(project.file_stem()?), folder.to_owned()]
        .into_iter()
        .find(|folder| super::is_params(&folder.join(super::PARAMS)))
}

/// The one dense cloud of a project's folder. Where it was cut into tiles or groups, which makes
/// them one is not for a reader to guess.
pub(super) fn surface(folder: &Path, warnings: &mut Vec<String>) -> Option<PathBuf> {
    let clouds = files(&folder.join("2_densification/point_cloud"), &["las", "laz"]);
    match clouds.as_slice() {
        [] => None,
        [cloud] => Some(cloud.clone()),
        several => {
            warnings.push(format!(
                "the dense cloud is in {} files in 2_densification/point_cloud: name one as the \
                 surface",
                several.len()
            ));
            None
        }
    }
}

/// How many photos of the project have no pose, in words.
pub(super) fn not_calibrated(project: &Path, found: &Reconstruction) -> Option<String> {
    let text = read_text(project).ok()?;
    let document = xml_document::parse(&text).ok()?;
    let posed: HashSet<&str> = found
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    let missing = document
        .descendants()
        .filter(|node| node.has_tag_name("image"))
        .filter_map(|node| node.attribute("path"))
        .filter(|path| !posed.contains(last_segment(path)))
        .count();
    (missing > 0).then(|| format!("{missing} photos were not calibrated and are left out"))
}

/// The files of a folder with one of these extensions, sorted.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            let extension = path
                .extension()
                .map(|end| end.to_string_lossy().to_ascii_lowercase());
            extension.is_some_and(|end| extensions.contains(&end.as_str())) && path.is_file()
        })
        .collect();
    found.sort();
    found
}
