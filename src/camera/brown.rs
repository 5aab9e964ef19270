//! OpenCV's rational distortion, `k1 k2 p1 p2 k3 k4 k5 k6` (OpenCV documentation, "Camera
//! Calibration and 3D Reconstruction", detailed description):
//!
//! ```text
//! x' = x (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6) + 2 p1 x y + p2 (r2 + 2 x2)
//! y' = y (     the same factor      )                              + p1 (r2 + 2 y2) + 2 p2 x y
//! ```
//!
//! ROS's `plumb_bob` is its first five coefficients, `rational_polynomial` all eight.

use glam::{DMat2, DVec2};

use super::branch::{Reach, invert};
use super::not_invertible::NotInvertible;
use super::polynomial::{smallest_positive_root, smallest_root_of_parts};

/// The radius up to which the fold is looked for: tan 89.9 degrees. No lens with this model sees
/// further out.
const FARTHEST_RADIUS: f64 = 573.0;

/// OpenCV's rational distortion. Make it with [`Brown::new`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brown {
    coefficients: [f64; 8],
    /// Squared radius of the fold of the radial factor, infinite where it has none.
    fold_squared: f64,
    /// To where nothing folds whatever the tangential terms do; without any, to the fold.
    reach: Reach,
}

impl Brown {
    /// From `k1 k2 p1 p2 k3 k4 k5 k6`, all finite; missing ones are 0.
    pub fn new(coefficients: [f64; 8]) -> Self {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = coefficients;
        // d(r N/D)/dr has the sign of N D + 2 s (N' D - N D'), with s = r2; D must stay positive.
        let (numerator, denominator) = ([1.0, k1, k2, k3], [1.0, k4, k5, k6]);
        let mut growth = [0.0; 7];
        for (i, n) in numerator.iter().enumerate() {
            for (j, d) in denominator.iter().enumerate() {
                growth[i + j] += n * d * (1.0 + 2.0 * (i as f64 - j as f64));
            }
        }
        let fold_squared = [&growth[..], &denominator[..]]
            .into_iter()
            .filter_map(|p| smallest_positive_root(p, FARTHEST_RADIUS.powi(2)))
            .fold(f64::INFINITY, f64::min);
        let p = p1.hypot(p2);
        let reach = match p == 0.0 {
            true => Reach {
                sure: fold_squared.sqrt(),
                end: 0.0,
            },
            false => {
                let pole = smallest_root_of_parts(&denominator, &[], FARTHEST_RADIUS);
                let pole = pole.unwrap_or(FARTHEST_RADIUS);
                Reach {
                    sure: sure_radius(p, &growth, numerator, denominator).min(pole),
                    end: pole,
                }
            }
        };
        Self {
            coefficients,
            fold_squared,
            reach,
        }
    }

    /// `k1 k2 p1 p2 k3 k4 k5 k6`.
    pub fn coefficients(&self) -> [f64; 8] {
        self.coefficients
    }

    /// The ideal radius (focal lengths) at which the radial factor folds back, infinite where it
    /// grows for ever.
    pub fn fold_radius(&self) -> f64 {
        self.fold_squared.sqrt()
    }

    /// The distorted point of an ideal one, or `None` beyond the fold.
    pub fn distorted_from_ideal(&self, ideal: DVec2) -> Option<DVec2> {
        let (distorted, jacobian) = self.on_branch(ideal)?;
        (jacobian.determinant() > 0.0).then_some(distorted)
    }

    /// The ideal point that lies at `distorted`, to `tolerance`.
    ///
    /// # Errors
    /// Where the branch of the model around the principal point does not reach `distorted`.
    pub fn ideal_from_distorted(
        &self,
        distorted: DVec2,
        tolerance: f64,
    ) -> Result<DVec2, NotInvertible> {
        invert(|ideal| self.on_branch(ideal), distorted, tolerance)
    }

    /// The distorted point and the derivative of the map, or `None` beyond the fold. Tangential terms move that: on one side
    /// of the middle it lies farther out than the radial factor's, on the other nearer.
    fn on_branch(&self, ideal: DVec2) -> Option<(DVec2, DMat2)> {
        self.reach.on_branch(|ideal| self.map(ideal), ideal)
    }

    /// The distorted point and the derivative of the map.
    fn map(&self, p: DVec2) -> (DVec2, DMat2) {
        let [k1, k2, p1, p2, k3, k4, k5, k6] = self.coefficients;
        let (x, y) = (p.x, p.y);
        let s = x * x + y * y;
        let numerator = 1.0 + s * (k1 + s * (k2 + s * k3));
        let denominator = 1.0 + s * (k4 + s * (k5 + s * k6));
        let radial = numerator / denominator;
        let numerator_ds = k1 + s * (2.0 * k2 + s * 3.0 * k3);
        let denominator_ds = k4 + s * (2.0 * k5 + s * 3.0 * k6);
        let radial_ds = (numerator_ds - radial * denominator_ds) / denominator;
        let distorted = DVec2::new(
            x * radial + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x),
            y * radial + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y,
        );
        let mixed = 2.0 * x * y * radial_ds + 2.0 * p1 * x + 2.0 * p2 * y;
        let jacobian = DMat2::from_cols_array(&[
            radial + 2.0 * x * x * radial_ds + 2.0 * p1 * y + 6.0 * p2 * x,
            mixed,
            mixed,
            radial + 2.0 * y * y * radial_ds + 6.0 * p1 * y + 2.0 * p2 * x,
        ]);
        (distorted, jacobian)
    }
}

