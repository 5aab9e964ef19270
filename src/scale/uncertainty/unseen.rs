//! What lies unseen between fragments: how much of it a photo has, by what its cloud shows.
//!
//! It is deep and dark there: fewer photos look in, and what they show matches badly, so that a cloud has no points, or
//! points that hang at the height of the stones' rims. Its surface runs from stone to stone, too near, and scales are too
//! large. How far goes with how rough the surface is (the root mean square of the depth errors of left-out points, at
//! one spacing for all clouds: `surface_error`), and with how much of the deep has points. No single point tells that, but
//! together they do: where the deep has points, a near one is hardly a better neighbour than a far one, and errors grow
//! with a small power of the area between points; where only the stones have them, near ones lie on the same stone. So
//! depths are short by [`BIAS_OF_GROWTH`] times that power of the roughness, at most by [`MOST_BIAS`] of it. Errors
//! that are only noise of the points do not grow, and hide nothing; a smooth bend has next to no roughness.
//!
//! What the constants rest on, each share the mean over photos of the line's error less its bridges' over the roughness:
//!
//! | clouds | photos | power | share |
//! |---|---|---|---|
//! | simulated, points in the dark as elsewhere (as `sample` made them before) | 108 | 0.08 to 0.15 | 0.02 to 0.08 |
//! | simulated, few points in the dark (`sample`, `sfm_cloud.rs`), 60 000 points | 216 | 0.15 to 0.24 | 0.34 to 0.60 |
//! | the same, 400 000 points | 72 | 0.14 to 0.24 | 0.26 to 0.54 |
//! | the same, 15 000 points | 72 | 0.14 to 0.22 | 0.31 to 0.54 |
//! | the same, flown at 0.58 and 0.78 of the height, so seen by fewer photos | 72 | 0.15 to 0.30 | 0.45 to 0.55 |
//! | `reconstruct`, dense: two muckpiles, a stockpile, a bench | 15 | 0.24 to 0.35 | 0.45 to 0.65 |
//! | `reconstruct`, sparse: a muckpile | 3 | 0.30 | 0.49 |
//!
//! Ranges are over the places (lab, muckpile, stockpile, bench; seeds from 2000, 3000, 4000 and 5000 on). Fitted to the
//! simulated ones by likelihood (Student's t of 4 degrees) with those of `bridges`, to both kinds of them, for nobody knows
//! how dark it was between the stones of a photo; the reconstructed ones only looked at.
//!
//! A sparse reconstruction has points where there is most to recognize, ten in one place and none beside it. So each counts as
//! much as the photo shows of its triangles; and the mean of the errors of left-out points then says by how much such a
//! surface cuts the tops off the stones, which makes scales too small and is taken off the rest. Of three sparse flights
//! (`reconstruct`, *fast*, 105 photos each: bench 6101, muckpile 6201, stockpile 6301) the mean depth was short by 0.38, 0.11
//! and 0.04 %, where the gaps alone say 0.5, 0.3 and 0.3 and the tops 0.26, 0.23 and 0.2 back. [`SPREAD_OF_BIAS`] is what
//! holds the lines of those three and of `sample`'s clouds of the same places. The coverage in docs/scales.md is of
//! other piles (`benches/coverage.rs`).
//!
//! Who looks flatly does not see into gaps. Of those three, less what stands above, the ends of lines at which rays meet the
//! surface at less than 17, at 17 to 31 and at more than 56 degrees from its normal were off by -0.04, -0.02, -0.17; -0.28,
//! -0.19, -0.16; and -0.28, -0.47, -0.68 of the roughness: 90, 67 and 67 % of the last were held. So [`LESS_BY_TAN`], and
//! [`SPREAD_OF_BIAS`] could be smaller (0.75 before). The other sparse surveys, the dense ones and the benches of `sample` go
//! the same way.
//!
//! A single place, as a corner hangs on, is seldom off by the mean: most lie on a stone, and some in a gap that no left-out point
//! lies in. So a drawn place is off as the points around it are, somewhat wider, and one in seven ([`IN_GAP`]) lies deeper by
//! an exponential depth besides, so that the mean is as above; less where one looks flatly ([`GAPS_BY_TAN`]). Places of corners that are
//! simply shifted by the mean put the true scale of a bench beyond the interval where the corner lies well on a stone, and where it
//! lies in a gap as well: 89 % of corners of sparse benches were held, 93 to 95 % of the muckpiles' and the stockpile's; now
//! 93 to 97 % of all five, in intervals that are 1.0 (muckpile 6202) to 1.5 times (bench 6102) as wide. Chosen on bench 6101, muckpile 6201
//! and stockpile 6301.

