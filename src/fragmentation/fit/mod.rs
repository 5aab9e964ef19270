//! Fits a function to a measured size distribution by least squares.
//!
//! The residuals are percentage points. The least sum of their squares over all parameters within
//! their bounds is searched from many starts, the same every time:
//!
//! - xmax of Swebrec and its extension is not below the largest size that not everything passed: some
//!   rock was left on that sieve. It is at most 1e100 times as large. That of
//!   Gates-Gaudin-Schuhmann is where a straight line reaches 100 %, and may lie lower.
//! - 0 <= a <= 1.
//! - c, n, m and the slope of Swebrec at x50, b / ln(xmax / x50), are from 0.001 to 1000.
//!
//! ```text
//! points          checks, weights, logarithms
//! coordinates     what the search runs in: bounds, an optimum
//! family          each function in coordinates of its own: swebrec, rosin_rammler,
//!                 gates_gaudin_schuhmann
//! search          Levenberg-Marquardt within bounds, from many starts
//! uncertainty     covariance, Student's t
//! notes           what to know before trusting a fit
//! ```

mod coordinates;
mod family;
mod gates_gaudin_schuhmann;
mod notes;
mod points;
mod rosin_rammler;
mod search;
mod swebrec;
#[cfg(test)]
mod tests;
mod uncertainty;

use family::Family;
use points::Points;
use uncertainty::Uncertainty;

use super::{Curve, Model, SizeDistribution};
use crate::fault::Fault;

/// What Split-Desktop calls the topsize: the size that this percent passes. Unlike the largest size
/// it is there for every function.
pub const TOPSIZE_PERCENT: f64 = 99.95;

/// How to fit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitOptions {
    /// The weight of each point's squared residual, in the order of the distribution's points; without
    /// them all count 1. What is fitted, and how well it is known, follows from their ratios alone. A
    /// point with a weight of 0 is not used.
    pub weights: Option<Vec<f64>>,
    /// A largest size that is known and not to be fitted; in the distribution's unit.
    pub xmax: Option<f64>,
}

/// A parameter of a fitted function.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedParameter {
    /// As in `Model::parameter_names`.
    pub name: &'static str,
    /// Sizes in the distribution's unit.
    pub value: f64,
    /// `None` where it was given, lies at a bound, or no point is left over to learn it from. Where
    /// another parameter lies at its bound, that one is taken for certain.
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
    /// Sum of the squared residuals, each times its weight as given; percentage points squared.
    pub residual_sum_of_squares: f64,
    /// Root of the (weighted) mean squared residual: sqrt(residual sum of squares / sum of weights),
    /// which without weights is the number of points; percentage points.
    pub rmse: f64,
    /// 1 - residual sum of squares / (weighted) sum of squares about the (weighted) mean.
    pub r_squared: f64,
    /// Points (with a weight above 0) less fitted parameters; a parameter that ended at its bound was
    /// fitted, one that was given was not.
    pub degrees_of_freedom: usize,
    /// What to know before trusting it, one sentence each: a parameter at its bound, two optima.
    pub notes: Vec<String>,
    uncertainty: Option<Uncertainty>,
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
    /// The size that `percent` passes, with its band at a confidence of `level` (0.95). The band is by
    /// the delta method on the size's logarithm, with Student's t; there is none at 0 and 100 %.
    pub fn percentile(&self, percent: f64, level: f64) -> Percentile {
        let size = self.curve.size_at(percent);
        Percentile {
            percent,
            size,
            band: self.band_of_size(size, level),
        }
    }

    fn band_of_size(&self, size: f64, level: f64) -> Option<[f64; 2]> {
        let uncertainty = self.uncertainty.as_ref()?;
        let reach = uncertainty.reach(level)?;
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let (error, slope) = uncertainty.at_size(size.ln());
        // d ln x = -dP / (dP / d ln x) at a fixed percent.
        let ratio = (reach * error / slope).exp();
        let band = [size / ratio, size * ratio];
        (slope > 0.0 && band[0] > 0.0 && band[1].is_finite()).then_some(band)
    }

    /// The confidence band [low, high] of the fitted percent passing at a size, at a confidence of
    /// `level`: by the delta method with Student's t, cut to 0 to 100. It is of the curve, at each
    /// size for itself; measured points scatter about it more widely.
    pub fn band_at(&self, size: f64, level: f64) -> Option<[f64; 2]> {
        let uncertainty = self.uncertainty.as_ref()?;
        let reach = uncertainty.reach(level)?;
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let half = 100.0 * reach * uncertainty.at_size(size.ln()).0;
        let percent = self.curve.percent_passing(size);
        let band = [percent - half, percent + half].map(|end| end.clamp(0.0, 100.0));
        half.is_finite().then_some(band)
    }

    /// What Split-Desktop calls the topsize, P99.95.
    pub fn topsize(&self, level: f64) -> Percentile {
        self.percentile(TOPSIZE_PERCENT, level)
    }

    /// The coefficient of uniformity, P60 / P10.
    pub fn uniformity(&self) -> f64 {
        self.curve.size_at(60.0) / self.curve.size_at(10.0)
    }

    /// The coefficient of curvature, P30^2 / (P10 P60).
    pub fn curvature(&self) -> f64 {
        let [p10, p30, p60] = [10.0, 30.0, 60.0].map(|percent| self.curve.size_at(percent));
        (p30 / p10) * (p30 / p60)
    }
}

