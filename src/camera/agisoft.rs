//! Agisoft's distortion with all its terms (Metashape manual, appendix "Camera models"):
//!
//! ```text
//! x' = x (1 + k1 r2 + k2 r4 + k3 r6 + k4 r8) + (p1 (r2 + 2 x2) + 2 p2 x y) (1 + p3 r2 + p4 r4)
//! y' = y (           the same factor       ) + (p2 (r2 + 2 y2) + 2 p1 x y) (1 + p3 r2 + p4 r4)
//! ```
//!
//! p1 and p2 are OpenCV's p2 and p1. (x, y) is the direction X, Y, Z on the plane of the projection:
//!
//! | projection | distance of (x, y) from the middle |
//! |---|---|
//! | frame | tan theta |
//! | equidistant fish-eye | theta |
//! | equisolid fish-eye | 2 sin(theta / 2) |
//!
//! PhotoScan 1.2 to Metashape 1.5 have p3 and p4; since then they are left out, which is 0. A frame
//! camera with k4 = p3 = p4 = 0 is OpenCV's `Brown`, an equidistant one without any p its `Fisheye`.

use glam::{DMat2, DVec2, DVec3};

use super::branch::{Reach, invert};
use super::not_invertible::NotInvertible;
use super::polynomial::{smallest_positive_root, smallest_root_of_parts};

/// The radius up to which a frame camera's fold is looked for: tan 89.9 degrees.
const FARTHEST_RADIUS: f64 = 573.0;

/// What a direction becomes before the lens distorts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AgisoftProjection {
    /// The central projection of a plane.
    Frame,
    /// Equal angles are equal distances.
    EquidistantFisheye,
    /// Equal solid angles are equal areas.
    EquisolidFisheye,
}

/// Agisoft's distortion. Make it with [`Agisoft::new`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agisoft {
    projection: AgisoftProjection,
    /// k1 k2 k3 k4.
    radial: [f64; 4],
    /// p1 p2 p3 p4.
    tangential: [f64; 4],
    /// To where nothing folds whatever the tangential terms do, and to where the projection ends; without any, to the fold.
    reach: Reach,
}

impl Agisoft {
    /// From `k1 k2 k3 k4` and `p1 p2 p3 p4`, all finite; missing ones are 0.
    pub fn new(projection: AgisoftProjection, radial: [f64; 4], tangential: [f64; 4]) -> Self {
        use std::f64::consts::PI;
        // A plane's projection ends nowhere, and is looked at so far.
        let (end, looked_to) = match projection {
            AgisoftProjection::Frame => (f64::INFINITY, FARTHEST_RADIUS),
            AgisoftProjection::EquidistantFisheye => (PI, PI),
            AgisoftProjection::EquisolidFisheye => (2.0, 2.0),
        };
        let [k1, k2, k3, k4] = radial;
        let growth = [1.0, 3.0 * k1, 5.0 * k2, 7.0 * k3, 9.0 * k4];
        let [p1, p2, p3, p4] = tangential;
        let p = 6.0 * p1.hypot(p2);
        let reach = if p == 0.0 {
            let fold = smallest_positive_root(&growth, looked_to.powi(2));
            Reach {
                sure: fold.map_or(end, f64::sqrt),
                end: 0.0,
            }
        } else {
            // As long as both eigenvalues of the radial derivative are larger than what is the most that of the tangential
            // terms takes away: 6 p r (1 + 2 |p3| r2 + 3 |p4| r4).
            let most = [p, 2.0 * p * p3.abs(), 3.0 * p * p4.abs()];
            let parts = [growth, [1.0, k1, k2, k3, k4]];
            let roots = parts.map(|part| smallest_root_of_parts(&part, &most, looked_to));
            Reach {
                sure: roots.into_iter().flatten().fold(looked_to, f64::min),
                end: looked_to,
            }
        };
        Self {
            projection,
            radial,
            tangential,
            reach,
        }
    }

    /// What a direction becomes before the lens distorts it.
    pub fn projection(&self) -> AgisoftProjection {
        self.projection
    }

    /// `k1 k2 k3 k4 p1 p2 p3 p4`, in Agisoft's meaning.
    pub fn coefficients(&self) -> [f64; 8] {
        let ([k1, k2, k3, k4], [p1, p2, p3, p4]) = (self.radial, self.tangential);
        [k1, k2, k3, k4, p1, p2, p3, p4]
    }

    /// The distorted point of a direction in camera axes, or `None` where the lens does not see it.
    pub fn distorted_from_direction(&self, direction: DVec3) -> Option<DVec2> {
        let sideways = direction.truncate();
        let outward = sideways.try_normalize().unwrap_or(DVec2::ZERO);
        let theta = sideways.length().atan2(direction.z);
        let ideal = match self.projection {
            AgisoftProjection::Frame if direction.z <= 0.0 => return None,
            AgisoftProjection::Frame => sideways / direction.z,
            AgisoftProjection::EquidistantFisheye => outward * theta,
            AgisoftProjection::EquisolidFisheye => outward * (2.0 * (theta / 2.0).sin()),
        };
        let (distorted, jacobian) = self.on_branch(ideal)?;
        (jacobian.determinant() > 0.0).then_some(distorted)
    }