use super::LEAST_POINTS;
use super::draws::Draws;
use super::holes::Line;
use super::surface_error::{
    DepthError, DepthErrors, SHIFTED, mean, root_mean_square, without_flying,
};
use crate::scale::FittedScale;
use crate::scale::field::ScaleField;

/// By how much depths are too small in the mean, over the roughness, for each unit of the power with which errors grow.
const BIAS_OF_GROWTH: f64 = 1.9;

/// The most of that.
const MOST_BIAS: f64 = 0.6;

/// By how much of that less depths are too small for each unit of the tangent of the angle of incidence.
const LESS_BY_TAN: f64 = 0.7;

/// How much that differs between photos at the ends of their lines (standard deviation, over the roughness): so much
/// where nothing is unseen, and by so much of the bias more, so that 95 % of the lines are held.
const SPREAD: f64 = 0.06;
const SPREAD_OF_BIAS: f64 = 0.6;

/// By how much of the bias the errors of places are wider than those of left-out points, none of which lies in the gaps.
const WIDER: f64 = 1.5;

/// The share of places that lie in a gap without points.
const IN_GAP: f64 = 0.15;

/// By how much of it such gaps are less deep for each unit of the tangent of the angle of incidence.
const GAPS_BY_TAN: f64 = 0.5;

/// By how much of the bias the errors of places beside gaps are wider than those of left-out points.
const WIDER_BESIDE: f64 = 0.75;

/// Into how many bands a photo is divided, from top to bottom, each with a roughness of its own.
const BANDS: usize = 6;

/// How much of a photo's gaps no point lies in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unseen {
    /// How much too small depths are in the mean, over the roughness.
    pub(super) bias: f64,
}

impl Unseen {
    /// Of a photo with these depth errors. Of a surface that came with its faces nothing is unseen: it is what it is.
    pub(super) fn of(errors: &DepthErrors) -> Self {
        let growth = growth(errors).unwrap_or(0.0);
        Self {
            bias: (BIAS_OF_GROWTH * growth).clamp(0.0, MOST_BIAS),
        }
    }

    /// By how much less depths are too small where one looks flatly on the surface, over the roughness: a ray meets the top of a
    /// stone before it sees into the gap behind, and where the tops are cut off it goes on beyond them.
    pub(super) fn of_flat_look(self, tan_of_incidence: f64) -> f64 {
        LESS_BY_TAN * self.bias * tan_of_incidence
    }

    /// By how much the errors of places are wider than those of left-out points.
    pub(super) fn wider(self) -> f64 {
        1.0 + WIDER * self.bias
    }

    /// By how much the errors of places beside gaps are wider than those of left-out points: with [`Self::gap`] behind it.
    pub(super) fn wider_beside(self) -> f64 {
        1.0 + WIDER_BESIDE * self.bias
    }

    /// By how much deeper a drawn place lies than the points around it say, over the roughness: 0 of most.
    pub(super) fn gap(self, tan_of_incidence: f64, draws: &mut Draws) -> f64 {
        let mean = self.bias * (1.0 - GAPS_BY_TAN * tan_of_incidence).max(0.0);
        let is_in_gap = draws.uniform() < IN_GAP;
        let exponential = -(1.0 - draws.uniform()).ln();
        match is_in_gap {
            true => mean / IN_GAP * exponential,
            false => 0.0,
        }
    }

