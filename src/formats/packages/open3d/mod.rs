//! Open3D's camera trajectories as JSON: `PinholeCameraTrajectory`, or one `PinholeCameraParameters`.
//!
//! Written from Open3D's documentation (`open3d.camera`, "File IO") and source
//! (`cpp/open3d/camera/PinholeCameraParameters.cpp`, `utility/IJsonConvertible.cpp`,
//! `geometry/PointCloudFactory.cpp`).
//!
//! ```text
//! {class_name "PinholeCameraTrajectory", parameters [PARAMETERS, ...]}
//! PARAMETERS {class_name "PinholeCameraParameters",
//!             intrinsic {width, height, intrinsic_matrix [9]},
//!             extrinsic [16]}
//! ```
//!
//! - Both matrices are COLUMN-major. extrinsic is `camera_from_world`, with camera axes x right, y down,
//!   z forward. There is no distortion.
//! - Whole pixel coordinates are pixel centres in Open3D, so cx and cy get 0.5 here (the customary
//!   319.5 of 640 is the middle).
//! - Nothing names the photos: they are called by their number from 0.
//!
//! A `.log` holds poses alone (log.rs).

mod log;

use glam::{DMat3, DMat4};
use serde::Deserialize;

use crate::camera::{Camera, Distortion};
use crate::fault::Fault;
use crate::packages::reconstruction::{PosedPhoto, Reconstruction, Sizes};
use crate::poses::rounded_rotation::pose_from_camera_from_world;
use crate::text::json::parse;

pub(crate) use log::{is_log, read_log};

/// What stands in for the photos' names.
pub(crate) const NUMBERED: &str =
    "it names no photos: they are numbered from 0, in the order of the file";

#[derive(Deserialize)]
struct RawFile {
    parameters: Option<Vec<RawParameters>>,
    intrinsic: Option<RawIntrinsic>,
    extrinsic: Option<Vec<f64>>,
}

#[derive(Deserialize)]
struct RawParameters {
    intrinsic: RawIntrinsic,
    extrinsic: Vec<f64>,
}

#[derive(Deserialize)]
struct RawIntrinsic {
    width: u32,
    height: u32,
    intrinsic_matrix: Vec<f64>,
}

/// Reads a trajectory, or the parameters of one photo.
///
/// # Errors
/// Where it is no JSON of that shape (with the line), or a matrix is none of a camera or a pose.
pub(crate) fn read(json: &[u8]) -> Result<Reconstruction, Fault> {
    let raw: RawFile = parse(json)?;
    let parameters = match (raw.parameters, raw.intrinsic, raw.extrinsic) {
        (Some(parameters), _, _) => parameters,
        (None, Some(intrinsic), Some(extrinsic)) => vec![RawParameters {
            intrinsic,
            extrinsic,
        }],
        _ => Vec::new(),
    };
    if parameters.is_empty() {
        return Err(broken("it holds no camera parameters".to_owned()));
    }
    let mut found = Reconstruction {
        package: "open3d",
        sizes: Sizes::Known,
        warnings: vec![NUMBERED.to_owned()],
        ..Reconstruction::default()
    };
    for (index, parameters) in parameters.into_iter().enumerate() {
        let camera = parameters.intrinsic.camera(index)?;
        let same = |known: &Camera| {
            Camera {
                name: known.name.clone(),
                ..camera.clone()
            } == *known
        };
        let camera = match found.cameras.iter().position(same) {
            Some(known) => known,
            None => {
                let name = (found.cameras.len() + 1).to_string();
                found.cameras.push(Camera { name, ..camera });
                found.cameras.len() - 1
            }
        };
        let extrinsic = <[f64; 16]>::try_from(parameters.extrinsic)
            .map_err(|_| broken(format!("the extrinsic {index} (from 0) is not 16 numbers")))?;
        let matrix = DMat4::from_cols_array(&extrinsic);
        if (matrix.row(3) - glam::DVec4::W).abs().max_element() > 1e-6 {
            let what = "its last row is not 0 0 0 1; the matrix is column-major";
            return Err(broken(format!("the extrinsic {index} (from 0): {what}")));
        }
        let rotation = DMat3::from_mat4(matrix);
        let pose = pose_from_camera_from_world(rotation, matrix.w_axis.truncate())
            .map_err(|e| broken(format!("the extrinsic {index} (from 0): {e}")))?;
        found.photos.push(PosedPhoto {
            name: index.to_string(),
            camera,
            pose,
        });
    }
    Ok(found)
}

/// Reads one `PinholeCameraIntrinsic`.
///
/// # Errors
/// Where it is no JSON of that shape, or the matrix is none of a camera.
pub(crate) fn read_intrinsic(json: &[u8]) -> Result<Camera, Fault> {
    parse::<RawIntrinsic>(json)?.camera(0)
}

