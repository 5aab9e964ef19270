//! What is said of how photos were taken: of their cameras, their poses.

use serde_json::{Value, json};

use crate::camera::{Camera, Pose};
use crate::formats::PosesFile;
use crate::formats::poses::trajectory::Trajectory;

/// A camera's calibration.
pub(super) fn camera_info(camera: &Camera) -> Value {
    let warnings: [&str; 0] = [];
    json!({"kind": "camera", "cameras": [camera_value(camera)], "warnings": warnings})
}

/// The poses of photos.
pub(super) fn poses_info(file: &PosesFile) -> Value {
    let photos = file
        .lines
        .iter()
        .map(|line| photo_value(&line.photo, line.camera.as_deref(), &line.pose));
    json!({
        "kind": "poses",
        "crs": file.crs,
        "photos": photos.collect::<Vec<_>>(),
        "warnings": file.warnings,
    })
}

/// A trajectory: its stamps stand for photos, and no camera is known.
pub(super) fn trajectory_info(trajectory: &Trajectory) -> Value {
    let poses = trajectory.poses.iter();
    let photos = poses.map(|p| photo_value(&p.name, None, &p.pose));
    let mut warnings = vec![trajectory.format.caveat()];
    warnings.extend(trajectory.warnings.iter().map(String::as_str));
    json!({
        "kind": "poses",
        "crs": null,
        "over_time": true,
        "photos": photos.collect::<Vec<_>>(),
        "warnings": warnings,
    })
}

/// A camera with its calibration.
pub(super) fn camera_value(camera: &Camera) -> Value {
    json!({
        "name": camera.name,
        "width": camera.width,
        "height": camera.height,
        "fx": camera.fx,
        "fy": camera.fy,
        "cx": camera.cx,
        "cy": camera.cy,
        "skew": camera.skew,
        "distortion": camera.distortion.name(),
        "coefficients": camera.distortion.coefficients(),
    })
}

/// A photo with its centre and its rotation `world_from_camera`, row-major.
pub(super) fn photo_value(name: &str, camera: Option<&str>, pose: &Pose) -> Value {
    json!({
        "photo": name,
        "camera": camera,
        "center": pose.center.to_array(),
        "rotation": pose.rotation.transpose().to_cols_array(),
    })
}