    /// The standard deviation of the bias in the ends of a line, over the roughness.
    pub(super) fn spread(self) -> f64 {
        SPREAD + SPREAD_OF_BIAS * self.bias
    }

    /// By what shares top and bottom of the line are too large in the mean: by what lies in the gaps, less what is cut off the tops.
    pub(super) fn of_line(
        self,
        field: &ScaleField,
        fitted: &FittedScale,
        depths: &[DepthError],
    ) -> [f64; 2] {
        let Some(of_all) = root_mean_square(depths) else {
            return [0.0; 2];
        };
        let height = f64::from(field.camera().height);
        // `as` saturates.
        let band = |down: f64| ((down * BANDS as f64) as usize).min(BANDS - 1);
        let mut bands: [Vec<DepthError>; BANDS] = Default::default();
        for error in depths {
            bands[band(error.pixel.y / height)].push(*error);
        }
        let cut = mean(depths).unwrap_or(0.0);
        let too_near = bands.map(|errors| {
            let roughness = root_mean_square(&errors).unwrap_or(of_all);
            self.bias * roughness + mean(&errors).unwrap_or(cut)
        });
        let mut line = Line::default();
        for (column, row) in field.grid.cells() {
            if let Some(scale) = field.scale_at(column, row) {
                let down = (f64::from(row) + 0.5) / f64::from(field.grid.rows);
                line.add(down, too_near[band(down)] * scale);
            }
        }
        let [top, bottom] = line.ends();
        let shares = [top / fitted.top, bottom / fitted.bottom];
        match shares.iter().all(|share| share.is_finite()) {
            true => shares,
            false => [0.0; 2],
        }
    }
}

