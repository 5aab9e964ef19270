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
//! quality         how far the points that say something lie from the function
//! uncertainty     covariance, Student's t
//! repeats         the same of a mean of photos, by leaving one after another out
//! notes           what to know before trusting a fit
//! ```

mod coordinates;
mod family;
mod gates_gaudin_schuhmann;
mod notes;
mod points;
mod quality;
mod repeats;
mod rosin_rammler;
mod search;
mod swebrec;
#[cfg(test)]
mod tests;
mod uncertainty;

use family::Family;
use points::Points;
use quality::Quality;
use repeats::Repeats;
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

/// Parameters whose values mean nothing, though the function with them fits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotDetermined {
    /// Their names.
    pub parameters: Vec<&'static str>,
    /// Why, in a sentence, which is one of the fit's notes, too.
    pub why: String,
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
    /// Root of the (weighted) mean squared residual of the points that say something of the parameters (`telling_points`); percentage
    /// points. What lies at 100 % by itself would make every fit look better that has more of it.
    pub rmse: f64,
    /// 1 - residual sum of squares / (weighted) sum of squares about the (weighted) mean, of the same points; of all where one percent
    /// passes all of these.
    pub r_squared: f64,
    /// How many points (with a weight above 0) say something of the parameters: not those that do not count in `degrees_of_freedom`.
    pub telling_points: usize,
    /// Points (with a weight above 0) less fitted parameters, 0 where there are fewer; a parameter that
    /// ended at its bound was fitted, one that was given was not. Points do not count that everything
    /// passed and of which the function says so whatever its parameters are: those at and above xmax.
    pub degrees_of_freedom: usize,
    /// What to know before trusting it, one sentence each: a parameter at its bound, two optima.
    pub notes: Vec<String>,
    /// Which of its parameters' values are not to be shown to people.
    pub not_determined: Vec<NotDetermined>,
    /// The points [size, percent passing] that it was fitted to, sizes ascending.
    fitted_to: Vec<[f64; 2]>,
    known: Known,
}

/// What confidence bands rest on.
#[derive(Debug, Clone, PartialEq)]
enum Known {
    /// Nothing: there is none.
    Nothing,
    /// How far the points, measured one by one, lie about the function.
    Scatter(Box<Uncertainty>),
    /// How far photos or trials differ.
    Repeats(Repeats),
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
    /// How many of the points that it was fitted to say nothing of the parameters.
    pub fn silent_points(&self) -> usize {
        self.fitted_to.len().saturating_sub(self.telling_points)
    }

    /// Whether the value of the parameter of this name means anything.
    pub fn determines(&self, parameter: &str) -> bool {
        let mut unknown = self.not_determined.iter().flat_map(|of| &of.parameters);
        unknown.all(|name| *name != parameter)
    }

    /// The size that `percent` passes, with its band at a confidence of `level` (0.95). The band is by
    /// the delta method on the size's logarithm, with Student's t; there is none at 0 and 100 %. Its
    /// lower end does not lie below a measured size that less passed, for sure (`surely_above`).
    pub fn percentile(&self, percent: f64, level: f64) -> Percentile {
        let size = self.curve.size_at(percent);
        Percentile {
            percent,
            size,
            band: self.band_of_size(percent, size, level),
        }
    }

    fn band_of_size(&self, percent: f64, size: f64, level: f64) -> Option<[f64; 2]> {
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let reach = match &self.known {
            Known::Nothing => return None,
            Known::Scatter(scatter) => {
                let (error, slope) = scatter.at_size(size.ln());
                // d ln x = -dP / (dP / d ln x) at a fixed percent.
                (slope > 0.0).then_some(scatter.reach(level)? * error / slope)?
            }
            Known::Repeats(repeats) => repeats.reach(level, |curve| curve.size_at(percent).ln())?,
        };
        let least = self.surely_above(percent, level).unwrap_or(0.0);
        let band = [(size / reach.exp()).max(least), size * reach.exp()];
        (band[0] > 0.0 && band[1].is_finite()).then_some(band)
    }

    /// The largest measured size that less than `percent` passed, by the measurement and by all of the
    /// function's band there: what `percent` passes is larger. Far beyond the points (the topsize) the
    /// logarithm of a size is no straight line in the parameters, and the delta method's band of it
    /// reaches back to sizes that a tenth of the rock was left on. That of the percents, at the points
    /// themselves, is nearly straight.
    fn surely_above(&self, percent: f64, level: f64) -> Option<f64> {
        let below = self.fitted_to.iter().filter(|point| point[1] < percent);
        let mut sizes = below.map(|point| point[0]);
        sizes.rfind(|size| {
            let band = self.band_at(*size, level);
            band.is_some_and(|[_, most]| most < percent)
        })
    }

