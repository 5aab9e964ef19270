//! What lies unseen between fragments: how much of it a photo has, by what its cloud shows.
//!
//! A place has points where at least three photos look. Where many look, hardly a gap between fragments goes
//! unseen; where few do (low over a bench, at the rim of a flight) only the tops have points. The surface
//! then runs from top to top, too near, and the points, tops all of them, predict each other better than the surface
//! is true. No single point tells that, but together they do: on tops that lie close one point says much
//! of the next, across a gap it says little, so that errors of left-out points grow with the area between
//! their neighbours. Seen by many, errors grow with the 0.17th power of that area (standard deviation over photos
//! 0.05, in all places); on piles flown at 0.58 of their height, where a third as many photos look at a place, with
//! the 0.34th (0.06), depths are short by 0.45 of the roughness instead of 0.1, and off that 1.6 times as far as
//! left-out points. Between [`MANY`] and [`FEW`] nobody knows which it is, and the share runs from 0 to 1. Points
//! without relief have no errors that grow; a smooth bend has, but its roughness is next to nothing.
//!
//! Constants: by likelihood (Student's t of 4 degrees, so that no photo decides alone) of the lines of 198 photos of
//! simulated flights (seeds from 1005 on of the lab, 2005, 3005 and 4005 of the others) and of 42 of muckpiles and
//! stockpiles flown at 0.58 and 0.78 of their height (2105 to 2108, 3105 and 3106, without the middle row of photos).
//! Without the benches, where most depends on it, [`LINE_BIAS`] comes out as 0.048 and [`LINE_BIAS_OF_FEW`] as 0.185.
//! Those of single places follow from what is said above of low flights: of 1000 pairs of places in the lowest ones'
//! photos intervals then held 93 % instead of 84 %, of 2400 on the benches, which had no part in it, 96 % instead of
//! 92 %. The power hangs on how much was seen and not on how many points there are: of a muckpile with 15 000 or 200 000
//! points instead of 60 000 it is 0.18 and 0.12, and the bias that of places that many saw. README's coverage is of
//! other piles.

use glam::DVec2;

use super::holes::Line;
use super::surface_error::{DepthError, LEAST_POINTS, root_mean_square};
use crate::scale::FittedScale;
use crate::scale::field::ScaleField;

/// Errors that grow with this power of the area are those of places that many photos saw.
const MANY: f64 = 0.2;

/// The same of those that few saw.
const FEW: f64 = 0.3;

/// How much too small depths are in the mean, over the root mean square of the depth errors at the points
/// around: the gaps that no point lies in. By many photos, and by how much more by few.
const BIAS: f64 = 0.06;
const BIAS_OF_FEW: f64 = 0.3;

/// By how much errors are larger than those of left-out points, where few photos saw.
const WIDER_OF_FEW: f64 = 0.5;

/// As [`BIAS`], in the line through all of a photo, bridges not counted.
const LINE_BIAS: f64 = 0.045;
const LINE_BIAS_OF_FEW: f64 = 0.19;

/// Into how many bands a photo is divided, from top to bottom, each with a roughness of its own.
const BANDS: usize = 6;

/// No error counts as larger than this share of the depth: it is of a point that flies.
const MOST: f64 = 0.15;

/// Smaller errors are rounding.
const LEAST: f64 = 1e-4;

/// How much of a photo's gaps few photos saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unseen {
    /// From 0 (many saw them) to 1.
    few: f64,
}

impl Unseen {
    /// Of a photo with these depth errors. Of a surface that came with its faces nothing is unseen.
    pub(super) fn of(depths: &[DepthError], is_cloud: bool) -> Self {
        let growth = match is_cloud && depths.len() >= LEAST_POINTS {
            true => growth(depths),
            false => 0.0,
        };
        Self {
            few: ((growth - MANY) / (FEW - MANY)).clamp(0.0, 1.0),
        }
    }

    /// How far places are off, over the errors of the left-out points around.
    pub(super) fn wider(self) -> f64 {
        1.0 + WIDER_OF_FEW * self.few
    }

    /// How much too small depths are in the mean, over the roughness.
    pub(super) fn bias(self) -> f64 {
        BIAS + BIAS_OF_FEW * self.few
    }

    /// By what shares top and bottom of the line are too large in the mean.
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
        let roughness = bands.map(|errors| root_mean_square(&errors).unwrap_or(of_all));
        let bias = LINE_BIAS + LINE_BIAS_OF_FEW * self.few;
        let mut line = Line::default();
        for (column, row) in field.grid.cells() {
            if let Some(scale) = field.scale_at(column, row) {
                let down = (f64::from(row) + 0.5) / f64::from(field.grid.rows);
                line.add(down, bias * roughness[band(down)] * scale);
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

/// With which power of the area between their neighbours errors grow: the slope of a least squares line through
/// their logarithms; 0 where all areas are alike.
fn growth(depths: &[DepthError]) -> f64 {
    let logarithms = depths.iter().map(|error| {
        let size = error.relative.abs().min(MOST) + LEAST;
        DVec2::new(error.area.ln(), size.ln())
    });
    let logarithms: Vec<DVec2> = logarithms.filter(|both| both.is_finite()).collect();
    let count = logarithms.len().max(1) as f64;
    let mean = logarithms.iter().sum::<DVec2>() / count;
    let (mut squares, mut products) = (0.0, 0.0);
    for both in &logarithms {
        let off = *both - mean;
        squares += off.x * off.x;
        products += off.x * off.y;
    }
    // Areas that are equal to a thousandth are equal.
    match squares > 1e-6 * count {
        true => products / squares,
        false => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::Draws;

    /// Errors s·a^power over areas a of 1 to e³, s normal: the slope is the power, known to about
    /// 1.1 / (0.87 √n) (1.1 is the deviation of ln |s|, 0.87 that of ln a).
    fn errors(power: f64) -> Vec<DepthError> {
        let mut draws = Draws::new(5);
        (0..4000)
            .map(|index| {
                let logarithm = 3.0 * f64::from(index) / 4000.0;
                DepthError {
                    pixel: DVec2::ZERO,
                    relative: 0.01 * draws.normal() * (power * logarithm).exp(),
                    area: logarithm.exp(),
                }
            })
            .collect()
    }

    #[test]
    fn growth_is_the_power_of_the_area() {
        for power in [0.0, 0.17, 0.33] {
            let found = growth(&errors(power));
            assert!((found - power).abs() < 0.05, "{power}: {found}");
        }
        let many = Unseen::of(&errors(0.1), true);
        assert_eq!((many.wider(), many.bias()), (1.0, BIAS));
        let few = Unseen::of(&errors(0.4), true);
        assert_eq!(few.wider(), 1.0 + WIDER_OF_FEW);
        assert!(few.bias() > many.bias());
        // A mesh is what it is, and few points tell nothing.
        assert_eq!(Unseen::of(&errors(0.4), false), many);
        assert_eq!(Unseen::of(&errors(0.4)[..LEAST_POINTS - 1], true), many);
    }

    #[test]
    fn without_spread_nothing_grows() {
        let mut level = errors(0.3);
        for error in &mut level {
            error.area = 2.0;
        }
        assert_eq!(growth(&level), 0.0);
        assert_eq!(growth(&[]), 0.0);
    }
}