    /// The direction (camera axes, not normalised) that lies at `distorted`, to `tolerance`.
    ///
    /// # Errors
    /// Where the branch of the model around the middle does not reach `distorted`.
    pub fn direction_from_distorted(
        &self,
        distorted: DVec2,
        tolerance: f64,
    ) -> Result<DVec3, NotInvertible> {
        let ideal = invert(|ideal| self.on_branch(ideal), distorted, tolerance)?;
        let radius = ideal.length();
        let theta = match self.projection {
            AgisoftProjection::Frame => return Ok(ideal.extend(1.0)),
            AgisoftProjection::EquidistantFisheye => radius,
            AgisoftProjection::EquisolidFisheye => 2.0 * (radius / 2.0).asin(),
        };
        let outward = ideal.try_normalize().unwrap_or(DVec2::ZERO);
        Ok((outward * theta.sin()).extend(theta.cos()))
    }

    /// The distorted point and the derivative of the map, or `None` where it folds on the way or the projection ends.
    fn on_branch(&self, ideal: DVec2) -> Option<(DVec2, DMat2)> {
        self.reach.on_branch(|ideal| self.map(ideal), ideal)
    }

    /// The distorted point and the derivative of the map.
    fn map(&self, ideal: DVec2) -> (DVec2, DMat2) {
        let ([k1, k2, k3, k4], [p1, p2, p3, p4]) = (self.radial, self.tangential);
        let (x, y) = (ideal.x, ideal.y);
        let s = ideal.length_squared();
        let radial = 1.0 + s * (k1 + s * (k2 + s * (k3 + s * k4)));
        let radial_ds = k1 + s * (2.0 * k2 + s * (3.0 * k3 + s * 4.0 * k4));
        let decentring = DVec2::new(
            p1 * (s + 2.0 * x * x) + 2.0 * p2 * x * y,
            p2 * (s + 2.0 * y * y) + 2.0 * p1 * x * y,
        );
        let mixed = 2.0 * (p1 * y + p2 * x);
        let decentring_dx = DVec2::new(6.0 * p1 * x + 2.0 * p2 * y, mixed);
        let decentring_dy = DVec2::new(mixed, 6.0 * p2 * y + 2.0 * p1 * x);
        let growth = 1.0 + s * (p3 + s * p4);
        let growth_ds = p3 + 2.0 * p4 * s;
        let dx = DVec2::new(radial, 0.0)
            + ideal * (2.0 * x * radial_ds)
            + decentring_dx * growth
            + decentring * (2.0 * x * growth_ds);
        let dy = DVec2::new(0.0, radial)
            + ideal * (2.0 * y * radial_ds)
            + decentring_dy * growth
            + decentring * (2.0 * y * growth_ds);
        let jacobian = DMat2::from_cols(dx, dy);
        (ideal * radial + decentring * growth, jacobian)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Brown, Fisheye};

    const RADIAL: [f64; 4] = [0.1, -0.05, 0.03, 0.007];
    const TANGENTIAL: [f64; 4] = [-0.02, 0.01, 0.3, -0.2];

    /// The manual's formula by hand at (0.3, -0.2): r2 = 0.13, r4 = 0.0169, r6 = 0.002197,
    /// r8 = 0.00028561.
    #[test]
    fn matches_the_formula_term_by_term() {
        let model = Agisoft::new(AgisoftProjection::Frame, RADIAL, TANGENTIAL);
        let d = model
            .distorted_from_direction(DVec3::new(0.6, -0.4, 2.0))
            .unwrap();
        let radial = 1.0 + 0.013 - 0.05 * 0.0169 + 0.03 * 0.002_197 + 0.007 * 0.000_285_61;
        let growth = 1.0 + 0.3 * 0.13 - 0.2 * 0.0169;
        let x = 0.3 * radial + (-0.02 * 0.31 + 0.02 * -0.06) * growth;
        let y = -0.2 * radial + (0.01 * 0.21 - 0.04 * -0.06) * growth;
        assert!((d - DVec2::new(x, y)).length() < 1e-16, "{d}");
    }

    /// Without the terms that OpenCV lacks, and with p1 and p2 swapped, the models are one.
    #[test]
    fn is_opencv_with_the_tangential_terms_swapped() {
        let ([k1, k2, k3, _], [p1, p2, ..]) = (RADIAL, TANGENTIAL);
        let agisoft = Agisoft::new(
            AgisoftProjection::Frame,
            [k1, k2, k3, 0.0],
            [p1, p2, 0.0, 0.0],
        );
        let brown = Brown::new([k1, k2, p2, p1, k3, 0.0, 0.0, 0.0]);
        let fisheye = Fisheye::new(RADIAL);
        let agisoft_fisheye = Agisoft::new(AgisoftProjection::EquidistantFisheye, RADIAL, [0.0; 4]);
        for (x, y) in [(0.0, 0.0), (0.4, 0.3), (-0.7, 0.2), (0.1, -0.9)] {
            let direction = DVec3::new(x, y, 1.0);
            let ours = agisoft.distorted_from_direction(direction).unwrap();
            let theirs = brown.distorted_from_ideal(DVec2::new(x, y)).unwrap();
            assert!((ours - theirs).length() < 1e-15);
            let ours = agisoft_fisheye.distorted_from_direction(direction).unwrap();
            let theirs = fisheye.distorted_from_direction(direction).unwrap();
            assert!((ours - theirs).length() < 1e-15);
        }
    }

