//! OpenCV's fish-eye model (`cv::fisheye`), ROS's `equidistant`, COLMAP's `OPENCV_FISHEYE`:
//!
//! ```text
//! theta   = angle between the direction and the optical axis
//! theta_d = theta (1 + k1 theta2 + k2 theta4 + k3 theta6 + k4 theta8)
//! (x', y') = theta_d * (unit vector of (x, y))
//! ```

use glam::{DVec2, DVec3};

use super::growing::solve_growing;
use super::not_invertible::NotInvertible;
use super::polynomial::smallest_positive_root;

/// OpenCV's equidistant distortion. Make it with [`Fisheye::new`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fisheye {
    coefficients: [f64; 4],
    /// The angle (radians) up to which the model grows, at most pi.
    fold_angle: f64,
}

impl Fisheye {
    /// From `k1 k2 k3 k4`, all finite; missing ones are 0.
    pub fn new(coefficients: [f64; 4]) -> Self {
        use std::f64::consts::PI;
        let [k1, k2, k3, k4] = coefficients;
        let growth = [1.0, 3.0 * k1, 5.0 * k2, 7.0 * k3, 9.0 * k4];
        let fold_angle = smallest_positive_root(&growth, PI * PI).map_or(PI, f64::sqrt);
        Self {
            coefficients,
            fold_angle,
        }
    }

    /// `k1 k2 k3 k4`.
    pub fn coefficients(&self) -> [f64; 4] {
        self.coefficients
    }

    /// The angle from the optical axis, in radians, at which the model folds back, at most pi.
    pub fn fold_angle(&self) -> f64 {
        self.fold_angle
    }

    /// The distorted point of a direction in camera axes (also one behind the image plane, where
    /// the lens sees it), or `None` beyond the fold.
    pub fn distorted_from_direction(&self, direction: DVec3) -> Option<DVec2> {
        let sideways = direction.truncate();
        let theta = sideways.length().atan2(direction.z);
        if theta >= self.fold_angle {
            return None;
        }
        let outward = sideways.try_normalize().unwrap_or(DVec2::ZERO);
        Some(outward * self.distorted_angle(theta).0)
    }

    /// The direction (camera axes, unit) that lies at `distorted`, to `tolerance`.
    ///
    /// # Errors
    /// Where the model folds back before it reaches that radius.
    pub fn direction_from_distorted(
        &self,
        distorted: DVec2,
        tolerance: f64,
    ) -> Result<DVec3, NotInvertible> {
        let radius = distorted.length();
        let (reach, _) = self.distorted_angle(self.fold_angle);
        let not_invertible = NotInvertible {
            radius,
            fold: reach,
        };
        if radius > reach {
            return Err(not_invertible);
        }
        let start = radius.min(self.fold_angle);
        let theta = solve_growing(
            |theta| self.distorted_angle(theta),
            radius,
            0.0,
            self.fold_angle,
            start,
        );
        if (self.distorted_angle(theta).0 - radius).abs() > tolerance {
            return Err(not_invertible);
        }
        let outward = distorted.try_normalize().unwrap_or(DVec2::ZERO);
        Ok((outward * theta.sin()).extend(theta.cos()))
    }

    /// theta_d and its derivative.
    fn distorted_angle(&self, theta: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.coefficients;
        let s = theta * theta;
        (
            theta * (1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4)))),
            1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * (7.0 * k3 + s * 9.0 * k4))),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equidistant_without_coefficients() {
        let model = Fisheye::new([0.0; 4]);
        for degrees in [0.0_f64, 1.0, 45.0, 90.0, 120.0, 179.0] {
            let theta = degrees.to_radians();
            let direction = DVec3::new(0.0, theta.sin(), theta.cos());
            let distorted = model.distorted_from_direction(direction).unwrap();
            assert!((distorted - DVec2::new(0.0, theta)).length() < 1e-15);
            let back = model.direction_from_distorted(distorted, 1e-12).unwrap();
            assert!((back - direction).length() < 1e-14, "{degrees}");
        }
    }

    #[test]
    fn the_fold_of_one_coefficient_is_known_in_closed_form() {
        let model = Fisheye::new([-0.2, 0.0, 0.0, 0.0]);
        let fold = 1.0 / 0.6_f64.sqrt();
        assert!((model.fold_angle() - fold).abs() < 1e-15);
        let reach = fold * 2.0 / 3.0;
        let inside = DVec2::new(reach * 0.999_999, 0.0);
        assert!(model.direction_from_distorted(inside, 1e-12).is_ok());
        let outside = DVec2::new(reach * 1.000_001, 0.0);
        assert!(model.direction_from_distorted(outside, 1e-12).is_err());
    }
}
