//! Where a photo was taken from, and which way the camera looked.

use glam::{DMat3, DQuat, DVec3};

/// From camera axes x right, y down, z forward to x right, y up, z back, and the other way round.
///
/// Photogrammetry and computer graphics (OpenGL) have the latter. diag(1, -1, -1), its own inverse.
pub const HALF_TURN_ABOUT_X: DMat3 = DMat3::from_cols(
    DVec3::X,
    DVec3::new(0.0, -1.0, 0.0),
    DVec3::new(0.0, 0.0, -1.0),
);

/// `world_from_camera` of one photo: camera axes x right, y down, z forward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Camera axes in the world, as columns; a proper rotation.
    pub rotation: DMat3,
    /// The camera centre in the world, in the world's unit.
    pub center: DVec3,
}

/// Numbers that make no rotation.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NotRotation {
    /// A quaternion whose direction is lost in its rounding.
    #[error("the quaternion's length is {0:e}, under 1e-6")]
    ShortQuaternion(f64),
    /// A matrix that is not orthonormal; the worst deviation of its products from the identity.
    #[error("the matrix is no rotation: it deviates by {0:.3e} from an orthonormal one")]
    NotOrthonormal(f64),
    /// A matrix with determinant -1.
    #[error("the matrix mirrors: its determinant is negative")]
    Mirrored,
}

impl Pose {
    /// From the quaternion x, y, z, w of `world_from_camera`, normalised here.
    ///
    /// # Errors
    /// Where its length is under 1e-6.
    pub fn from_quaternion(center: DVec3, [x, y, z, w]: [f64; 4]) -> Result<Self, NotRotation> {
        let rotation = DMat3::from_quat(unit_quaternion([x, y, z, w])?);
        Ok(Self { rotation, center })
    }

    /// From the quaternion x, y, z, w and the translation of `camera_from_world`, which COLMAP
    /// writes.
    ///
    /// # Errors
    /// Where the quaternion's length is under 1e-6.
    pub fn from_camera_from_world(
        quaternion: [f64; 4],
        translation: DVec3,
    ) -> Result<Self, NotRotation> {
        let rotation = DMat3::from_quat(unit_quaternion(quaternion)?).transpose();
        Ok(Self {
            rotation,
            center: -(rotation * translation),
        })
    }

    /// From the rotation matrix of `world_from_camera`, row-major, which may carry a relative 1e-6
    /// of rounding; made orthonormal here.
    ///
    /// # Errors
    /// Where the matrix is no rotation.
    pub fn from_row_major(center: DVec3, m: [f64; 9]) -> Result<Self, NotRotation> {
        let given = DMat3::from_cols_array(&m).transpose();
        let product = given.transpose() * given - DMat3::IDENTITY;
        let deviation = product
            .to_cols_array()
            .into_iter()
            .fold(0.0, |worst: f64, d| worst.max(d.abs()));
        if deviation.is_nan() || deviation > 1e-6 {
            return Err(NotRotation::NotOrthonormal(deviation));
        }
        if given.determinant() < 0.0 {
            return Err(NotRotation::Mirrored);
        }
        let x = given.x_axis.normalize();
        let y = (given.y_axis - x * x.dot(given.y_axis)).normalize();
        Ok(Self {
            rotation: DMat3::from_cols(x, y, x.cross(y)),
            center,
        })
    }

    /// From an axis of length angle (radians) that turns the world into camera axes, as OpenSfM and
    /// OpenCV write rotations.
    pub fn from_rotation_vector_of_camera_from_world(center: DVec3, vector: DVec3) -> Self {
        Self {
            rotation: DMat3::from_quat(DQuat::from_scaled_axis(vector)).transpose(),
            center,
        }
    }

    /// From photogrammetric angles in degrees: Rx(omega) Ry(phi) Rz(kappa) takes photogrammetric
    /// camera axes (x right, y up, z back) to the world.
    pub fn from_omega_phi_kappa(center: DVec3, [omega, phi, kappa]: [f64; 3]) -> Self {
        let world_from_photogrammetric = DMat3::from_rotation_x(omega.to_radians())
            * DMat3::from_rotation_y(phi.to_radians())
            * DMat3::from_rotation_z(kappa.to_radians());
        Self {
            rotation: world_from_photogrammetric * HALF_TURN_ABOUT_X,
            center,
        }
    }