    /// Half a sphere, 90 degrees off the axis: theta = pi/2, 2 sin(pi/4) = sqrt 2.
    #[test]
    fn known_radii_of_the_fisheyes() {
        let at = |projection| {
            let model = Agisoft::new(projection, [0.0; 4], [0.0; 4]);
            let d = model.distorted_from_direction(DVec3::Y).unwrap();
            let back = model.direction_from_distorted(d, 1e-13).unwrap();
            assert!((back - DVec3::Y).length() < 1e-14, "{back}");
            d.y
        };
        let equidistant = at(AgisoftProjection::EquidistantFisheye);
        assert!((equidistant - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        let equisolid = at(AgisoftProjection::EquisolidFisheye);
        assert!((equisolid - std::f64::consts::SQRT_2).abs() < 1e-15);
        let frame = Agisoft::new(AgisoftProjection::Frame, [0.0; 4], [0.0; 4]);
        assert_eq!(frame.distorted_from_direction(DVec3::Y), None);
    }

    /// d/dr (r + k r^9) = 0 at r = (-9 k)^(-1/8), where the distorted radius is 8/9 of that.
    #[test]
    fn the_fold_of_k4_is_known_in_closed_form() {
        let k4 = -0.2_f64;
        let fold = (-9.0 * k4).powf(-0.125);
        let model = Agisoft::new(AgisoftProjection::Frame, [0.0, 0.0, 0.0, k4], [0.0; 4]);
        let seen = |r: f64| model.distorted_from_direction(DVec3::new(r, 0.0, 1.0));
        assert!(seen(fold * 0.9999).is_some() && seen(fold * 1.0001).is_none());
        let reach = fold * 8.0 / 9.0;
        let at = |r: f64| model.direction_from_distorted(DVec2::new(0.0, r), 1e-13);
        assert!(at(reach * 0.99999).is_ok());
        let outside = at(reach * 1.00001).unwrap_err();
        assert!((outside.fold - reach).abs() < 1e-6, "{outside}");
    }

    /// Within the radius that is called sure the determinant is positive whichever the direction, also with p3 and p4; and it is not
    /// called much too small: with growing terms alone the first fold lies within three times as far.
    #[test]
    fn what_is_called_sure_does_not_fold() {
        let mut folds = 0;
        for tangential in [
            [0.02, 0.0, 0.0, 0.0],
            [-0.01, 0.03, 0.4, 0.0],
            [0.005, -0.02, -0.8, 0.5],
            [0.0, 0.05, 2.0, -3.0],
        ] {
            for radial in [[-0.3, 0.05, 0.0, 0.0], [0.1, -0.2, 0.0, 0.01], [0.0; 4]] {
                let model = Agisoft::new(AgisoftProjection::Frame, radial, tangential);
                let sure = model.reach.sure;
                assert!(sure > 0.2, "{sure}");
                let has_fold = |times: f64| {
                    (0..360).any(|degrees| {
                        let outward = DVec2::from_angle(f64::from(degrees).to_radians());
                        let (_, jacobian) = model.map(outward * (sure * times));
                        jacobian.determinant() <= 0.0
                    })
                };
                let within = (1..100).map(|step| f64::from(step) / 100.0);
                assert!(
                    !within.into_iter().any(has_fold),
                    "{radial:?} {tangential:?}"
                );
                let beyond = (100..300).map(|step| f64::from(step) / 100.0);
                folds += u32::from(beyond.into_iter().any(has_fold));
            }
        }
        // The first of all grows for ever. (numpy, by differences, has the same 11, and none within.)
        assert_eq!(folds, 11);
    }

    /// A fold that the tangential terms move is where OpenCV's model has it.
    #[test]
    fn tangential_terms_move_the_fold_as_in_opencv() {
        let ours = Agisoft::new(
            AgisoftProjection::Frame,
            [-0.3, 0.0, 0.0, 0.0],
            [0.02, 0.01, 0.0, 0.0],
        );
        let theirs = Brown::new([-0.3, 0.0, 0.01, 0.02, 0.0, 0.0, 0.0, 0.0]);
        for degrees in 0..360 {
            let outward = DVec2::from_angle(f64::from(degrees).to_radians());
            for radius in [0.5, 0.9, 0.97, 1.0, 1.03, 1.08, 1.12, 1.2, 2.0, 9.0] {
                let at = outward * radius;
                let sees = ours.distorted_from_direction(at.extend(1.0)).is_some();
                assert_eq!(sees, theirs.distorted_from_ideal(at).is_some(), "{at}");
            }
        }
    }
}
