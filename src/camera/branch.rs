//! The inverse of a map of the image plane that leads outward from the middle until it folds.
//!
//! It follows the straight line from the principal point to the wanted point, so it ends on the
//! branch of the model that the middle of the image lies on, or finds that this branch ends (its
//! Jacobian loses rank) before it arrives. Newton's method from a fixed start, as OpenCV does it,
//! may land on the far side of the fold without saying so.

use glam::{DMat2, DVec2};

use super::not_invertible::NotInvertible;

/// The ideal point that `map` (the distorted point and the derivative, `None` beyond the fold) puts
/// at `distorted`, to `tolerance`. The map leaves the origin where it is.
///
/// # Errors
/// Where the branch of the map around the origin does not reach `distorted`.
pub(super) fn invert(
    map: impl Fn(DVec2) -> Option<(DVec2, DMat2)>,
    distorted: DVec2,
    tolerance: f64,
) -> Result<DVec2, NotInvertible> {
    let mut ideal = DVec2::ZERO;
    let mut reached = 0.0;
    let mut step: f64 = 0.25;
    while reached < 1.0 {
        let next = (reached + step).min(1.0);
        match newton(&map, ideal, distorted * next, tolerance) {
            Some(found) => {
                ideal = found;
                reached = next;
                step *= 2.0;
            }
            // Near the fold the steps shrink without end: closer than this is beyond it.
            None if step < 1e-9 => {
                let radius = distorted.length();
                return Err(NotInvertible {
                    radius,
                    fold: radius * reached,
                });
            }
            None => step /= 4.0,
        }
    }
    Ok(ideal)
}

/// Between two looks for a fold on the way outward the radius grows by this: a fold and its way back within less are not seen.
const OUTWARD: f64 = 1.01;

/// How far a map leads outward without folding.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// Within this radius it is known not to fold.
    pub(super) sure: f64,
    /// From here on it is not looked at; 0 where that radius alone decides.
    pub(super) end: f64,
}

impl Reach {
    /// The map at `ideal` (the distorted point and the derivative), or `None` where it folds on the way there.
    pub(super) fn on_branch(
        self,
        map: impl Fn(DVec2) -> (DVec2, DMat2),
        ideal: DVec2,
    ) -> Option<(DVec2, DMat2)> {
        let radius = ideal.length();
        let is_on = radius < self.sure || radius < self.end && self.leads_outward(&map, ideal);
        is_on.then(|| map(ideal))
    }

    fn leads_outward(self, map: impl Fn(DVec2) -> (DVec2, DMat2), ideal: DVec2) -> bool {
        let radius = ideal.length();
        let mut at = self.sure.max(1e-6).min(radius);
        while map(ideal * (at / radius)).1.determinant() > 0.0 {
            if at >= radius {
                return true;
            }
            at = (at * OUTWARD).min(radius);
        }
        false
    }
}

/// Newton's method for a target near `map(start)`; `None` where it does not converge at once or
/// would leave the branch of `start`.
fn newton(
    map: &impl Fn(DVec2) -> Option<(DVec2, DMat2)>,
    start: DVec2,
    target: DVec2,
    tolerance: f64,
) -> Option<DVec2> {
    let mut ideal = start;
    let mut last_error = f64::INFINITY;
    for _ in 0..8 {
        let (distorted, jacobian) = map(ideal)?;
        if jacobian.determinant() <= 0.0 {
            return None;
        }
        let error = (target - distorted).length();
        // On past the tolerance to the floor of rounding: one more step is cheap, and the branch
        // is then known to be the right one.
        if error == 0.0 || (error <= tolerance && error >= last_error / 2.0) {
            return Some(ideal);
        }
        if error >= last_error {
            return None;
        }
        last_error = error;
        ideal += jacobian.inverse() * (target - distorted);
    }
    (last_error <= tolerance).then_some(ideal)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x, y) -> (x - x3, y) folds at x = 1/sqrt 3, where it reaches 2/(3 sqrt 3).
    #[test]
    fn it_stops_at_the_fold() {
        let map = |p: DVec2| {
            let jacobian = DMat2::from_diagonal(DVec2::new(1.0 - 3.0 * p.x * p.x, 1.0));
            Some((DVec2::new(p.x - p.x.powi(3), p.y), jacobian))
        };
        let found = invert(map, DVec2::new(0.375, 7.0), 1e-13).unwrap();
        assert!((found - DVec2::new(0.5, 7.0)).length() < 1e-13, "{found}");
        let reach = 2.0 / 27.0_f64.sqrt();
        let beyond = invert(map, DVec2::new(0.4, 0.0), 1e-13).unwrap_err();
        assert!((beyond.fold - reach).abs() < 1e-6, "{beyond}");
    }

    #[test]
    fn the_end_of_the_map_is_an_end() {
        let map = |p: DVec2| (p.length() < 1.0).then_some((p, DMat2::IDENTITY));
        assert!(invert(map, DVec2::new(0.999, 0.0), 1e-13).is_ok());
        let beyond = invert(map, DVec2::new(0.0, 1.25), 1e-13).unwrap_err();
        assert!((beyond.fold - 1.0).abs() < 1e-6, "{beyond}");
    }
}
