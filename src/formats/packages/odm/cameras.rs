//! Which camera took which photo of an OpenDroneMap project.
//!
//! Written from ODM's `opendm/camera.py` and `stages/run_opensfm.py`. `cameras.json` holds the models
//! of `opensfm/reconstruction.json` (opensfm/camera.rs) without "v2 " in front of their names. ODM
//! never overwrites a `cameras.json` that it finds, so it may be an older one: where the numbers
//! differ, those beside the poses stand. Joined submodels may each have solved a camera of the same
//! name; `shots.geojson` tells then that the focal length was another one.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use super::georeference::optional;
use super::shots::Shot;
use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::FileError;
use crate::packages::opensfm::camera::{CameraModel, usable_cameras};
use crate::packages::reconstruction::{PosedPhoto, Reconstruction};
use crate::text::json::{Object, parse};

/// A camera's name as `cameras.json` writes it.
fn plain(name: &str) -> &str {
    name.strip_prefix("v2 ").unwrap_or(name)
}

/// The cameras, and each shot with the one that it names, or the only one there is.
///
/// # Errors
/// Where a shot's camera is not there or cannot be told.
pub(super) fn with_cameras(
    dir: &Path,
    shots: Vec<Shot>,
    sparse: Option<&Reconstruction>,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Camera>, Vec<PosedPhoto>), FileError> {
    let file = dir.join("cameras.json");
    let models = optional(&file, parse::<Object<CameraModel>>)?;
    let count = models.as_ref().map_or(0, |models| models.0.len());
    let mut cameras = match (models, sparse) {
        (Some(models), _) => {
            let used: HashSet<_> = shots
                .iter()
                .filter_map(|s| s.camera.as_deref())
                .map(plain)
                .collect();
            usable_cameras(
                &models,
                |id| count == 1 || used.contains(plain(id)),
                warnings,
            )
            .map_err(|fault| FileError::new(&file, fault))?
        }
        (None, Some(sparse)) => sparse.cameras.clone(),
        (None, None) => {
            let what = "there is no such file, and it has the project's lenses";
            let remedy = "copy cameras.json of the same project as well";
            return Err(FileError::new(&file, Fault::new(what, remedy)));
        }
    };
    if cameras.is_empty() {
        return Err(no_cameras(&file));
    }
    for camera in &mut cameras {
        let beside_poses = sparse.into_iter().flat_map(|sparse| &sparse.cameras);
        let same = beside_poses
            .into_iter()
            .find(|other| plain(&other.name) == plain(&camera.name));
        let same = same.map(|other| Camera {
            name: camera.name.clone(),
            ..other.clone()
        });
        if let Some(same) = same.filter(|same| same != camera) {
            warnings.push(format!(
                "cameras.json and opensfm/reconstruction.json differ about camera \"{}\": the latter is taken",
                camera.name
            ));
            *camera = same;
        }
    }
    let places: HashMap<_, _> = (0..)
        .zip(&cameras)
        .map(|(i, c)| (plain(&c.name), i))
        .collect();
    let mut others = 0;
    let mut photos = Vec::with_capacity(shots.len());
    for shot in shots {
        let index = match &shot.camera {
            Some(name) => places.get(plain(name)).copied(),
            None => (cameras.len() == 1 && count <= 1).then_some(0),
        };
        let Some((index, camera)) = index.and_then(|index| Some((index, cameras.get(index)?)))
        else {
            let fault = match &shot.camera {
                Some(name) => Fault::new(
                    format!(
                        "the camera \"{name}\" of photo \"{}\" is not there",
                        shot.name
                    ),
                    "export the project again",
                ),
                None => Fault::new(
                    format!(
                        "nothing says which of several cameras took \"{}\"",
                        shot.name
                    ),
                    "copy opensfm/reconstruction.json as well",
                ),
            };
            return Err(FileError::new(&file, fault));
        };
        others += usize::from(!shot.agrees_with(camera));
        photos.push(PosedPhoto {
            name: shot.name,
            camera: index,
            pose: shot.pose,
        });
    }
    if others > 0 {
        warnings.push(format!(
            "{others} photos were solved with another focal length or size than their camera has \
             (joined from submodels?): their scales are off by as much"
        ));
    }
    Ok((cameras, photos))
}

