//! Percent error of the passing at each size.

use super::method_curve::{MeanPoint, is_between_points, mean_at};
use crate::SizeDistribution;

/// What a percent error is, for headers and notes of outputs.
pub const PERCENT_ERROR: &str = "percent error = 100 (P - P reference) / P reference of the percent passing; above 0 \
     the method says that more passes (finer) than the reference; undefined where the reference is 0";

/// How far off a method is at one size of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PercentError {
    /// In the set's unit.
    pub size: f64,
    /// Mean percent passing of the reference.
    pub reference: f64,
    /// Mean percent passing of the method, between its points linear in the logarithm of the size;
    /// `None` where no trial is known.
    pub passing: Option<f64>,
    /// Whether `passing` is not measured there, of every trial or of some, but taken from the sizes
    /// beside it.
    pub interpolated: bool,
    /// `passing` less `reference`, percentage points.
    pub difference: Option<f64>,
    /// See [`PERCENT_ERROR`]; `None` where the reference is 0 or the method unknown.
    pub percent_error: Option<f64>,
    /// Whether the percent error is within the envelope's percent (30), either side.
    pub within: Option<bool>,
}

impl PercentError {
    /// Of a method's trials at a point of the reference.
    pub(super) fn new(
        reference: &MeanPoint,
        trials: &[&SizeDistribution],
        envelope_percent: f64,
    ) -> Self {
        let passing = mean_at(trials, reference.size).map(|point| point.mean);
        let difference = passing.map(|passing| passing - reference.mean);
        let percent_error = difference
            .filter(|_| reference.mean > 0.0)
            .map(|difference| 100.0 * difference / reference.mean);
        Self {
            size: reference.size,
            reference: reference.mean,
            passing,
            interpolated: is_between_points(trials, reference.size),
            difference,
            percent_error,
            within: percent_error.map(|error| error.abs() <= envelope_percent),
        }
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    /// 15 for 10 is 50 % more; 36 for 40, 10 % less; of 0 there is no percentage.
    #[test]
    fn finer_is_above_zero() {
        let method = [[1.0, 2.0], [10.0, 15.0], [100.0, 36.0]];
        let method = SizeDistribution::new(method.to_vec()).expect("a distribution");
        let at = |size, mean| {
            let reference = MeanPoint {
                size,
                mean,
                standard_deviation: None,
                trials: 1,
            };
            PercentError::new(&reference, &[&method], 30.0)
        };
        assert_eq!(at(10.0, 10.0).percent_error, Some(50.0));
        assert_eq!(at(10.0, 10.0).within, Some(false));
        assert_eq!(at(100.0, 40.0).percent_error, Some(-10.0));
        assert_eq!(at(100.0, 40.0).within, Some(true));
        assert!(!at(10.0, 10.0).interpolated && !at(100.0, 40.0).interpolated);
        let none = at(1.0, 0.0);
        assert_eq!((none.difference, none.percent_error), (Some(2.0), None));
        assert_eq!(none.within, None);
        assert_eq!(at(200.0, 50.0).passing, None);
        assert_eq!(at(200.0, 50.0).percent_error, None);
        assert!(!at(200.0, 50.0).interpolated);
    }

    /// Of 40 % at 10 and 50 % at 20 mm, 45 % at the size in their middle on a logarithmic axis: nobody measured it.
    #[test]
    fn what_was_not_measured_is_known() {
        let method = SizeDistribution::new(vec![[10.0, 40.0], [20.0, 50.0]]).expect("points");
        let reference = MeanPoint {
            size: 200.0_f64.sqrt(),
            mean: 45.0,
            standard_deviation: None,
            trials: 1,
        };
        let found = PercentError::new(&reference, &[&method], 30.0);
        assert!((found.passing.expect("known") - 45.0).abs() < 1e-9);
        assert!(found.interpolated);
    }
}
