//! Fits a function to a measured size distribution by least squares.

use super::{Curve, Model, SizeDistribution};
use crate::fault::Fault;

/// How to fit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitOptions {
    /// The weight of each point's squared residual, in the order of the distribution's points; without
    /// them all count the same. Only their ratios matter.
    pub weights: Option<Vec<f64>>,
    /// A largest size that is known and not to be fitted.
    pub xmax: Option<f64>,
}

/// A parameter of a fitted function.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedParameter {
    /// As in `Model::parameter_names`.
    pub name: &'static str,
    /// Sizes in the distribution's unit.
    pub value: f64,
    /// `None` where it was given, lies at a bound, or no point is left over to learn it from.
    pub standard_error: Option<f64>,
}

/// A function fitted to a distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The family.
    pub model: Model,
    /// The function with the least weighted sum of squared residuals.
    pub curve: Curve,
    /// Its parameters.
    pub parameters: Vec<FittedParameter>,
    /// Measured less fitted, percentage points, in the order of the distribution's points.
    pub residuals: Vec<f64>,
    /// Weighted sum of the squared residuals, percentage points squared.
    pub residual_sum_of_squares: f64,
    /// Root of the mean squared residual: sqrt(residual sum of squares / number of points), with equal
    /// weights; percentage points.
    pub rmse: f64,
    /// 1 - residual sum of squares / sum of squares about the mean.
    pub r_squared: f64,
    /// Points less fitted parameters.
    pub degrees_of_freedom: usize,
    /// What to know before trusting it, one sentence each: a parameter at its bound, two optima.
    pub notes: Vec<String>,
}

/// A size that a percent passes, by a fitted function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Percentile {
    /// Percent passing.
    pub percent: f64,
    /// In the distribution's unit.
    pub size: f64,
    /// Confidence band [low, high], where standard errors are known.
    pub band: Option<[f64; 2]>,
}

impl Fit {
    /// The size that `percent` passes, with its band at a confidence of `level` (0.95).
    pub fn percentile(&self, percent: f64, level: f64) -> Percentile {
        let _ = level;
        Percentile {
            percent,
            size: self.curve.size_at(percent),
            band: None,
        }
    }

    /// The confidence band [low, high] of the percent passing at a size, at a confidence of `level`.
    pub fn band_at(&self, size: f64, level: f64) -> Option<[f64; 2]> {
        let _ = (size, level);
        None
    }
}

/// Fits a family of functions to a distribution.
///
/// # Errors
///
/// Fewer points than parameters; weights that do not fit; no convergence.
pub fn fit(
    distribution: &SizeDistribution,
    model: Model,
    options: &FitOptions,
) -> Result<Fit, Fault> {
    let _ = (distribution, model, options);
    Err(Fault::new("nothing is fitted yet", "wait"))
}