fn broken(what: String) -> Fault {
    Fault::new(what, "write it again with Open3D")
}

impl RawIntrinsic {
    /// The camera, without a name; `index` is for faults.
    fn camera(&self, index: usize) -> Result<Camera, Fault> {
        let fault = |what: &str| broken(format!("the intrinsic {index} (from 0): {what}"));
        let matrix = <[f64; 9]>::try_from(self.intrinsic_matrix.as_slice())
            .map_err(|_| fault("its intrinsic_matrix is not 9 numbers"))?;
        let [fx, below, a, skew, fy, b, cx, cy, one] = matrix;
        if [below, a, b] != [0.0; 3] || one != 1.0 {
            return Err(fault(
                "its intrinsic_matrix is not [fx 0 0, skew fy 0, cx cy 1]",
            ));
        }
        let camera = Camera {
            name: String::new(),
            width: self.width,
            height: self.height,
            fx,
            fy,
            cx: cx + 0.5,
            cy: cy + 0.5,
            skew,
            distortion: Distortion::None,
        };
        camera.validate().map_err(|e| fault(&e.to_string()))?;
        Ok(camera)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use fragscale_test_data::shared_data;

    /// One pose that looks along world x with the image's right to world -y, from (5, 6, 7).
    const ONE: &str = r#"{"class_name": "PinholeCameraParameters",
        "extrinsic": [0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 6, 7, -5, 1],
        "intrinsic": {"width": 640, "height": 480,
            "intrinsic_matrix": [525, 0, 0, 0, 526, 0, 319.5, 239.5, 1]}}"#;

    #[test]
    fn matrices_are_column_major() {
        let found = read(ONE.as_bytes()).unwrap();
        let camera = &found.cameras[0];
        assert_eq!(
            (camera.fx, camera.fy, camera.cx, camera.cy),
            (525.0, 526.0, 320.0, 240.0)
        );
        let pose = found.photos[0].pose;
        assert_eq!(
            pose.rotation,
            DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X)
        );
        assert_eq!(pose.center, DVec3::new(5.0, 6.0, 7.0));
        assert_eq!(
            (found.photos[0].name.as_str(), found.warnings.len()),
            ("0", 1)
        );
        let two = format!(
            "{{\"class_name\": \"PinholeCameraTrajectory\", \"parameters\": [{ONE}, {ONE}]}}"
        );
        let two = read(two.as_bytes()).unwrap();
        assert_eq!((two.photos.len(), two.cameras.len()), (2, 1));
        assert_eq!(two.photos[1].pose, pose);
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (from, to, named) in [
            ("6, 7, -5, 1]", "6, 7, -5]", "not 16 numbers"),
            ("0, 0, 1, 0,", "0, 0, 1, 6,", "column-major"),
            ("0, 0, 1, 0,", "0, 0, -1, 0,", "mirrors"),
            ("525, 0, 0, 0,", "525, 0, 319.5, 0,", "intrinsic_matrix"),
            ("525, 0", "0, 0", "fx"),
            ("640", "-640", "invalid value"),
            ("640", "0", "image size"),
            ("525", "NaN", "expected value"),
            ("319.5", "1e999", "number out of range"),
            (
                "\"extrinsic\"",
                "\"parameters\": [], \"x\"",
                "no camera parameters",
            ),
            ("\"extrinsic\"", "\"x\"", "no camera parameters"),
        ] {
            assert!(ONE.contains(from), "{from}");
            let fault = read(ONE.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert!(fault.what.contains(named), "{to}: {fault}");
        }
        for cut in 0..ONE.len() {
            assert!(read(&ONE.as_bytes()[..cut]).is_err());
        }
    }

    /// The README's measure: the .log's poses are the inverse of the .json's extrinsics to 2e-16.
    #[test]
    fn the_example_agrees_with_its_log() {
        let Some(folder) = shared_data("open3d-trajectory") else {
            return;
        };
        let found = read(&std::fs::read(folder.join("open3d_example.json")).unwrap()).unwrap();
        let log = std::fs::read_to_string(folder.join("open3d_example.log")).unwrap();
        assert!(is_log(&log));
        let log = read_log(&log).unwrap();
        assert_eq!((found.photos.len(), log.lines.len()), (33, 33));
        assert_eq!((found.cameras.len(), found.cameras[0].fx), (1, 525.0));
        for (photo, line) in found.photos.iter().zip(&log.lines) {
            assert_eq!(photo.name, line.photo);
            assert!(photo.pose.center.distance(line.pose.center) < 1e-14);
            // Which rotation is nearest to six digits and to their inverse is not quite the same.
            assert!(photo.pose.rotation.abs_diff_eq(line.pose.rotation, 2e-6));
        }
    }
}
