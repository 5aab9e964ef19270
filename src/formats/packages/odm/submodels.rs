//! An OpenDroneMap project that was split: its submodels, joined.
//!
//! Written from ODM's `stages/splitmerge.py`. With `--split` the project's folder has a folder
//! `submodels` with a whole project in each `submodel_0000`, `submodel_0001`, ... Merging writes a
//! common cloud, and since 2021 `cameras.json` and `odm_report/shots.geojson` as well; a project that
//! has these is read as any other, and only one without is joined here.
//!
//! Submodels overlap by design (`--split-overlap`): a photo may be in several, with slightly other
//! poses. That of the first submodel by name is kept. Only submodels in one coordinate system can be
//! joined; ODM aligns them to each other in it.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::surface::surface;
use super::{is_odm_folder, read_one};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::FileError;
use crate::packages::reconstruction::{Observation, PosedPhoto, Project, Reconstruction};

/// The submodels of a project's folder or of its folder `submodels`, sorted by name.
pub(super) fn submodels_of(dir: &Path) -> Vec<PathBuf> {
    for parent in [dir.join("submodels"), dir.to_owned()] {
        let entries = fs::read_dir(parent).into_iter().flatten().flatten();
        let mut found: Vec<PathBuf> = entries
            .filter(|entry| entry.file_name().to_string_lossy().starts_with("submodel"))
            .map(|entry| entry.path())
            .filter(|path| is_odm_folder(path))
            .collect();
        if !found.is_empty() {
            found.sort_unstable();
            return found;
        }
    }
    Vec::new()
}

/// Reads and joins the submodels of `dir`.
///
/// # Errors
/// Names the submodel's file that cannot be used, or the submodels that cannot be joined.
pub(super) fn read(dir: &Path, submodels: &[PathBuf]) -> Result<Project, FileError> {
    let mut projects = Vec::with_capacity(submodels.len());
    for submodel in submodels {
        projects.push((name_of(submodel), read_one(submodel)?));
    }
    let crs = |project: &Project| project.reconstruction.crs.clone();
    let first = projects.first().and_then(|(_, project)| crs(project));
    let in_one_system =
        first.is_some() && projects.iter().all(|(_, project)| crs(project) == first);
    if projects.len() > 1 && !in_one_system {
        let names: Vec<&str> = projects.iter().map(|(name, _)| name.as_str()).collect();
        let what = format!(
            "its {} submodels ({}) are not all georeferenced in one coordinate system, so they cannot be joined",
            names.len(),
            names.join(", ")
        );
        return Err(FileError::new(dir, Fault::new(what, "open one of them")));
    }
    let mut joined = Joined::default();
    let mut own = Project::default();
    for (name, project) in projects {
        own.surface = own.surface.or(project.surface);
        own.surface_note = own.surface_note.or(project.surface_note);
        own.photos = own.photos.or(project.photos);
        joined.add(&name, project.reconstruction);
    }
    let images = Some(dir.join("images")).filter(|folder| folder.is_dir());
    let (common, note) = surface(dir);
    let mut reconstruction = joined.finish();
    reconstruction.crs = first;
    if submodels.len() > 1 {
        if common.is_none() {
            reconstruction.warnings.push(
                "the submodels' dense clouds are not joined: the sparse points serve as the surface, \
                 unless another one is given"
                    .to_owned(),
            );
        }
        own.surface = None;
        own.surface_note = None;
    }
    let surface_note = if common.is_some() || own.surface.is_none() {
        note
    } else {
        own.surface_note
    };
    Ok(Project {
        reconstruction,
        surface: common.or(own.surface),
        surface_note,
        photos: images.or(own.photos),
    })
}

