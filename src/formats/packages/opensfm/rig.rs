//! Poses of shots that are only part of a rig, in OpenSfM's `reconstruction.json`.
//!
//! Written from `opensfm/io.py` (`rig_instance_from_json`) and `opensfm/src/map/src/shot.cc`: a shot's
//! pose is its rig camera's after its instance's,
//!
//! ```text
//! x_rig = R_instance x_world + t_instance        x_camera = R_rig_camera x_rig + t_rig_camera
//! ```

use std::collections::HashMap;

use serde::Deserialize;

use super::pose_from;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::json::Object;

/// Where a camera sits on a rig.
#[derive(Deserialize)]
pub(super) struct RawRigCamera {
    #[serde(default)]
    rotation: [f64; 3],
    #[serde(default)]
    translation: [f64; 3],
}

/// Where a rig was, once.
#[derive(Deserialize)]
pub(super) struct RawRigInstance {
    #[serde(default)]
    rotation: [f64; 3],
    #[serde(default)]
    translation: [f64; 3],
    #[serde(default)]
    rig_camera_ids: Object<String>,
}

/// The rigs' poses, by what shots call them.
pub(super) struct Rigs {
    rig_from_camera: HashMap<String, Pose>,
    /// The pose of a shot's instance and the name of its rig camera.
    of_shot: HashMap<String, (Pose, String)>,
}

impl Rigs {
    pub(super) fn new(cameras: Object<RawRigCamera>, instances: Object<RawRigInstance>) -> Self {
        let cameras = cameras.0.into_iter();
        let mut of_shot = HashMap::new();
        for (_, instance) in instances.0 {
            let pose = pose_from(instance.rotation, instance.translation);
            for (shot, camera) in instance.rig_camera_ids.0 {
                of_shot.insert(shot, (pose, camera));
            }
        }
        Self {
            rig_from_camera: cameras
                .map(|(name, camera)| (name, pose_from(camera.rotation, camera.translation)))
                .collect(),
            of_shot,
        }
    }

    /// The pose of a shot that states none itself.
    pub(super) fn pose_of(&self, shot: &str) -> Result<Pose, Fault> {
        let found = self
            .of_shot
            .get(shot)
            .and_then(|(rig, camera)| Some((rig, self.rig_from_camera.get(camera)?)));
        let Some((rig, camera)) = found else {
            return Err(Fault::new(
                format!("shot \"{shot}\" has no rotation, and no rig states its pose"),
                "export it again, or leave the shot out",
            ));
        };
        Ok(rig.carrying(camera))
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use crate::packages::opensfm;

    const HALF: f64 = std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_shot_of_a_rig_follows_its_instance() {
        // The rig's axes are the world's turned a quarter about z, its origin is at (10, 0, 5);
        // the camera sits 2 along the rig's x and looks as the rig does.
        let json = format!(
            r#"[{{"cameras": {{"c": {{"focal": 1, "width": 4, "height": 4}}}},
                "shots": {{"a.jpg": {{"camera": "c"}}}},
                "rig_cameras": {{"left": {{"rotation": [0, 0, 0], "translation": [-2, 0, 0]}}}},
                "rig_instances": {{"7": {{"rotation": [0, 0, {}], "translation": [0, 10, -5],
                    "rig_camera_ids": {{"a.jpg": "left"}}}}}}}}]"#,
            -HALF
        );
        let pose = opensfm::read(json.as_bytes()).unwrap().photos[0].pose;
        // The rig's x points to world y, so the camera is at (10, 2, 5).
        assert!((pose.center - DVec3::new(10.0, 2.0, 5.0)).length() < 1e-12);
        let turned = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        assert!(pose.rotation.abs_diff_eq(turned, 1e-15));
        let other = json.replace("\"a.jpg\": \"left\"", "\"a.jpg\": \"right\"");
        let fault = opensfm::read(other.as_bytes()).unwrap_err();
        assert!(fault.what.contains("no rig states its pose"), "{fault}");
    }
}