    /// The same where its points are the mean of photos: known by how far the photos differ. `left_out` has the mean with one after
    /// another of them left out; of fewer than two there are no bands. What could not be fitted then takes the bands away, too.
    #[must_use]
    pub(crate) fn of_repeats(mut self, left_out: &[SizeDistribution]) -> Self {
        let again = |distribution: &SizeDistribution| {
            let found = fit(distribution, self.model, &FitOptions::default());
            found.ok().map(|found| found.curve)
        };
        let curves: Option<Vec<Curve>> = left_out.iter().map(again).collect();
        let repeats = curves.and_then(Repeats::new);
        for (index, parameter) in self.parameters.iter_mut().enumerate() {
            let value = |curve: &Curve| curve.parameters().get(index).copied().unwrap_or(f64::NAN);
            let error = repeats.as_ref().and_then(|of| of.standard_error(value));
            parameter.standard_error = parameter.standard_error.and(error);
        }
        if repeats.is_none() {
            let why = match left_out {
                [] | [_] => {
                    "its points are of one photo or sample: how far another one of the rock would differ they do not say"
                }
                _ => {
                    "without some of its photos no function can be fitted: how far they differ is not known"
                }
            };
            let elsewhere = "there are no confidence bands (sizes.csv of delineate has intervals)";
            self.notes.push(format!("{why}; {elsewhere}"));
        }
        self.known = repeats.map_or(Known::Nothing, Known::Repeats);
        self
    }

    /// The same where its `points` are read off curves that have `own` each: no more are measured one by one.
    #[must_use]
    pub(crate) fn of_fewer_points(mut self, points: usize, own: usize) -> Self {
        let fewer = points.saturating_sub(own);
        // Those of them that say nothing did not count before; they are as many as among all.
        let certain = self.silent_points() * fewer / points.max(1);
        let left = self
            .degrees_of_freedom
            .saturating_sub(fewer.saturating_sub(certain));
        let ratio = points as f64 / own.max(1) as f64;
        self.known = match self.known {
            Known::Scatter(_) if left == 0 => Known::Nothing,
            Known::Scatter(scatter) => Known::Scatter(Box::new(scatter.of_fewer(ratio, left))),
            known => known,
        };
        for parameter in &mut self.parameters {
            let is_known = self.known != Known::Nothing;
            let error = parameter.standard_error.filter(|_| is_known);
            parameter.standard_error = error.map(|error| error * ratio.sqrt());
        }
        self
    }

    /// The confidence band [low, high] of the fitted percent passing at a size, at a confidence of
    /// `level`: by the delta method with Student's t, cut to 0 to 100. It is of the curve, at each
    /// size for itself; measured points scatter about it more widely.
    pub fn band_at(&self, size: f64, level: f64) -> Option<[f64; 2]> {
        if !(size.is_finite() && size > 0.0) {
            return None;
        }
        let half = match &self.known {
            Known::Nothing => return None,
            Known::Scatter(scatter) => 100.0 * scatter.reach(level)? * scatter.at_size(size.ln()).0,
            Known::Repeats(repeats) => repeats.reach(level, |curve| curve.percent_passing(size))?,
        };
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
    let free = notes::free(&family, best);
    let tells = uncertainty::telling(&family, &points, &best.at, &free);
    let telling = tells.iter().filter(|tells| **tells).count();
    let degrees_of_freedom = telling.saturating_sub(fitted);
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
    let used = measured.iter().enumerate();
    let used = used.filter(|(index, _)| weight(*index) > 0.0);
    let fitted_to: Vec<[f64; 2]> = used.map(|(_, point)| *point).collect();
    let residuals: Vec<f64> = measured
        .iter()
        .map(|&[size, percent]| percent - curve.percent_passing(size))
        .collect();
    let squares = residuals.iter().enumerate();
    let sum: f64 = squares
        .map(|(i, residual)| weight(i) * residual * residual)
        .sum();
    let quality = Quality::new(&curve, &points, &tells);
    let others: Vec<_> = curves.iter().skip(1).map(|(o, c)| (o.sum, *c)).collect();
    let told = notes::Told {
        family: &family,
        best,
        points: &points,
        options,
        parameters: &parameters,
        others: &others,
        fitted,
        telling,
        known: uncertainty.is_some(),
    };
    let not_determined = notes::not_determined(&told);
    let notes = notes::notes(&told, &not_determined);
    Ok(Fit {
        model,
        curve,
        parameters,
        residuals,
        residual_sum_of_squares: sum,
        rmse: quality.rmse,
        r_squared: quality.r_squared,
        telling_points: telling,
        degrees_of_freedom,
        notes,
        not_determined,
        fitted_to,
        known: uncertainty.map_or(Known::Nothing, |of| Known::Scatter(Box::new(of))),
    })
}
