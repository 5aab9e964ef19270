//! Rotation matrices as text formats carry them: rounded to few digits.

use glam::{DMat3, DVec3};

use crate::camera::{NotRotation, Pose};

/// How far the products of a matrix's columns may lie from the identity's. Six digits give 1e-5,
/// four 1e-3; what is farther off is no rounding.
const MOST_ROUNDING: f64 = 2e-3;

/// The orthogonal factor of a matrix near to a rotation, by Newton's iteration for the polar
/// decomposition, which converges quadratically; eight steps are more than enough from 1 % off.
pub(crate) fn nearest_rotation(matrix: DMat3) -> DMat3 {
    (0..8).fold(matrix, |m, _| (m + m.inverse().transpose()) * 0.5)
}

/// The rotation nearest to a matrix that is one but for rounding.
///
/// # Errors
/// Where the matrix is no rotation.
pub(crate) fn rounded_rotation(matrix: DMat3) -> Result<DMat3, NotRotation> {
    let product = matrix.transpose() * matrix - DMat3::IDENTITY;
    let off = product.to_cols_array().map(f64::abs);
    let deviation = off.into_iter().fold(0.0, f64::max);
    // The maximum passes over NaN.
    if !product.is_finite() || deviation > MOST_ROUNDING {
        return Err(NotRotation::NotOrthonormal(deviation));
    }
    if matrix.determinant() < 0.0 {
        return Err(NotRotation::Mirrored);
    }
    Ok(nearest_rotation(matrix))
}

/// The pose of x_camera = R x_world + t, where R is rounded.
///
/// # Errors
/// Where R is no rotation.
pub(crate) fn pose_from_camera_from_world(
    rotation: DMat3,
    translation: DVec3,
) -> Result<Pose, NotRotation> {
    Ok(Pose {
        rotation: rounded_rotation(rotation)?.transpose(),
        // Where x_camera is 0: exact for R as it is written.
        center: -(rotation.inverse() * translation),
    })
}

/// The matrix of nine row-major numbers.
pub(crate) fn from_row_major(m: [f64; 9]) -> DMat3 {
    DMat3::from_cols_array(&m).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_are_enough() {
        let exact = DMat3::from_rotation_z(0.3) * DMat3::from_rotation_x(2.0);
        let rounded = exact.to_cols_array().map(|d| (d * 1e4).round() / 1e4);
        let found = rounded_rotation(DMat3::from_cols_array(&rounded)).unwrap();
        assert!(found.abs_diff_eq(exact, 1e-4));
        assert!((found.transpose() * found).abs_diff_eq(DMat3::IDENTITY, 1e-15));
        assert!((found.determinant() - 1.0).abs() < 1e-15);
        let pose = pose_from_camera_from_world(exact, -(exact * DVec3::new(1.0, 2.0, 3.0)));
        assert!((pose.unwrap().center - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-14);
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        assert_eq!(rounded_rotation(mirror), Err(NotRotation::Mirrored));
        for bad in [
            DMat3::ZERO,
            DMat3::IDENTITY * 1.01,
            DMat3::IDENTITY * f64::NAN,
            DMat3::IDENTITY * 1e200,
            DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(0.0, f64::NAN, 1.0)),
        ] {
            assert!(rounded_rotation(bad).is_err(), "{bad}");
        }
    }
}