fn no_cameras(file: &Path) -> FileError {
    let fault = Fault::new(
        "it holds no camera",
        "run OpenDroneMap again, or copy cameras.json as well",
    );
    FileError::new(file, fault)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tempfile::TempDir;

    use super::*;
    use crate::packages::odm::shots;
    use crate::packages::opensfm;

    const TWO: &str = r#"{"c": {"focal": 0.5, "width": 400, "height": 200},
                          "d": {"focal": 0.75, "width": 400, "height": 200}}"#;

    type Assigned = (Vec<Camera>, Vec<PosedPhoto>, Vec<String>);

    fn assigned(
        cameras: &str,
        properties: &str,
        sparse: Option<&Reconstruction>,
    ) -> Result<Assigned, FileError> {
        let dir = TempDir::new().unwrap();
        fs::write(dir.path().join("cameras.json"), cameras).unwrap();
        let json = format!(
            r#"{{"features": [{{"properties": {{"filename": "a.jpg", {properties}
               "translation": [0, 0, 0], "rotation": [0, 0, 0]}}}}]}}"#
        );
        let shots = shots::read(json.as_bytes()).unwrap();
        let mut warnings = Vec::new();
        let (cameras, photos) = with_cameras(dir.path(), shots, sparse, &mut warnings)?;
        Ok((cameras, photos, warnings))
    }

    #[test]
    fn a_named_camera_is_found_with_and_without_its_prefix() {
        for name in ["d", "v2 d"] {
            let (cameras, photos, warnings) =
                assigned(TWO, &format!("\"camera\": \"{name}\","), None).unwrap();
            assert_eq!(cameras[photos[0].camera].name, "d");
            assert!(warnings.is_empty());
        }
        let error = assigned(TWO, "\"camera\": \"e\",", None)
            .unwrap_err()
            .to_string();
        assert!(error.contains("camera \"e\" of photo \"a.jpg\""), "{error}");
    }

    #[test]
    fn one_of_several_is_not_guessed() {
        let error = assigned(TWO, "", None).unwrap_err().to_string();
        assert!(error.contains("several cameras took \"a.jpg\""), "{error}");
        // Nor where only one of them can be used.
        let one_dual = TWO.replace("\"focal\": 0.75", "\"projection_type\": \"dual\"");
        assert!(assigned(&one_dual, "", None).is_err());
        assert!(assigned(&one_dual, "\"camera\": \"c\",", None).is_ok());
        assert!(assigned(&one_dual, "\"camera\": \"d\",", None).is_err());
    }

    #[test]
    fn the_numbers_beside_the_poses_stand() {
        let json = br#"[{"cameras": {"v2 c": {"focal": 0.6, "width": 400, "height": 200}},
            "shots": {"a.jpg": {"camera": "v2 c", "rotation": [0, 0, 0], "translation": [0, 0, 0]}}}]"#;
        let sparse = opensfm::read(json).unwrap();
        let (cameras, photos, warnings) =
            assigned(TWO, "\"camera\": \"v2 c\",", Some(&sparse)).unwrap();
        assert_eq!((photos[0].camera, &*cameras[0].name), (0, "c"));
        assert!((cameras[0].fx - 240.0).abs() < 1e-12);
        assert!(
            warnings[0].contains("differ about camera \"c\""),
            "{warnings:?}"
        );
    }

    #[test]
    fn another_focal_length_is_warned_of() {
        let lens = "\"camera\": \"c\", \"width\": 400, \"height\": 200, \"focal\":";
        assert!(
            assigned(TWO, &format!("{lens} 0.5,"), None)
                .unwrap()
                .2
                .is_empty()
        );
        let (_, _, warnings) = assigned(TWO, &format!("{lens} 0.51,"), None).unwrap();
        assert!(
            warnings[0].starts_with("1 photos were solved with another"),
            "{warnings:?}"
        );
    }
}