/// The radius within which the map of the plane does not fold.
///
/// The derivative is the radial one, symmetric with the eigenvalues N / D and d(r N / D) / dr, and that of the tangential
/// terms, symmetric with eigenvalues of at most 6 p r: as long as the former are larger, before any pole, nothing folds.
fn sure_radius(p: f64, growth: &[f64; 7], numerator: [f64; 4], denominator: [f64; 4]) -> f64 {
    let mut squared = [0.0; 7];
    for (i, a) in denominator.iter().enumerate() {
        for (j, b) in denominator.iter().enumerate() {
            squared[i + j] += 6.0 * p * a * b;
        }
    }
    let roots = [
        smallest_root_of_parts(
            &numerator,
            &denominator.map(|d| 6.0 * p * d),
            FARTHEST_RADIUS,
        ),
        smallest_root_of_parts(growth, &squared, FARTHEST_RADIUS),
    ];
    roots.into_iter().flatten().fold(FARTHEST_RADIUS, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// OpenCV 4.6 `projectPoints` of (0.3, -0.2, 1) with K = I; the formula by hand in exact
    /// fractions gives the same digits.
    #[test]
    fn matches_the_formula_term_by_term() {
        let model = Brown::new([0.1, -0.05, 0.01, -0.02, 0.03, 0.002, -0.004, 0.001]);
        let d = model.distorted_from_ideal(DVec2::new(0.3, -0.2)).unwrap();
        let radial = (1.0 + 0.013 - 0.05 * 0.0169 + 0.03 * 0.002197)
            / (1.0 + 0.00026 - 0.004 * 0.0169 + 0.001 * 0.002197);
        assert!((d.x - (0.3 * radial - 0.0012 - 0.02 * 0.31)).abs() < 1e-16);
        assert!((d.y - (-0.2 * radial + 0.01 * 0.21 + 0.0024)).abs() < 1e-16);
    }

    #[test]
    fn the_fold_of_one_coefficient_is_known_in_closed_form() {
        // d/dr (r + k r^3) = 0 at r = 1/sqrt(-3k), where the distorted radius is 2/3 of that.
        let k = -0.3;
        let model = Brown::new([k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let fold = 1.0 / (-3.0 * k).sqrt();
        assert!((model.fold_radius() - fold).abs() < 1e-15);
        let direction = DVec2::from_angle(0.7);
        assert!(
            model
                .distorted_from_ideal(direction * (fold * 0.9999))
                .is_some()
        );
        assert!(
            model
                .distorted_from_ideal(direction * (fold * 1.0001))
                .is_none()
        );

        let reach = fold * 2.0 / 3.0;
        let inside = model
            .ideal_from_distorted(direction * (reach * 0.99999), 1e-13)
            .unwrap();
        assert!(inside.length() < fold);
        let outside = model
            .ideal_from_distorted(direction * (reach * 1.00001), 1e-13)
            .unwrap_err();
        assert!((outside.fold - reach).abs() < 1e-6, "{outside}");
    }

    /// Along x, with p2 alone, x' = x + k1 x^3 + 3 p2 x^2: it folds where 1 + 3 k1 x^2 + 6 p2 x = 0, at 1.1229 to the right
    /// and at -0.9895 to the left for k1 = -0.3 and p2 = 0.02, and the radial factor at 1.0541.
    #[test]
    fn tangential_terms_move_the_fold() {
        let (k1, p2) = (-0.3_f64, 0.02_f64);
        let model = Brown::new([k1, 0.0, 0.0, p2, 0.0, 0.0, 0.0, 0.0]);
        let root = (9.0 * p2 * p2 - 3.0 * k1).sqrt();
        for (side, fold) in [
            (1.0, (3.0 * p2 + root) / (-3.0 * k1)),
            (-1.0, (root - 3.0 * p2) / (-3.0 * k1)),
        ] {
            let at = |x: f64| DVec2::new(side * x, 0.0);
            let image = |x: f64| side * x + k1 * side * x.powi(3) + 3.0 * p2 * x * x;
            for within in [0.3, 0.9, 0.9999] {
                let x = within * fold;
                let found = model.distorted_from_ideal(at(x)).unwrap();
                assert!((found - DVec2::new(image(x), 0.0)).length() < 1e-15);
                let back = model.ideal_from_distorted(found, 1e-13).unwrap();
                assert!((back - at(x)).length() < 1e-8, "{back} for {x}");
            }
            // Far out both directions are turned back, which mirrors nothing.
            for beyond in [1.0001, 1.2, 2.0, 50.0] {
                assert_eq!(model.distorted_from_ideal(at(beyond * fold)), None);
            }
            let reach = image(fold);
            let beyond = DVec2::new(reach * 1.0001, 0.0);
            let outside = model.ideal_from_distorted(beyond, 1e-13).unwrap_err();
            assert!((outside.fold - reach.abs()).abs() < 1e-6, "{outside}");
        }
        // Without a radial factor: (1 + 6 p2 x)(1 + 2 p2 x) is positive again behind the second fold, where the image is covered twice.
        let twice = Brown::new([0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0]);
        let seen = |x: f64| twice.distorted_from_ideal(DVec2::new(x, 0.0)).is_some();
        assert_eq!(
            [0.3, 0.4, 0.9, 1.1, 3.0].map(seen),
            [true, false, false, false, false]
        );
    }

    #[test]
    fn a_pole_of_the_denominator_is_a_fold() {
        let model = Brown::new([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]);
        assert_eq!(model.fold_radius(), 1.0);
        assert!(
            model
                .ideal_from_distorted(DVec2::new(50.0, 0.0), 1e-12)
                .is_ok()
        );
    }

    #[test]
    fn grows_for_ever_without_negative_terms() {
        let model = Brown::new([0.1, 0.2, 0.0, 0.0, 0.3, 0.0, 0.0, 0.0]);
        assert_eq!(model.fold_radius(), f64::INFINITY);
    }
}
