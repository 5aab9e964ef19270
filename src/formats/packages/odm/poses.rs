//! Poses, sparse points and observations of an OpenDroneMap project in one frame, from
//! `odm_report/shots.geojson`, `opensfm/reconstruction.json` or both.
//!
//! Written from ODM's `opendm/shots.py` and `stages/odm_report.py`. The poses of `shots.geojson`
//! stand, except where the project was aligned onto another data set: ODM multiplies the rotation
//! VECTORS by the alignment then, as if they were points, so that only the centres are right. The
//! poses come from `reconstruction.json` then, whose rotations are turned as matrices.

use std::collections::HashMap;

use super::georeference::{Frames, Georeference};
use super::shots::Shot;
use crate::fault::Fault;
use crate::packages::opensfm::checked;
use crate::packages::reconstruction::{Observation, Reconstruction};
use crate::surface::Cloud;

/// Photos, points and observations in one frame.
pub(super) struct Posed {
    pub(super) shots: Vec<Shot>,
    pub(super) cloud: Cloud,
    pub(super) observations: Vec<Observation>,
    /// Whether that is the frame of the surface.
    pub(super) in_world: bool,
}

/// Poses as `shots.geojson` has them, with the sparse points where their frame can be told.
pub(super) fn from_shots(
    mut shots: Vec<Shot>,
    sparse: Option<&Reconstruction>,
    frames: &Frames,
    warnings: &mut Vec<String>,
) -> Result<Posed, Fault> {
    let map = sparse.and_then(|sparse| {
        let centers: HashMap<_, _> = shots.iter().map(|s| (&*s.name, s.pose.center)).collect();
        let pairs = sparse
            .photos
            .iter()
            .filter_map(|photo| Some((photo.pose.center, *centers.get(&*photo.name)?)));
        frames.world_from_sparse_by_centers(&pairs.collect::<Vec<_>>())
    });
    if frames.is_aligned() {
        let (Some(sparse), Some(map)) = (sparse, map) else {
            return Err(Fault::new(
                "the project was aligned (odm_georeferencing/alignment_matrix.json), and ODM writes wrong rotations then",
                "copy opensfm/reconstruction.json and odm_georeferencing/coords.txt as well: their poses are right",
            ));
        };
        return moved(sparse, &map);
    }
    let mut posed = Posed {
        shots: Vec::new(),
        cloud: Cloud::default(),
        observations: Vec::new(),
        in_world: true,
    };
    if let Some(sparse) = sparse {
        let cameras: HashMap<_, _> = sparse.photos.iter().map(|p| (&*p.name, p.camera)).collect();
        for shot in &mut shots {
            let camera = cameras
                .get(&*shot.name)
                .and_then(|&camera| sparse.cameras.get(camera));
            shot.camera = shot
                .camera
                .take()
                .or(camera.map(|camera| camera.name.clone()));
        }
        if let Some(map) = map {
            posed = moved(sparse, &map)?;
            let places: HashMap<_, _> = (0_u32..).zip(&shots).map(|(i, s)| (&*s.name, i)).collect();
            posed.observations.retain_mut(|seen| {
                let name = posed.shots.get(seen.photo as usize).map(|shot| &*shot.name);
                let place = name.and_then(|name| places.get(name));
                place.map(|&place| seen.photo = place).is_some()
            });
        } else {
            warnings.push(
                "no sparse points: opensfm/reconstruction.json does not fit odm_report/shots.geojson"
                    .to_owned(),
            );
        }
    }
    posed.shots = shots;
    Ok(posed)
}

/// Poses of `reconstruction.json`, in the world where the folder says how.
pub(super) fn from_sparse(
    sparse: &Reconstruction,
    frames: &Frames,
    warnings: &mut Vec<String>,
) -> Result<Posed, Fault> {
    if let Some(map) = frames.world_from_sparse() {
        return moved(sparse, &map);
    }
    let mut posed = moved(sparse, &Georeference::IDENTITY)?;
    let mut warning =
        "the poses are in OpenSfM's own frame: nothing says how it lies in the world".to_owned();
    if frames.crs.is_some() {
        posed.in_world = false;
        warning += "; the georeferenced cloud is left out";
    }
    warnings.push(warning);
    Ok(posed)
}

/// A reconstruction in the frame that `map` leads to.
fn moved(sparse: &Reconstruction, map: &Georeference) -> Result<Posed, Fault> {
    let mut shots = Vec::with_capacity(sparse.photos.len());
    for photo in &sparse.photos {
        let pose = checked(map.apply_to_pose(&photo.pose), &photo.name)?;
        let camera = sparse.cameras.get(photo.camera);
        let camera = camera.map(|camera| camera.name.clone()).unwrap_or_default();
        shots.push(Shot::new(photo.name.clone(), camera, pose));
    }
    let mut cloud = sparse.cloud.clone();
    for point in &mut cloud.points {
        *point = map.apply(*point);
    }
    if cloud.points.iter().any(|point| !point.is_finite()) {
        return Err(Fault::new(
            "a point of opensfm/reconstruction.json lies too far out to compute with",
            "run OpenDroneMap again",
        ));
    }
    Ok(Posed {
        shots,
        cloud,
        observations: sparse.observations.clone(),
        in_world: true,
    })
}
