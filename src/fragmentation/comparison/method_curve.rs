//! The mean of a method's trials, its spread, and the function fitted to it.

use crate::fault::Fault;
use crate::{Fit, FitOptions, Model, SizeDistribution, fit};

/// Sizes nearer to each other than this share are one: units that were converted differ by roundings.
const SAME_SIZE: f64 = 1e-9;

/// Percent passing one size, over a method's trials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanPoint {
    /// In the set's unit.
    pub size: f64,
    /// Mean percent passing of the trials that are known at this size.
    pub mean: f64,
    /// Their standard deviation (n - 1), percentage points; `None` with one trial.
    pub standard_deviation: Option<f64>,
    /// How many trials are known at this size.
    pub trials: usize,
}

/// What a band of a mean of curves rests on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum MeasuredBy {
    /// Points that were measured one by one, so many of each curve at most; `None`: all that it has.
    Points(Option<usize>),
    /// The mean without one photo or trial after another; empty where there is one photo alone.
    Repeats(Vec<SizeDistribution>),
}

/// A method's mean curve.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodCurve {
    /// `Labels::method`.
    pub method: String,
    /// `Labels::trial` of each, in the order of the set.
    pub trials: Vec<String>,
    /// At every size that some trial was measured at and some is known at, ascending.
    pub points: Vec<MeanPoint>,
    /// The function fitted to the means of those sizes at which every trial is known.
    pub fit: Fit,
}

impl MethodCurve {
    /// The mean of a method's trials (their names and distributions, one or more) with its fit, whose bands rest on
    /// what was `measured`.
    ///
    /// # Errors
    ///
    /// Too few sizes at which every trial is known, or what [`fit`](fn@fit) says.
    pub(super) fn new(
        method: &str,
        trials: &[(&str, &SizeDistribution)],
        model: Model,
        measured: MeasuredBy,
    ) -> Result<Self, Fault> {
        let distributions: Vec<&SizeDistribution> = trials.iter().map(|(_, d)| *d).collect();
        let points = mean_points(&distributions);
        let named = |fault: Fault| {
            let what = format!("the method '{method}': {}", fault.what);
            Fault::new(what, fault.remedy)
        };
        let whole = whole_mean(&points, trials.len()).map_err(named)?;
        let fit = fit(&whole, model, &FitOptions::default()).map_err(named)?;
        let fit = match measured {
            MeasuredBy::Repeats(left_out) => fit.of_repeats(&left_out),
            MeasuredBy::Points(measured) => {
                // Between their own sieves trials were not measured.
                let own = distributions.iter().map(|own| own.points().len()).max();
                let all = whole.points().len();
                fit.of_fewer_points(all, measured.or(own).unwrap_or(all).min(all))
            }
        };
        Ok(Self {
            method: method.to_owned(),
            trials: trials.iter().map(|(name, _)| (*name).to_owned()).collect(),
            points,
            fit,
        })
    }

    /// The size that a percent of the mean passes, as it was measured; `None` where it was not.
    pub fn measured_size_at(&self, percent: f64) -> Option<f64> {
        let whole = whole_mean(&self.points, self.trials.len()).ok()?;
        whole.size_at(percent)
    }

    /// The points of which every trial says something: where trials begin or end on the way, the mean
    /// of those left may jump.
    pub fn known_to_all(&self) -> impl DoubleEndedIterator<Item = &MeanPoint> {
        let known = |point: &&MeanPoint| point.trials == self.trials.len();
        self.points.iter().filter(known)
    }

    /// Mean less and plus the standard deviation, two edges of points [size, percent], where there are
    /// trials to have one; 0 to 100 %.
    pub fn spread(&self) -> [Vec<[f64; 2]>; 2] {
        [-1.0, 1.0].map(|sign| {
            let edge = self.known_to_all().filter_map(|point| {
                let percent = point.mean + sign * point.standard_deviation?;
                Some([point.size, percent.clamp(0.0, 100.0)])
            });
            edge.collect()
        })
    }

    /// The smallest and the largest measured size.
    pub(super) fn range(&self) -> Option<[f64; 2]> {
        Some([self.points.first()?.size, self.points.last()?.size])
    }

    /// The smallest and the largest size at which every trial is known.
    pub(super) fn range_known_to_all(&self) -> Option<[f64; 2]> {
        let sizes = || self.known_to_all().map(|point| point.size);
        Some([sizes().next()?, sizes().next_back()?])
    }

    /// The sizes that not every trial knows.
    pub(super) fn partly_known(&self) -> impl Iterator<Item = f64> {
        let partly = |point: &&MeanPoint| point.trials < self.trials.len();
        self.points.iter().filter(partly).map(|point| point.size)
    }
}

/// The mean over those trials that are known at a size; `None` where none is.
pub(super) fn mean_at(trials: &[&SizeDistribution], size: f64) -> Option<MeanPoint> {
    let percents: Vec<f64> = trials
        .iter()
        .filter_map(|trial| trial.percent_passing(size))
        .collect();
    if percents.is_empty() {
        return None;
    }
    let count = percents.len() as f64;
    let mean = percents.iter().sum::<f64>() / count;
    let squares: f64 = percents.iter().map(|p| (p - mean) * (p - mean)).sum();
    Some(MeanPoint {
        size,
        mean,
        standard_deviation: (percents.len() > 1).then(|| (squares / (count - 1.0)).sqrt()),
        trials: percents.len(),
    })
}

