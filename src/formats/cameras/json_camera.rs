//! A camera's calibration as JSON: OpenSfM's `camera_models.json` or OpenDroneMap's `cameras.json`
//! (opensfm/camera.rs) with one camera, or Open3D's `PinholeCameraIntrinsic` (open3d/).

use crate::camera::Camera;
use crate::fault::Fault;
use crate::packages::open3d;
use crate::packages::opensfm;

/// Whether a JSON file that begins so is a calibration, where it is no reconstruction.
pub(crate) fn is_camera(start: &str) -> bool {
    let object = start.trim_start().starts_with('{');
    object && (is_of_opensfm(start) || start.contains("\"intrinsic_matrix\""))
}

fn is_of_opensfm(text: &str) -> bool {
    text.contains("\"projection_type\"")
}

/// Reads the camera.
///
/// # Errors
/// Where the file is broken or does not hold exactly one camera.
pub(crate) fn read(text: &str) -> Result<Camera, Fault> {
    if !is_of_opensfm(text) {
        return open3d::read_intrinsic(text.as_bytes());
    }
    let mut cameras = opensfm::camera::read(text.as_bytes())?.into_iter();
    match (cameras.next(), cameras.len()) {
        (Some(camera), 0) => Ok(camera),
        (_, more) => Err(Fault::new(
            format!("it holds {} cameras, where one is needed", more + 1),
            "copy the one that took the photos into a file of its own",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ODM: &str = r#"{"dji": {"projection_type": "brown", "width": 400, "height": 200,
        "focal_x": 0.5, "focal_y": 0.5, "k1": 0.1}}"#;
    const OPEN3D: &str = r#"{"class_name": "PinholeCameraIntrinsic", "width": 640, "height": 480,
        "intrinsic_matrix": [525, 0, 0, 0, 525, 0, 319.5, 239.5, 1]}"#;

    #[test]
    fn both_kinds_are_read() {
        assert!(is_camera(ODM) && is_camera(OPEN3D));
        let camera = read(ODM).unwrap();
        assert_eq!(
            (camera.fx, camera.cx, camera.name.as_str()),
            (200.0, 200.0, "dji")
        );
        let camera = read(OPEN3D).unwrap();
        assert_eq!((camera.fx, camera.cx, camera.height), (525.0, 320.0, 480));
        assert!(!is_camera("[]") && !is_camera("{\"type\": \"FeatureCollection\"}"));
    }

    #[test]
    fn one_camera_is_needed() {
        let two = ODM.replace(
            "\"dji\":",
            r#""x": {"focal": 1, "width": 4, "height": 4}, "dji":"#,
        );
        assert!(read(&two).unwrap_err().what.contains("2 cameras"));
        assert!(read("{\"projection_type\": 1}").is_err());
        for cut in 0..OPEN3D.len() {
            assert!(read(&OPEN3D[..cut]).is_err());
        }
    }
}