/// Fits a family of functions to a distribution.
///
/// # Errors
///
/// Fewer points than parameters; points of which none lies between 0 and 100 %, or that do not rise;
/// weights or an xmax that do not fit the points.
pub fn fit(
    distribution: &SizeDistribution,
    model: Model,
    options: &FitOptions,
) -> Result<Fit, Fault> {
    let points = Points::new(distribution, model, options)?;
    let family = Family::new(model, &points, options.xmax);
    let optima = search::optima(&family, &points);
    let curves = optima
        .iter()
        .filter_map(|optimum| Some((optimum, family.curve(&optimum.at)?)));
    let curves: Vec<_> = curves.collect();
    let Some(&(best, curve)) = curves.first() else {
        let what = format!("no {} comes near these points", model.name());
        return Err(Fault::new(what, "choose another function"));
    };
    let names = model.parameter_names();
    let fitted = names.len() - usize::from(options.xmax.is_some());
    // As many points as parameters at least: Points holds that.
    let degrees_of_freedom = points.points.len() - fitted;
    let free = notes::free(&family, best);
    let uncertainty = Uncertainty::new(
        family,
        &points,
        best.at,
        &free,
        best.sum,
        degrees_of_freedom,
    );
    let gradients = family.parameter_gradients(&best.at);
    let parameters: Vec<FittedParameter> = names
        .iter()
        .zip(curve.parameters())
        .enumerate()
        .map(|(index, (name, value))| FittedParameter {
            name,
            value,
            standard_error: uncertainty
                .as_ref()
                .filter(|_| free.contains(&index))
                .map(|uncertainty| uncertainty.of(&gradients[index]))
                .filter(|error| error.is_finite()),
        })
        .collect();
    let measured = distribution.points();
    let weight = |index: usize| {
        let weights = options.weights.as_ref();
        weights.map_or(1.0, |weights| weights[index])
    };
    let total: f64 = (0..measured.len()).map(weight).sum();
    let weighted = |value: &dyn Fn(usize, &[f64; 2]) -> f64| -> f64 {
        let terms = measured.iter().enumerate();
        terms.map(|(i, point)| weight(i) * value(i, point)).sum()
    };
    let residuals: Vec<f64> = measured
        .iter()
        .map(|&[size, percent]| percent - curve.percent_passing(size))
        .collect();
    let sum = weighted(&|index, _| residuals[index] * residuals[index]);
    let mean = weighted(&|_, point| point[1]) / total;
    let about_mean = weighted(&|_, point| (point[1] - mean) * (point[1] - mean));
    let others: Vec<_> = curves.iter().skip(1).map(|(o, c)| (o.sum, *c)).collect();
    let notes = notes::notes(&notes::Told {
        family: &family,
        best,
        points: &points,
        options,
        parameters: &parameters,
        others: &others,
        degrees_of_freedom,
        known: uncertainty.is_some(),
    });
    Ok(Fit {
        model,
        curve,
        parameters,
        residuals,
        residual_sum_of_squares: sum,
        rmse: (sum / total).sqrt(),
        r_squared: 1.0 - sum / about_mean,
        degrees_of_freedom,
        notes,
        uncertainty,
    })
}