/// Whether a trial that is known at a size was not measured there, but at sizes on both its sides.
pub(super) fn is_between_points(trials: &[&SizeDistribution], size: f64) -> bool {
    let is_there = |point: &[f64; 2]| (point[0] - size).abs() <= SAME_SIZE * size;
    trials.iter().any(|trial| {
        let points = trial.points();
        let is_inside = |(first, last): (&[f64; 2], &[f64; 2])| first[0] < size && size < last[0];
        let ends = points.first().zip(points.last());
        ends.is_some_and(is_inside) && !points.iter().any(is_there)
    })
}

/// The mean of trials at the sizes that all know; `None` where they share fewer than two.
pub(crate) fn whole_mean_of(trials: &[&SizeDistribution]) -> Option<SizeDistribution> {
    whole_mean(&mean_points(trials), trials.len()).ok()
}

/// The mean at every measured size.
fn mean_points(trials: &[&SizeDistribution]) -> Vec<MeanPoint> {
    let mut sizes: Vec<f64> = trials
        .iter()
        .flat_map(|trial| trial.points())
        .map(|point| point[0])
        .collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup_by(|next, size| *next - *size <= SAME_SIZE * *size);
    let known = sizes.into_iter().filter_map(|size| mean_at(trials, size));
    known.collect()
}

/// The mean as a distribution: where trials begin or end on the way, a mean of those left may jump, so
/// only the sizes that all know.
fn whole_mean(points: &[MeanPoint], trials: usize) -> Result<SizeDistribution, Fault> {
    let mut whole: Vec<[f64; 2]> = Vec::new();
    for point in points.iter().filter(|point| point.trials == trials) {
        // A mean of curves that never fall does not fall, but for its rounding.
        let before = whole.last().map_or(0.0, |point| point[1]);
        whole.push([point.size, point.mean.clamp(before, 100.0)]);
    }
    if whole.len() < 2 {
        let what = "its trials share fewer than two sizes at which all are known";
        return Err(Fault::new(
            what,
            "give trials of the same sieves, or one trial",
        ));
    }
    SizeDistribution::new(whole)
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    fn distribution(points: &[[f64; 2]]) -> SizeDistribution {
        SizeDistribution::new(points.to_vec()).expect("a distribution")
    }

    /// Halfway in the logarithm between 10 and 40, and nothing beyond.
    #[test]
    fn measured_sizes_are_no_functions() {
        let curve = distribution(&[[10.0, 20.0], [40.0, 60.0], [80.0, 95.0], [160.0, 100.0]]);
        let method = MethodCurve::new(
            "sieve",
            &[("1", &curve)],
            Model::Swebrec,
            MeasuredBy::Points(None),
        )
        .expect("a curve");
        let size = method.measured_size_at(40.0).expect("measured");
        assert!((size - 20.0).abs() < 1e-9, "{size}");
        assert_eq!(method.measured_size_at(60.0), Some(40.0));
        assert_eq!(method.measured_size_at(10.0), None);
    }

    /// 20 lies between 10 and 30, 10 and its rounding are one; beyond the ends nothing is between.
    #[test]
    fn between_points_nothing_was_measured() {
        let few = distribution(&[[10.0, 0.0], [30.0, 100.0]]);
        let more = distribution(&[[10.0, 0.0], [20.0, 50.0], [30.0, 100.0]]);
        for (size, of_few) in [
            (5.0, false),
            (10.0, false),
            (10.0 * (1.0 + 1e-12), false),
            (20.0, true),
            (30.0, false),
            (40.0, false),
        ] {
            assert_eq!(is_between_points(&[&few], size), of_few, "{size}");
            assert!(!is_between_points(&[&more], size), "{size}");
            assert_eq!(is_between_points(&[&more, &few], size), of_few, "{size}");
        }
    }

    /// At 10: 20, 30, 40, deviation 10. At 30 the third is between 10 and 90 halfway in the logarithm:
    /// 60. At 90 only the third is known, at 5 only the second, at 4 none but the second.
    #[test]
    fn mean_and_deviation_of_the_trials_that_are_known() {
        let trials = [
            distribution(&[[10.0, 20.0], [30.0, 50.0]]),
            distribution(&[[5.0, 1.0], [10.0 * (1.0 + 1e-12), 30.0], [30.0, 70.0]]),
            distribution(&[[10.0, 40.0], [90.0, 80.0]]),
        ];
        let trials: Vec<&SizeDistribution> = trials.iter().collect();
        let points = mean_points(&trials);
        let sizes: Vec<f64> = points.iter().map(|point| point.size).collect();
        assert_eq!(
            sizes,
            [5.0, 10.0, 30.0, 90.0],
            "10 and its rounding are one"
        );
        let counts: Vec<usize> = points.iter().map(|point| point.trials).collect();
        assert_eq!(counts, [1, 3, 3, 1]);
        assert!((points[1].mean - 30.0).abs() < 1e-9);
        assert!((points[1].standard_deviation.expect("three") - 10.0).abs() < 1e-9);
        assert!((points[2].mean - 60.0).abs() < 1e-12);
        assert!((points[2].standard_deviation.expect("three") - 10.0).abs() < 1e-12);
        assert_eq!(points[3].standard_deviation, None);
        let whole = whole_mean(&points, 3).expect("two sizes");
        assert_eq!(whole.points().len(), 2);
        assert_eq!(mean_at(&trials, 4.0), None);
        let apart = mean_points(&[trials[0], &distribution(&[[40.0, 1.0], [50.0, 2.0]])]);
        let fault = whole_mean(&apart, 2).expect_err("no common size");
        assert!(fault.what.contains("fewer than two sizes"), "{fault}");
    }
}
