//! An OpenDroneMap project folder, as it stands on disk.
//!
//! Written from ODM's source (`opendm/types.py`: the tree; `opendm/shots.py`, `opendm/camera.py`,
//! `stages/run_opensfm.py`, `stages/odm_report.py`). What is read; one source of poses and one of
//! cameras must be there:
//!
//! | file | what it gives |
//! |---|---|
//! | `cameras.json` | the cameras (cameras.rs) |
//! | `odm_report/shots.geojson` | poses and the order of the photos (shots.rs) |
//! | `opensfm/reconstruction.json` | sparse points, each photo's camera; cameras and poses where the above are missing |
//! | `opensfm/tracks.csv` | where photos show the sparse points |
//! | `odm_georeferencing/{coords,proj}.txt`, `.../alignment_matrix.json`, `opensfm/geocoords_transformation.txt` | the frames (georeference.rs) |
//! | the dense clouds and the elevation model (surface.rs) | the surface |
//! | `odm_report/stats.json`, else `opensfm/stats/stats.json` | how sure the world's scale is (opensfm/stats.rs) |
//! | `img_list.txt`, else `images.json` | which photos there were before the alignment |
//! | `images/` | the photos |
//!
//! Intrinsics stand for the image size of the solution, which is often a reduced one. The cloud in
//! `odm_filterpoints` is in the local frame, so it is no surface. A project of submodels alone is joined
//! (submodels.rs).

mod cameras;
mod georeference;
mod poses;
mod shots;
mod submodels;
mod surface;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::DVec3;
use serde::Deserialize;

use crate::fault::Fault;
use crate::files::{FileError, read_bytes, text_from_bytes};
use crate::packages::opensfm::{self, OpenSfm};
use crate::packages::pose_covariance::PoseCovariance;
use crate::packages::reconstruction::{PosedPhoto, Project, Reconstruction, Sizes};
use crate::scale::StatedErrors;
use crate::text::json::parse;
use cameras::with_cameras;
pub(crate) use georeference::crs_from_text;
use georeference::{Frames, optional};
use poses::{from_shots, from_sparse};
use surface::surface;

/// Whether a folder looks like an OpenDroneMap project that has poses, or submodels that have.
pub(crate) fn is_project(dir: &Path) -> bool {
    is_odm_folder(dir) || !submodels::submodels_of(dir).is_empty()
}

/// Whether a folder looks like an OpenDroneMap project that has poses itself.
fn is_odm_folder(dir: &Path) -> bool {
    dir.join("odm_report/shots.geojson").is_file()
        || (dir.join("opensfm/reconstruction.json").is_file()
            && (dir.join("odm_georeferencing").is_dir() || dir.join("cameras.json").is_file()))
}

/// Reads an OpenDroneMap project folder, or joins its submodels.
///
/// # Errors
/// Names the file that cannot be used. What only adds sparse points is a warning where it is broken.
pub(crate) fn read_folder(dir: &Path) -> Result<Project, FileError> {
    if !is_odm_folder(dir) {
        let submodels = submodels::submodels_of(dir);
        if !submodels.is_empty() {
            return submodels::read(dir, &submodels);
        }
    }
    read_one(dir)
}

/// How many photos a project places, from files of `most` bytes at most; `None` for submodels, whose
/// photos overlap.
pub(crate) fn count_of_photos(dir: &Path, most: u64) -> Option<usize> {
    let shots_file = dir.join("odm_report/shots.geojson");
    if !shots_file.is_file() {
        return opensfm::count_of_photos(&dir.join("opensfm/reconstruction.json"), most);
    }
    let is_small = shots_file.metadata().ok()?.len() <= most;
    let bytes = is_small.then(|| read_bytes(&shots_file).ok()).flatten()?;
    Some(shots::read(&bytes).ok()?.len())
}

