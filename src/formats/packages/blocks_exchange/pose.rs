//! The pose of a photo.

use glam::{DMat3, DVec3};
use roxmltree::Node;

use crate::camera::{HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;

use super::{child, fault, number, text_of, vector};

/// The pose and whether it came from yaw, pitch and roll; `None` where a part of it is missing.
/// `axes` tells where the camera axes of the rotation lie among right, down and forward.
pub(super) fn read(pose: Node<'_, '_>, axes: DMat3) -> Result<Option<(Pose, bool)>, Fault> {
    let (Some(rotation), Some(center)) = (child(pose, "Rotation"), child(pose, "Center")) else {
        return Ok(None);
    };
    let center = vector(center)?;
    if text_of(rotation, "M_00").is_some() {
        let row = |names: [&'static str; 3]| -> Result<DVec3, Fault> {
            let [x, y, z] = names.map(|name| number(rotation, name));
            Ok(DVec3::new(x?, y?, z?))
        };
        // Its rows are the camera's axes in the world: the columns of world_from_camera.
        let world_from_axes = DMat3::from_cols(
            row(["M_00", "M_01", "M_02"])?,
            row(["M_10", "M_11", "M_12"])?,
            row(["M_20", "M_21", "M_22"])?,
        );
        let world_from_camera = world_from_axes * axes.transpose();
        let row_major = world_from_camera.transpose().to_cols_array();
        let pose = Pose::from_row_major(center, row_major)
            .map_err(|error| fault(rotation, error.to_string()))?;
        return Ok(Some((pose, false)));
    }
    if text_of(rotation, "Omega").is_some() {
        let [omega, phi, kappa] = ["Omega", "Phi", "Kappa"].map(|name| number(rotation, name));
        let mut pose = Pose::from_omega_phi_kappa(center, [omega?, phi?, kappa?]);
        // There its axes are right, up and back.
        pose.rotation = pose.rotation * HALF_TURN_ABOUT_X * axes.transpose();
        return Ok(Some((pose, false)));
    }
    // The later versions' name, and the earlier ones'.
    let yaw = ["Yaw", "Heading"]
        .into_iter()
        .find(|name| text_of(rotation, name).is_some());
    if let Some(yaw) = yaw {
        let [yaw, pitch, roll] = [yaw, "Pitch", "Roll"].map(|name| number(rotation, name));
        let pose = Pose::from_yaw_pitch_roll(center, [yaw?, pitch?, roll?]);
        return Ok(Some((pose, true)));
    }
    Ok(None)
}
