//! How sure a package is of a photo's pose, as packages state it: a covariance of the camera's centre,
//! which stays whole on its way to the world, because axes that turn mix its parts.

use glam::{DMat3, DVec3};

use crate::scale::PoseErrors;

/// The covariance of a photo's pose; `None` where the package says nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseCovariance {
    /// Of the camera's centre, in the reconstruction's frame and the square of its unit; in a frame of
    /// longitudes and latitudes towards east, north, up in square metres. Symmetric, no variance
    /// negative.
    pub position: Option<DMat3>,
    /// Standard deviations of the rotation about the camera's x, y, z axes; degrees.
    pub angle: Option<DVec3>,
}

/// Why a covariance is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct NoCovariance;

/// How a package's reader takes a covariance: nothing, for a parameter that was held fixed.
pub(crate) type Taken<T> = Result<Option<T>, NoCovariance>;

/// A matrix of a file, row by row, as a covariance. Where every variance is zero the adjustment held
/// the parameter: that says nothing of how sure it is.
pub(crate) fn covariance(rows: [f64; 9]) -> Taken<DMat3> {
    let matrix = DMat3::from_cols_array(&rows);
    let variances = diagonal(&matrix);
    if !matrix.is_finite() || variances.min_element() < 0.0 {
        return Err(NoCovariance);
    }
    // Rounded halves of a symmetric one.
    let symmetric = (matrix + matrix.transpose()) * 0.5;
    Ok((variances != DVec3::ZERO).then_some(symmetric))
}

/// Standard deviations in degrees from a covariance in square radians.
pub(crate) fn degrees(covariance: &DMat3) -> DVec3 {
    deviations(covariance).map(f64::to_degrees)
}

/// The roots of the variances.
pub(crate) fn deviations(covariance: &DMat3) -> DVec3 {
    // Rounding may leave a variance of 0 below it.
    diagonal(covariance).max(DVec3::ZERO).map(f64::sqrt)
}

fn diagonal(matrix: &DMat3) -> DVec3 {
    DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z)
}

impl PoseCovariance {
    /// Of a centre whose errors along the axes have nothing in common.
    #[must_use]
    pub fn of_deviations(position: Option<DVec3>, angle: Option<DVec3>) -> Self {
        let variances = |deviations: DVec3| DMat3::from_diagonal(deviations * deviations);
        Self {
            position: position.map(variances),
            angle,
        }
    }

    /// The same where `linear` takes differences of positions in this frame to those in another. The
    /// camera's own axes stay what they are.
    #[must_use]
    pub fn moved(&self, linear: &DMat3) -> Self {
        let moved = |covariance: DMat3| *linear * covariance * linear.transpose();
        Self {
            position: self.position.map(moved),
            angle: self.angle,
        }
    }

    /// What is left of it where only standard deviations are told.
    #[must_use]
    pub fn errors(&self) -> PoseErrors {
        PoseErrors {
            position: self.position.as_ref().map(deviations),
            angle: self.angle,
        }
    }
}

/// Counts what had to be passed over, for one warning.
#[derive(Debug, Default)]
pub(crate) struct PassedOver(usize);

impl PassedOver {
    /// What was taken, or one more passed over.
    pub(crate) fn or_count<T>(&mut self, taken: Taken<T>) -> Option<T> {
        taken.unwrap_or_else(|NoCovariance| {
            self.0 += 1;
            None
        })
    }

    /// The sentence about them.
    pub(crate) fn warning(&self) -> Option<String> {
        let count = self.0;
        (count > 0).then(|| {
            format!("{count} stated covariances are negative, not finite or not complete: they are not used")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn about z takes x to y; twice as long is four times the variance.
    #[test]
    fn a_covariance_turns_whole() {
        let stated = PoseCovariance {
            position: Some(DMat3::from_cols_array(&[
                4.0, 1.0, 0.0, 1.0, 9.0, 2.0, 0.0, 2.0, 16.0,
            ])),
            angle: Some(DVec3::ONE),
        };
        let quarter = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        let moved = stated.moved(&(quarter * 2.0));
        assert_eq!(moved.errors().position, Some(DVec3::new(6.0, 4.0, 8.0)));
        assert_eq!(moved.errors().angle, Some(DVec3::ONE));
        // An eighth of a turn: var(x') = (4 + 9)/2 - 1, var(y') = (4 + 9)/2 + 1.
        let eighth = DMat3::from_rotation_z(std::f64::consts::FRAC_PI_4);
        let turned = stated.moved(&eighth).errors().position.unwrap();
        let expected = DVec3::new(5.5_f64.sqrt(), 7.5_f64.sqrt(), 4.0);
        assert!((turned - expected).length() < 1e-14, "{turned}");
    }

    #[test]
    fn what_is_no_covariance() {
        let with = |at: usize, value| {
            let mut rows = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
            rows[at] = value;
            covariance(rows)
        };
        assert_eq!(with(4, -1e-9), Err(NoCovariance));
        assert_eq!(with(2, f64::NAN), Err(NoCovariance));
        assert_eq!(with(8, f64::INFINITY), Err(NoCovariance));
        assert_eq!(covariance([0.0; 9]), Ok(None));
        let one = with(8, 0.0).unwrap().unwrap();
        assert_eq!(deviations(&one), DVec3::new(1.0, 1.0, 0.0));
        let mut passed_over = PassedOver::default();
        assert_eq!(passed_over.warning(), None);
        assert_eq!(passed_over.or_count(with(0, -1.0)), None);
        assert!(passed_over.warning().unwrap().starts_with("1 stated"));
    }
}