/// Reads a project that has poses itself.
fn read_one(dir: &Path) -> Result<Project, FileError> {
    let mut warnings = Vec::new();
    let shots_file = dir.join("odm_report/shots.geojson");
    let sparse_file = dir.join("opensfm/reconstruction.json");
    let shots = optional(&shots_file, shots::read)?;
    let sparse = match optional(&sparse_file, OpenSfm::read) {
        Err(error) if shots.is_some() => {
            warnings.push(format!("no sparse points: {error}"));
            None
        }
        sparse => sparse?,
    };
    let projected = sparse.as_ref().and_then(OpenSfm::said_to_be_projected);
    let by_receivers = sparse.as_ref().and_then(OpenSfm::scale_error_by_receivers);
    let sparse = sparse.map(|sparse| with_tracks(dir, sparse, &mut warnings));
    let sparse = sparse.as_ref();
    if let Some(sparse) = sparse {
        let said = sparse.warnings.iter();
        warnings.extend(said.map(|warning| format!("opensfm/reconstruction.json: {warning}")));
    }
    let mut frames = Frames::read(dir)?;
    // Only where nothing else says it.
    if shots.is_none()
        && frames.world_from_sparse().is_none()
        && let Some(said) = projected
    {
        frames.set_projected();
        warnings.push(format!("opensfm/reconstruction.json: {said}"));
    }
    let posed = match (shots, sparse) {
        (Some(shots), sparse) => from_shots(shots, sparse, &frames, &mut warnings)
            .map_err(|fault| FileError::new(&shots_file, fault))?,
        (None, Some(sparse)) => from_sparse(sparse, &frames, &mut warnings)
            .map_err(|fault| FileError::new(&sparse_file, fault))?,
        (None, None) => {
            let fault = Fault::new(
                "an OpenDroneMap project without odm_report/shots.geojson and opensfm/reconstruction.json",
                "run OpenDroneMap up to its report, or copy one of these files as well",
            );
            return Err(FileError::new(dir, fault));
        }
    };
    let (cameras, photos) = with_cameras(dir, posed.shots, sparse, &mut warnings)?;
    warnings.extend(unaligned(dir, &photos));
    let centers: Vec<DVec3> = photos.iter().map(|photo| photo.pose.center).collect();
    let in_map = posed.in_world && frames.crs.is_some();
    let stats = ["odm_report/stats.json", "opensfm/stats/stats.json"].map(|name| dir.join(name));
    let stats = stats.iter().find(|file| in_map && file.is_file());
    let world_scale = match stats {
        Some(stats) => opensfm::scale_error(stats, &centers, &mut warnings),
        // Older ones write no statistics; what these would hold stands in the reconstruction.
        None => by_receivers.filter(|_| in_map && !has_ground_control(dir)),
    };
    let pose_errors = sparse.map_or_else(Vec::new, |sparse| pose_errors(sparse, &photos));
    // In another frame it would be a wrong one, and that is said.
    let (surface, surface_note) = if posed.in_world {
        surface(dir)
    } else {
        (None, None)
    };
    Ok(Project {
        reconstruction: Reconstruction {
            package: "opendronemap",
            named_sizes: named_sizes(dir),
            crs: frames.crs.filter(|_| posed.in_world),
            cameras,
            photos,
            pose_errors,
            errors: StatedErrors {
                world_scale,
                ..StatedErrors::default()
            },
            cloud: posed.cloud,
            observations: posed.observations,
            sizes: Sizes::PerhapsReduced,
            // In OpenSfM's frame, where it was solved: the way into the world is no similarity.
            solved_reprojection_px: sparse.and_then(Reconstruction::median_reprojection_px),
            warnings,
            ..Reconstruction::default()
        },
        surface,
        surface_note,
        photos: Some(dir.join("images")).filter(|folder| folder.is_dir()),
    })
}

/// Whether ground control points went into it, so that receivers alone did not place it.
fn has_ground_control(dir: &Path) -> bool {
    let files = [
        "gcp_list.txt",
        "opensfm/gcp_list.txt",
        "opensfm/ground_control_points.json",
        "odm_georeferencing/gcp_list.txt",
    ];
    files.iter().any(|file| dir.join(file).exists())
}

/// What `reconstruction.json` says of how sure the poses are, in the frame that `photos` are in: its
/// axes turn to that as a photo's own do, and its metres are taken for those of the map.
fn pose_errors(sparse: &Reconstruction, photos: &[PosedPhoto]) -> Vec<PoseCovariance> {
    let solved = sparse.photos.iter().zip(&sparse.pose_errors);
    let solved: HashMap<&str, _> = solved.map(|pair| (pair.0.name.as_str(), pair)).collect();
    let of_photo = |photo: &PosedPhoto| {
        let (before, errors) = solved.get(photo.name.as_str())?;
        let turn = photo.pose.rotation * before.pose.rotation.transpose();
        Some(errors.moved(&turn))
    };
    let of_photos = photos.iter().map(|p| of_photo(p).unwrap_or_default());
    of_photos.collect()
}

/// Adds the observations, where there are any.
fn with_tracks(dir: &Path, mut sparse: OpenSfm, warnings: &mut Vec<String>) -> Reconstruction {
    let added = optional(&dir.join("opensfm/tracks.csv"), |bytes| {
        sparse.add_observations(text_from_bytes(bytes)?)
    });
    if let Err(error) = added {
        warnings.push(format!("no observations: {error}"));
    }
    sparse.reconstruction
}

/// The sizes of the photos as they came, where `images.json` has them (`opendm/photo.py`). Where it is
/// broken [`unaligned`] says so; nothing else depends on it.
fn named_sizes(dir: &Path) -> HashMap<String, (u32, u32)> {
    #[derive(Deserialize)]
    struct Image {
        filename: String,
        width: Option<u32>,
        height: Option<u32>,
    }
    let images = optional(&dir.join("images.json"), parse::<Vec<Image>>);
    let images = images.ok().flatten().unwrap_or_default();
    let size_of = |image: Image| Some((image.filename, (image.width?, image.height?)));
    images.into_iter().filter_map(size_of).collect()
}

/// A warning with the count of the photos that were there but are not aligned, if any.
fn unaligned(dir: &Path, photos: &[PosedPhoto]) -> Option<String> {
    #[derive(Deserialize)]
    struct Image {
        filename: String,
    }
    let list = optional(&dir.join("img_list.txt"), |bytes| {
        let names = text_from_bytes(bytes)?.lines().map(str::trim);
        Ok(names
            .filter(|name| !name.is_empty())
            .map(str::to_owned)
            .collect())
    });
    let database = || {
        optional(&dir.join("images.json"), |bytes| {
            let images: Vec<Image> = parse(bytes)?;
            Ok(images.into_iter().map(|image| image.filename).collect())
        })
    };
    let listed: HashSet<String> =
        match list.and_then(|list| list.map_or_else(database, |l| Ok(Some(l)))) {
            Ok(listed) => listed?,
            Err(error) => {
                return Some(format!(
                    "photos that were not aligned cannot be counted: {error}"
                ));
            }
        };
    let aligned: HashSet<&str> = photos.iter().map(|photo| &*photo.name).collect();
    let count = listed
        .iter()
        .filter(|name| !aligned.contains(name.as_str()))
        .count();
    (count > 0).then(|| format!("{count} of {} photos were not aligned", listed.len()))
}

#[cfg(test)]
mod tests;