/// With which power of the area between points their errors grow: from all of them to the sparser ones. `None` where
/// they are too few, or know of no error.
fn growth(errors: &DepthErrors) -> Option<f64> {
    let [dense, sparse] = [&errors.each, &errors.sparser];
    // Point by point: what takes much of a photo grows no more.
    let of = |errors: &[DepthError]| {
        let errors = without_flying(errors);
        let squares: f64 = errors.iter().map(|error| error.relative.powi(2)).sum();
        let of = (squares / errors.len() as f64).sqrt();
        (errors.len() >= LEAST_POINTS && of > 0.0).then_some(of)
    };
    let times = (dense.len() * SHIFTED.len()) as f64 / sparse.len() as f64;
    Some((of(sparse)? / of(dense)?).ln() / times.ln()).filter(|growth| growth.is_finite())
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::camera::Distortion;
    use crate::jobs::Progress;
    use crate::scale::Draws;
    use crate::scale::ImageKind;
    use crate::scale::field::FieldGrid;
    use crate::scale::uncertainty::LEAST_POINTS;
    use crate::scale::uncertainty::tests::{camera, nadir};
    use crate::surface::{Cloud, Surface};

    /// So many normal errors of that standard deviation.
    fn errors(count: usize, deviation: f64) -> Vec<DepthError> {
        let mut draws = Draws::new(5);
        let errors = (0..count).map(|_| DepthError {
            pixel: DVec2::ZERO,
            relative: deviation * draws.normal(),
            area: 1.0,
        });
        errors.collect()
    }

    /// Four choices of a quarter of the points each, whose errors are those of four times the area.
    fn grown(count: usize, power: f64) -> DepthErrors {
        DepthErrors {
            each: errors(count, 0.01),
            sparser: errors(count, 0.01 * 4.0_f64.powf(power)),
            ..DepthErrors::default()
        }
    }

    /// One in seven places lies in a gap, the mean of all is the bias, less by half for each unit of the tangent.
    #[test]
    fn gaps_are_seldom_and_deep() {
        let unseen = Unseen { bias: 0.4 };
        for (tan, mean) in [(0.0, 0.4), (1.0, 0.2), (3.0, 0.0)] {
            let mut draws = Draws::new(3);
            let drawn: Vec<f64> = (0..100_000).map(|_| unseen.gap(tan, &mut draws)).collect();
            let count = drawn.len() as f64;
            let found = drawn.iter().sum::<f64>() / count;
            // An exponential one of one in seven has a deviation of 3.5 times its mean.
            assert!((found - mean).abs() <= 0.05 * mean, "{found}");
            let deep = drawn.iter().filter(|gap| **gap > 0.0).count() as f64 / count;
            let share = if mean > 0.0 { 0.15 } else { 0.0 };
            assert!((deep - share).abs() < 0.005, "{deep}");
            assert!(drawn.iter().all(|gap| *gap >= 0.0 && gap.is_finite()));
        }
    }

    #[test]
    fn the_bias_goes_with_the_power_of_the_area() {
        for power in [0.05, 0.1, 0.2] {
            // The same draws, so that the power is there to rounding.
            let found = Unseen::of(&grown(400, power)).bias;
            assert!((found - BIAS_OF_GROWTH * power).abs() < 1e-9, "{found}");
        }
        assert_eq!(Unseen::of(&grown(400, 1.0)).bias, MOST_BIAS);
        // Noise does not grow, and what shrinks hides nothing either.
        for power in [0.0, -0.3] {
            assert!(Unseen::of(&grown(400, power)).bias < 1e-9);
        }
    }

    #[test]
    fn who_knows_of_no_error_says_of_none() {
        // A mesh has no sparser ones, few points tell nothing, and a plane has no errors.
        let mesh = DepthErrors {
            sparser: Vec::new(),
            ..grown(400, 0.2)
        };
        for errors in [mesh, grown(LEAST_POINTS - 1, 0.2), DepthErrors::default()] {
            assert_eq!(Unseen::of(&errors).bias, 0.0);
        }
        let plane = DepthErrors {
            each: errors(400, 0.0),
            sparser: errors(400, 0.0),
            ..DepthErrors::default()
        };
        assert_eq!(Unseen::of(&plane).bias, 0.0);
    }

    #[test]
    fn who_looks_flatly_sees_less_of_the_gaps() {
        let unseen = Unseen { bias: 0.5 };
        assert_eq!(unseen.of_flat_look(0.0), 0.0);
        // At 55 degrees all of it, beyond that the tops are what counts.
        assert!((unseen.of_flat_look(1.0 / 0.7) - 0.5).abs() < 1e-12);
        assert_eq!(Unseen { bias: 0.0 }.of_flat_look(2.0), 0.0);
    }

    /// Points that stick out by 1 % of the depth cut scales by as much; gaps of half the roughness take half of it back.
    #[test]
    fn what_is_cut_off_the_tops_makes_scales_too_small() {
        let plane = Surface::new(Cloud {
            points: [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]
                .map(|(x, y)| DVec3::new(x, y, 0.0))
                .to_vec(),
            ..Cloud::default()
        })
        .unwrap();
        let (camera, pose) = (camera(Distortion::None), nadir(10.0));
        let (grid, image) = (FieldGrid::of_fit(&camera), ImageKind::Undistorted);
        let progress = Progress::default();
        let field = ScaleField::compute(&camera, &pose, image, grid, &plane, &progress).unwrap();
        let fitted = FittedScale::of(&field).unwrap();
        let above = vec![
            DepthError {
                pixel: DVec2::new(640.0, 360.0),
                relative: -0.01,
                area: 1.0,
            };
            LEAST_POINTS
        ];
        for (bias, wanted) in [(0.0, -0.01), (0.5, -0.005)] {
            let found = Unseen { bias }.of_line(&field, &fitted, &above);
            assert!(
                found.iter().all(|share| (share - wanted).abs() < 1e-12),
                "{found:?}"
            );
        }
    }
}
