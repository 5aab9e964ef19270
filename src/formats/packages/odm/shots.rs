//! OpenDroneMap's `odm_report/shots.geojson`: the aligned photos with their poses.
//!
//! Written from ODM's `opendm/shots.py` (`get_geojson_shots_from_opensfm`) and checked against a real
//! project. A GeoJSON FeatureCollection; of each feature only its properties are read:
//!
//! ```text
//! filename      the photo
//! camera        since June 2024: the camera, named as in opensfm/reconstruction.json
//! focal         its focal length / max(width, height)
//! width height  the image size of the solution, 0 where unknown
//! translation   [3] the camera CENTRE in the georeferenced frame (metres), not the t of R x + t
//! rotation      [3] axis of length angle (radians) of camera_from_world, that frame's axes
//! ```
//!
//! The geometry is the centre in degrees, for maps. Of a project without georeference, translation
//! and rotation are in OpenSfM's frame. Projects that were joined from submodels may name a photo
//! twice; ODM's rule is that the first one stands.

use std::collections::HashSet;

use glam::DVec3;
use serde::Deserialize;

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::text::json::parse;

/// An aligned photo whose camera is known by name at most.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shot {
    pub(super) name: String,
    /// The camera's name, with or without "v2 " in front.
    pub(super) camera: Option<String>,
    pub(super) pose: Pose,
    /// Focal length / max(width, height), width, height, where they are written.
    lens: Option<[f64; 3]>,
}

impl Shot {
    /// A photo whose pose comes from elsewhere.
    pub(super) fn new(name: String, camera: String, pose: Pose) -> Self {
        Self {
            name,
            camera: Some(camera),
            pose,
            lens: None,
        }
    }

    /// Whether the lens that was written beside the pose, if any, is that of `camera`.
    pub(super) fn agrees_with(&self, camera: &Camera) -> bool {
        let Some([focal, width, height]) = self.lens else {
            return true;
        };
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let same_size = width == 0.0 || height == 0.0 || (width, height) == (w, h);
        same_size && (focal - camera.fx / w.max(h)).abs() <= 1e-9
    }
}

/// Reads `shots.geojson`.
///
/// # Errors
/// Where it is no JSON of that shape (with the line), names no photo, or a pose is not usable.
pub(super) fn read(json: &[u8]) -> Result<Vec<Shot>, Fault> {
    let collection: Collection = parse(json)?;
    if collection.features.is_empty() {
        return Err(Fault::new(
            "it holds no shots",
            "check that the alignment succeeded",
        ));
    }
    let mut names = HashSet::new();
    let mut shots = Vec::with_capacity(collection.features.len());
    for Feature { properties } in collection.features {
        if !names.insert(properties.filename.clone()) {
            continue;
        }
        let pose = Pose::from_rotation_vector_of_camera_from_world(
            DVec3::from(properties.translation),
            DVec3::from(properties.rotation),
        );
        if !pose.rotation.is_finite() {
            return Err(Fault::new(
                format!(
                    "the rotation of \"{}\" is too large to compute with",
                    properties.filename
                ),
                "run the report stage of OpenDroneMap again",
            ));
        }
        let lens = match (properties.focal, properties.width, properties.height) {
            (Some(focal), Some(width), Some(height)) => Some([focal, width, height]),
            _ => None,
        };
        shots.push(Shot {
            name: properties.filename,
            camera: properties.camera,
            pose,
            lens,
        });
    }
    Ok(shots)
}

#[derive(Deserialize)]
struct Collection {
    features: Vec<Feature>,
}

#[derive(Deserialize)]
struct Feature {
    properties: Properties,
}

#[derive(Deserialize)]
struct Properties {
    filename: String,
    camera: Option<String>,
    focal: Option<f64>,
    width: Option<f64>,
    height: Option<f64>,
    translation: [f64; 3],
    rotation: [f64; 3],
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SMALL: &str = r#"{"type": "FeatureCollection", "features": [
        {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 2, 3]}, "properties":
            {"filename": "b.jpg", "focal": 0.5, "width": 400, "height": 200,
             "translation": [500000.5, 5000000.25, 40], "rotation": [3.141592653589793, 0, 0]}},
        {"properties": {"filename": "a.jpg", "camera": "v2 c", "translation": [0, 0, 1],
             "rotation": [0, 0, 1.5707963267948966]}},
        {"properties": {"filename": "b.jpg", "translation": [9, 9, 9], "rotation": [0, 0, 0]}}
    ]}"#;

    #[test]
    fn centres_rotations_and_order() {
        let shots = read(SMALL.as_bytes()).unwrap();
        let [b, a] = &shots[..] else {
            panic!("two shots")
        };
        assert_eq!((b.name.as_str(), b.camera.as_deref()), ("b.jpg", None));
        assert_eq!(b.pose.center, DVec3::new(500_000.5, 5_000_000.25, 40.0));
        assert!((b.pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
        // camera_from_world turns the world's x to the camera's y: the camera's x is the world's -y.
        assert_eq!(
            (a.name.as_str(), a.camera.as_deref()),
            ("a.jpg", Some("v2 c"))
        );
        assert!((a.pose.rotation.x_axis - DVec3::NEG_Y).length() < 1e-15);
    }

    #[test]
    fn what_is_wrong_is_placed() {
        let with = |from: &str, to: &str| {
            assert!(SMALL.contains(from), "{from}");
            read(SMALL.replacen(from, to, 1).as_bytes())
        };
        for (from, to, named) in [
            ("\"filename\": \"a.jpg\", ", "", "missing field `filename`"),
            ("[0, 0, 1],", "[0, 0],", "invalid length 2"),
            ("[0, 0, 1],", "[0, 0, NaN],", "expected value"),
            (
                "[0, 0, 1.5707963267948966]",
                "[0, 1e308, 1.5e308]",
                "\"a.jpg\"",
            ),
            ("\"features\"", "\"feature\"", "missing field `features`"),
        ] {
            let fault = with(from, to).unwrap_err();
            assert!(fault.what.contains(named), "{to}: {fault}");
        }
        assert_eq!(with("[0, 0, 1],", "0,").unwrap_err().line, Some(5));
        assert!(read(b"{\"features\": []}").is_err());
    }

    #[test]
    fn truncated_anywhere_it_is_an_error() {
        for cut in 0..SMALL.len() {
            assert!(read(&SMALL.as_bytes()[..cut]).is_err(), "cut at {cut}");
        }
    }

    proptest! {
        #[test]
        fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..2000, any::<u8>()), 1..6)) {
            let mut json = SMALL.as_bytes().to_vec();
            for (at, byte) in edits {
                let place = at % json.len();
                json[place] = byte;
            }
            let _ = read(&json);
        }
    }
}