    /// From aerospace angles in degrees, north-east-down in z-y-x order, as DJI's gimbal writes
    /// them: pitch -90 looks straight down, yaw 0 puts the image's top to world +y, 90 to +x.
    pub fn from_yaw_pitch_roll(center: DVec3, [yaw, pitch, roll]: [f64; 3]) -> Self {
        // Columns: where north, east and down of the first frame lie in the world (x east, y north,
        // z up), and where right, down and forward of the camera lie in the body (forward, right,
        // down).
        let world_from_ned = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z);
        let body_from_camera = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
        let ned_from_body = DMat3::from_rotation_z(yaw.to_radians())
            * DMat3::from_rotation_y(pitch.to_radians())
            * DMat3::from_rotation_x(roll.to_radians());
        Self {
            rotation: world_from_ned * ned_from_body * body_from_camera,
            center,
        }
    }

    /// From the two angles of the paper's UAV in degrees: `tilt` below the horizon (90 = straight
    /// down), `pan` clockwise from world +y; the horizon stays level in the image.
    pub fn from_tilt_pan(center: DVec3, [tilt, pan]: [f64; 2]) -> Self {
        Self::from_yaw_pitch_roll(center, [pan, -tilt, 0.0])
    }

    /// What sits at `inner` on something that is at this pose: `world_from_body` after
    /// `body_from_camera`.
    #[must_use]
    pub fn carrying(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            center: self.rotation * inner.center + self.center,
        }
    }

    /// A world point in camera axes.
    pub fn camera_from_world(&self, point: DVec3) -> DVec3 {
        self.rotation.transpose() * (point - self.center)
    }
}

fn unit_quaternion(xyzw: [f64; 4]) -> Result<DQuat, NotRotation> {
    // Scaled first: the squares of large numbers overflow.
    let largest = xyzw
        .iter()
        .fold(0.0, |largest: f64, q| largest.max(q.abs()));
    if largest == 0.0 {
        return Err(NotRotation::ShortQuaternion(0.0));
    }
    let scaled = DQuat::from_array(xyzw.map(|q| q / largest));
    let length = largest * scaled.length();
    if !scaled.is_finite() || length < 1e-6 {
        return Err(NotRotation::ShortQuaternion(length));
    }
    Ok(scaled.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns right, down, forward of a camera that looks straight down with its top to north.
    const NADIR: DMat3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);

    fn assert_close(pose: Pose, expected: DMat3) {
        assert!(
            pose.rotation.abs_diff_eq(expected, 1e-15),
            "{} is not {expected}",
            pose.rotation
        );
    }

    #[test]
    fn straight_down_in_every_notation() {
        let c = DVec3::new(1.0, 2.0, 3.0);
        assert_close(Pose::from_omega_phi_kappa(c, [0.0; 3]), NADIR);
        assert_close(Pose::from_yaw_pitch_roll(c, [0.0, -90.0, 0.0]), NADIR);
        assert_close(Pose::from_tilt_pan(c, [90.0, 0.0]), NADIR);
        // Half a turn about x.
        assert_close(
            Pose::from_quaternion(c, [2.0, 0.0, 0.0, 0.0]).unwrap(),
            NADIR,
        );
        let turned = Pose::from_camera_from_world([1.0, 0.0, 0.0, 0.0], -(NADIR * c)).unwrap();
        assert_close(turned, NADIR);
        assert!((turned.center - c).length() < 1e-15);
        let m = [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0];
        assert_close(Pose::from_row_major(c, m).unwrap(), NADIR);
        let half_turn = DVec3::new(std::f64::consts::PI, 0.0, 0.0);
        assert_close(
            Pose::from_rotation_vector_of_camera_from_world(c, half_turn),
            NADIR,
        );
    }

    #[test]
    fn yaw_90_puts_the_top_to_the_east() {
        let pose = Pose::from_yaw_pitch_roll(DVec3::ZERO, [90.0, -90.0, 0.0]);
        assert_close(
            pose,
            DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_X, DVec3::NEG_Z),
        );
    }

    #[test]
    fn roll_180_at_nadir_still_looks_down() {
        let pose = Pose::from_yaw_pitch_roll(DVec3::ZERO, [0.0, -90.0, 180.0]);
        assert!((pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
    }

    #[test]
    fn tilt_and_pan_point_where_they_say() {
        // 30 degrees below the horizon, looking east.
        let pose = Pose::from_tilt_pan(DVec3::ZERO, [30.0, 90.0]);
        let forward = DVec3::new(3.0_f64.sqrt() / 2.0, 0.0, -0.5);
        assert!((pose.rotation.z_axis - forward).length() < 1e-15);
        assert!((pose.rotation.x_axis - DVec3::NEG_Y).length() < 1e-15);
    }

    #[test]
    fn omega_tips_the_view_to_the_north() {
        // A right-handed turn about east takes the downward view from nadir towards north.
        let pose = Pose::from_omega_phi_kappa(DVec3::ZERO, [30.0, 0.0, 0.0]);
        let forward = DVec3::new(0.0, 0.5, -(3.0_f64.sqrt()) / 2.0);
        assert!((pose.rotation.z_axis - forward).length() < 1e-15);
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        assert_eq!(
            Pose::from_quaternion(DVec3::ZERO, [0.0; 4]),
            Err(NotRotation::ShortQuaternion(0.0))
        );
        assert!(Pose::from_quaternion(DVec3::ZERO, [f64::NAN, 0.0, 0.0, 1.0]).is_err());
        let mirror = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, -1.0];
        assert_eq!(
            Pose::from_row_major(DVec3::ZERO, mirror),
            Err(NotRotation::Mirrored)
        );
        let skewed = [1.0, 0.1, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        assert!(Pose::from_row_major(DVec3::ZERO, skewed).is_err());
    }
}