fn name_of(submodel: &Path) -> String {
    let name = submodel.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// The reconstruction that submodels are added to.
#[derive(Default)]
struct Joined {
    found: Reconstruction,
    /// Index into the photos, by name.
    photos: HashMap<String, u32>,
    in_several: usize,
    submodels: usize,
    without_colors: bool,
}

impl Joined {
    fn add(&mut self, submodel: &str, part: Reconstruction) {
        self.submodels += 1;
        let found = &mut self.found;
        found.package = part.package;
        found.sizes = part.sizes;
        found.named_sizes.extend(part.named_sizes);
        let said = part.warnings.iter();
        found
            .warnings
            .extend(said.map(|warning| format!("{submodel}: {warning}")));
        let cameras: Vec<usize> = part
            .cameras
            .into_iter()
            .map(|camera| add_camera(&mut found.cameras, camera, submodel))
            .collect();
        // Where each photo of the part went; `None` where another submodel's stands.
        let mut photos = Vec::with_capacity(part.photos.len());
        for photo in part.photos {
            let next = found.photos.len() as u32;
            if self.photos.contains_key(&photo.name) {
                self.in_several += 1;
                photos.push(None);
                continue;
            }
            self.photos.insert(photo.name.clone(), next);
            photos.push(Some(next));
            let camera = cameras.get(photo.camera).copied().unwrap_or_default();
            found.photos.push(PosedPhoto { camera, ..photo });
        }
        let before = found.cloud.points.len() as u32;
        self.without_colors |= part.cloud.colors.len() != part.cloud.points.len();
        found.cloud.points.extend(part.cloud.points);
        found.cloud.colors.extend(part.cloud.colors);
        let kept = part.observations.into_iter().filter_map(|observation| {
            Some(Observation {
                photo: (*photos.get(observation.photo as usize)?)?,
                point: before.checked_add(observation.point)?,
                pixel: observation.pixel,
            })
        });
        found.observations.extend(kept);
        // Of a single submodel it stands; several medians make no common one.
        found.solved_reprojection_px = part.solved_reprojection_px.filter(|_| self.submodels == 1);
    }

    fn finish(mut self) -> Reconstruction {
        if self.without_colors {
            self.found.cloud.colors.clear();
        }
        if self.submodels > 1 {
            self.found.warnings.push(format!(
                "{} submodels are joined; {} photos are in several of them: the pose of the first is taken",
                self.submodels, self.in_several
            ));
        }
        self.found
    }
}

/// The place of a camera among those that are there, under another name where its own means another
/// camera.
fn add_camera(cameras: &mut Vec<Camera>, camera: Camera, submodel: &str) -> usize {
    if let Some(same) = cameras.iter().position(|known| *known == camera) {
        return same;
    }
    let is_taken = cameras.iter().any(|known| known.name == camera.name);
    let name = if is_taken {
        format!("{} ({submodel})", camera.name)
    } else {
        camera.name.clone()
    };
    cameras.push(Camera { name, ..camera });
    cameras.len() - 1
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tempfile::TempDir;

    use super::*;
    use crate::packages::odm::read_folder;

    /// A submodel of photos that look straight down, each with a point 10 below it on its axis.
    fn submodel(dir: &Path, name: &str, focal: f64, photos: &[(&str, f64)], zone: &str) {
        let camera = format!(
            r#"{{"projection_type": "brown", "focal_x": {focal}, "focal_y": {focal}, "width": 400, "height": 200}}"#
        );
        let shot = |(name, east): &(&str, f64)| {
            format!(
                r#""{name}": {{"camera": "c", "rotation": [3.141592653589793, 0, 0], "translation": [{}, 0, 50]}}"#,
                -east
            )
        };
        let point = |(name, east): &(&str, f64)| {
            format!(r#""of {name}": {{"coordinates": [{east}, 0, 40], "color": [1, 2, 3]}}"#)
        };
        let all = |of: &dyn Fn(&(&str, f64)) -> String| {
            photos.iter().map(of).collect::<Vec<_>>().join(", ")
        };
        let tracks: String = photos
            .iter()
            .map(|(name, _)| format!("{name}\tof {name}\t0\t0.01\t0\t1\t2\t3\n"))
            .collect();
        for (file, content) in [
            ("cameras.json", format!(r#"{{"c": {camera}}}"#)),
            (
                "opensfm/reconstruction.json",
                format!(
                    r#"[{{"cameras": {{"c": {camera}}}, "shots": {{{}}}, "points": {{{}}}}}]"#,
                    all(&shot),
                    all(&point)
                ),
            ),
            ("opensfm/tracks.csv", tracks),
            ("opensfm/exported_geocoords.txt", String::new()),
            (
                "odm_georeferencing/coords.txt",
                format!("WGS84 UTM {zone}\n500000 4000000\n"),
            ),
            (
                "odm_georeferencing/odm_georeferenced_model.laz",
                String::new(),
            ),
        ] {
            let file = dir.join("submodels").join(name).join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, content).unwrap();
        }
    }

    #[test]
    fn submodels_of_one_system_are_joined() {
        let dir = TempDir::new().unwrap();
        submodel(
            dir.path(),
            "submodel_0000",
            0.5,
            &[("a.jpg", 1.0), ("b.jpg", 2.0)],
            "33N",
        );
        submodel(
            dir.path(),
            "submodel_0001",
            0.6,
            &[("b.jpg", 2.1), ("c.jpg", 3.0)],
            "33N",
        );
        fs::create_dir(dir.path().join("images")).unwrap();
        for opened in [dir.path().to_owned(), dir.path().join("submodels")] {
            let found = read_folder(&opened).unwrap().reconstruction;
            let photos: Vec<(&str, usize, f64)> = found
                .photos
                .iter()
                .map(|p| (p.name.as_str(), p.camera, p.pose.center.x))
                .collect();
            let east = 500_000.0;
            let expected = [
                ("a.jpg", 0, east + 1.0),
                ("b.jpg", 0, east + 2.0),
                ("c.jpg", 1, east + 3.0),
            ];
            assert_eq!(photos, expected);
            assert_eq!(found.crs.as_deref(), Some("EPSG:32633"));
            assert_eq!(found.cameras[1].name, "c (submodel_0001)");
            assert_eq!(found.cameras[1].fx, 240.0);
            assert_eq!((found.cloud.points.len(), found.cloud.colors.len()), (4, 4));
            // b's second point was seen from the pose that is not kept.
            assert_eq!(found.observations.len(), 3);
            let last = found.observations[2];
            assert_eq!((last.photo, last.point), (2, 3));
            assert_eq!(
                found.cloud.points[3],
                DVec3::new(east + 3.0, 4_000_000.0, 40.0)
            );
            // Each was seen 0.01 of the longer side off.
            assert!((found.median_reprojection_px().unwrap() - 4.0).abs() < 1e-6);
            assert!(
                found.warnings[0].contains("1 photos are in several"),
                "{:?}",
                found.warnings
            );
            assert!(found.warnings[1].contains("not joined"));
        }
        let project = read_folder(dir.path()).unwrap();
        assert_eq!(
            (project.surface, project.photos),
            (None, Some(dir.path().join("images")))
        );
        let common = dir
            .path()
            .join("odm_georeferencing/odm_georeferenced_model.las");
        fs::create_dir(dir.path().join("odm_georeferencing")).unwrap();
        fs::write(&common, "").unwrap();
        assert_eq!(read_folder(dir.path()).unwrap().surface, Some(common));
    }

    #[test]
    fn a_single_submodel_is_the_project() {
        let dir = TempDir::new().unwrap();
        submodel(dir.path(), "submodel_0000", 0.5, &[("a.jpg", 1.0)], "33N");
        let project = read_folder(dir.path()).unwrap();
        assert!(project.surface.is_some_and(|file| file.is_file()));
        assert_eq!(project.reconstruction.warnings, [""; 0]);
    }

    #[test]
    fn submodels_of_different_systems_are_named() {
        let dir = TempDir::new().unwrap();
        submodel(dir.path(), "submodel_0000", 0.5, &[("a.jpg", 1.0)], "33N");
        submodel(dir.path(), "submodel_0001", 0.5, &[("b.jpg", 1.0)], "32N");
        let error = read_folder(dir.path()).unwrap_err().to_string();
        assert!(error.contains("submodel_0000, submodel_0001"), "{error}");
        assert!(submodels_of(Path::new("src")).is_empty());
    }
}
