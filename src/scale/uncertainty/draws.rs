//! Draws of errors, and the interval that holds 95 % of them.

use glam::DVec3;
use statrs::distribution::{ContinuousCDF, Normal};

use super::Interval;
use crate::split_mix::SplitMix;

/// Normal and uniform numbers from a seed.
#[derive(Debug, Clone)]
pub struct Draws {
    bits: SplitMix,
    /// The second of two normal numbers.
    spare: Option<f64>,
}

impl Draws {
    /// The same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self {
            bits: SplitMix(seed),
            spare: None,
        }
    }

    /// Between 0 and 1, neither of them.
    pub(super) fn uniform(&mut self) -> f64 {
        ((self.bits.next() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// One of `count` places, each as likely.
    pub fn place(&mut self, count: usize) -> usize {
        // `as` cuts; the product is under `count`.
        (self.uniform() * count as f64) as usize
    }

    /// Normal, of the standard deviation 1: Box and Muller's pairs.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// Three of them.
    pub fn normals(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal())
    }
}

/// The share of draws that an interval holds.
const HELD: f64 = 0.95;

/// The tails, on either side, of which the outermost do not count for a standard deviation: a point that flies above the
/// pile would make it say nothing of the other draws.
const TAIL: f64 = 0.005;

/// How many times as far from the middle as where a tail begins draws count: of normal ones that is 3.9 standard deviations, beyond
/// which lies one of ten thousand.
const FAR: f64 = 1.5;

/// The standard deviation and the interval of draws of a quantity, and what was estimated of it.
///
/// The interval leaves out as much on either side. Where the draws lie mostly on one side of the
/// estimate it begins there: an interval without its estimate would be of no use to anybody.
pub(super) fn interval_of(mut draws: Vec<f64>, estimate: f64) -> Interval {
    draws.sort_unstable_by(f64::total_cmp);
    let count = draws.len() as f64;
    let quantile = |share: f64| {
        let place = (share * count - 0.5).clamp(0.0, count - 1.0);
        let (below, part) = (place.floor() as usize, place.fract());
        let above = (below + 1).min(draws.len() - 1);
        draws[below] + (draws[above] - draws[below]) * part
    };
    let below = draws.partition_point(|&draw| draw < estimate) as f64 / count;
    let (low, high) = ends(below);
    Interval {
        standard_error: deviation(&draws),
        low: quantile(low).min(estimate),
        high: quantile(high).max(estimate),
    }
}

/// [`normal_interval`] of a scale: none is below zero, whatever a normal distribution says of it.
pub(super) fn interval_of_scale(mean: f64, deviation: f64, scale: f64) -> Interval {
    let interval = normal_interval(mean, deviation, scale);
    Interval {
        low: interval.low.max(0.0).min(scale),
        ..interval
    }
}

/// The same of a normal quantity.
fn normal_interval(mean: f64, deviation: f64, estimate: f64) -> Interval {
    let Ok(normal) = Normal::new(mean, deviation) else {
        return Interval {
            standard_error: 0.0,
            low: estimate,
            high: estimate,
        };
    };
    let (low, high) = ends(normal.cdf(estimate));
    // Where all of the distribution lies on one side of the estimate, to rounding, its end there is none.
    let at = |share: f64| {
        let end = normal.inverse_cdf(share);
        if end.is_finite() { end } else { estimate }
    };
    Interval {
        standard_error: deviation,
        low: at(low).min(estimate),
        high: at(high).max(estimate),
    }
}

/// The shares below the two ends of the interval, where this share lies below the estimate.
fn ends(below: f64) -> (f64, f64) {
    let out = (1.0 - HELD) / 2.0;
    if below < out {
        (below, below + HELD)
    } else if below > 1.0 - out {
        (below - HELD, below)
    } else {
        (out, 1.0 - out)
    }
}

/// The standard deviation of sorted draws, those far out in the tails moved nearer; 0 of none.
pub(super) fn deviation(sorted: &[f64]) -> f64 {
    let cut = (sorted.len() as f64 * TAIL) as usize;
    let (Some(&low), Some(&middle), Some(&high)) = (
        sorted.get(cut),
        sorted.get(sorted.len() / 2),
        sorted.get(sorted.len().wrapping_sub(cut + 1)),
    ) else {
        return 0.0;
    };
    let (low, high) = (
        middle + FAR * (low - middle),
        middle + FAR * (high - middle),
    );
    let count = sorted.len() as f64;
    let mean = sorted.iter().map(|x| x.clamp(low, high)).sum::<f64>() / count;
    let squares: f64 = sorted
        .iter()
        .map(|x| (x.clamp(low, high) - mean).powi(2))
        .sum();
    (squares / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 100 000 normal draws: moments, and the interval of tables, ± 1.959964.
    #[test]
    fn draws_are_normal() {
        let mut draws = Draws::new(1);
        let drawn: Vec<f64> = (0..100_000).map(|_| draws.normal()).collect();
        let mean = drawn.iter().sum::<f64>() / 1e5;
        let fourth = drawn.iter().map(|x| x.powi(4)).sum::<f64>() / 1e5;
        assert!(mean.abs() < 0.012, "{mean}");
        assert!((fourth - 3.0).abs() < 0.12, "{fourth}");
        let interval = interval_of(drawn, 0.0);
        assert!((interval.standard_error - 1.0).abs() < 0.02);
        assert!((interval.low + 1.96).abs() < 0.025, "{interval:?}");
        assert!((interval.high - 1.96).abs() < 0.025, "{interval:?}");
        let exact = normal_interval(5.0, 2.0, 5.5);
        assert!((exact.low - (5.0 - 2.0 * 1.959_963_985)).abs() < 1e-6);
        assert!((exact.high - (5.0 + 2.0 * 1.959_963_985)).abs() < 1e-6);
    }

    /// Of a quantity that lies below its estimate: from the 5 % quantile, -1.644854, to the estimate.
    #[test]
    fn the_estimate_is_in_the_interval() {
        let far = normal_interval(0.0, 1.0, 6.0);
        assert_eq!(far.high, 6.0);
        assert!((far.low + 1.644_854).abs() < 1e-4, "{far:?}");
        // Beyond what rounding tells from certainty.
        for estimate in [40.0, -40.0] {
            let far = normal_interval(0.0, 1.0, estimate);
            let other = if estimate > 0.0 { far.low } else { far.high };
            assert!((other.abs() - 1.644_854).abs() < 1e-4, "{far:?}");
            assert!(far.low == estimate || far.high == estimate, "{far:?}");
        }
        let drawn: Vec<f64> = (0..1000).map(f64::from).collect();
        let interval = interval_of(drawn.clone(), -5.0);
        assert_eq!(interval.low, -5.0);
        assert!((interval.high - 949.5).abs() < 1e-9, "{interval:?}");
        let interval = interval_of(drawn, 990.0);
        assert_eq!(interval.high, 990.0);
        assert!((interval.low - 39.5).abs() < 1e-9, "{interval:?}");
        let sure = normal_interval(1.0, 0.0, 3.0);
        assert_eq!((sure.low, sure.high), (3.0, 3.0));
    }

    /// Uniform on 1..1000: 288.67, whatever one outlier in a thousand does.
    #[test]
    fn one_outlier_does_not_count() {
        let mut drawn: Vec<f64> = (1..=1000).map(f64::from).collect();
        drawn[999] = 1e9;
        assert!((deviation(&drawn) - 288.67).abs() < 2.0);
        assert_eq!(deviation(&[]), 0.0);
        assert_eq!(deviation(&[3.0]), 0.0);
    }
}
