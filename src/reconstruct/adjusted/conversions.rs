//! cumulus3d's numbers (nalgebra's) as ours (glam's), and back.

use cumulus3d_core::Vec3;
use cumulus3d_core::geometry::{Mat3, Quat, Rigid3};
use glam::{DMat3, DQuat, DVec3};

use crate::camera::Pose;

/// A point or direction of ours as cumulus3d's.
pub(crate) fn to_vector(ours: DVec3) -> Vec3 {
    Vec3::new(ours.x, ours.y, ours.z)
}

/// A rotation of ours as cumulus3d's.
pub(crate) fn to_rotation(ours: &DMat3) -> Quat {
    Quat::from_rotation_matrix(&Mat3::from_column_slice(&ours.to_cols_array()))
}

/// A point or direction of cumulus3d's as ours.
pub(crate) fn point(theirs: &Vec3) -> DVec3 {
    DVec3::new(theirs.x, theirs.y, theirs.z)
}

/// A pose of cumulus3d's, which takes points of the model to camera axes, as ours, which takes camera axes to the
/// model and has the centre.
pub(crate) fn pose(camera_from_model: &Rigid3) -> Pose {
    let turn = camera_from_model.rotation;
    let turn = DQuat::from_xyzw(turn.x, turn.y, turn.z, turn.w).normalize();
    Pose {
        rotation: DMat3::from_quat(turn.inverse()),
        center: point(&camera_from_model.center()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Camera axes that look down from (1, 2, 3) with x to the north: a point 10 below it and 4 north of it is 4 to the
    /// right and 10 ahead, for either of the two.
    #[test]
    fn a_pose_sees_the_same_in_both() {
        let rotation = DMat3::from_cols(DVec3::Y, DVec3::X, -DVec3::Z);
        let center = DVec3::new(1.0, 2.0, 3.0);
        // What a camera sees of the origin is the translation.
        let theirs = Rigid3::new(
            to_rotation(&rotation.transpose()),
            to_vector(DVec3::new(-2.0, -1.0, 3.0)),
        );
        let (at, seen) = (DVec3::new(1.0, 6.0, -7.0), DVec3::new(4.0, 0.0, 10.0));
        assert!(point(&theirs.transform_point(&to_vector(at))).distance(seen) < 1e-12);
        let ours = pose(&theirs);
        assert!(ours.camera_from_world(at).distance(seen) < 1e-12);
        assert!(ours.rotation.abs_diff_eq(rotation, 1e-12), "{ours:?}");
        assert!(ours.center.distance(center) < 1e-12, "{ours:?}");
    }
}
