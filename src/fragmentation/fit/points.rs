//! The points that a function is fitted to, in logarithms of the size.

use super::FitOptions;
use crate::fault::Fault;
use crate::{Model, SizeDistribution};

/// Points with a weight above 0; at least as many as there are parameters, with a percent between 0
/// and 100 among them.
#[derive(Debug, Clone)]
pub(super) struct Points {
    /// Sizes ascending.
    pub(super) points: Vec<Point>,
    /// The largest size that not everything passed: some rock is larger.
    pub(super) retained: f64,
    /// ln of about the median size, for the starts of the search.
    pub(super) ln_median: f64,
    /// Between the logarithms of the smallest and the largest size.
    pub(super) range: f64,
}

/// One of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) ln_size: f64,
    pub(super) percent: f64,
    /// As given, over the mean of all.
    pub(super) weight: f64,
}

impl Points {
    pub(super) fn new(
        distribution: &SizeDistribution,
        model: Model,
        options: &FitOptions,
    ) -> Result<Self, Fault> {
        let all = distribution.points();
        let weights = weights(all.len(), options)?;
        let weighty: Vec<([f64; 2], f64)> = all
            .iter()
            .copied()
            .zip(weights)
            .filter(|(_, weight)| *weight > 0.0)
            .collect();
        let wanted = model.parameter_names().len() - usize::from(options.xmax.is_some());
        if weighty.len() < wanted {
            let what = format!(
                "{} points for the {wanted} parameters of {}",
                weighty.len(),
                model.name()
            );
            return Err(Fault::new(
                what,
                "give more points, or choose a function with fewer parameters",
            ));
        }
        let between = |percent: f64| percent > 0.0 && percent < 100.0;
        let retained = weighty.iter().rfind(|([_, percent], _)| *percent < 100.0);
        let (Some(&([retained, _], _)), true) = (
            retained,
            weighty.iter().any(|([_, percent], _)| between(*percent)),
        ) else {
            return Err(Fault::new(
                "no point has a percent passing between 0 and 100 %",
                "give a size that some of the rock passes",
            ));
        };
        if weighty.len() > 1 && weighty.windows(2).all(|pair| pair[0].0[1] == pair[1].0[1]) {
            return Err(Fault::new(
                "the percent passing is the same at every size",
                "give sizes over which it grows",
            ));
        }
        if let Some(xmax) = options.xmax {
            check_xmax(xmax, retained, model)?;
        }
        let mean = weighty.iter().map(|(_, weight)| weight).sum::<f64>() / weighty.len() as f64;
        let points: Vec<Point> = weighty
            .iter()
            .map(|&([size, percent], weight)| Point {
                ln_size: size.ln(),
                percent,
                weight: weight / mean,
            })
            .collect();
        let ends = points.first().zip(points.last());
        let range = ends.map_or(0.0, |(first, last)| last.ln_size - first.ln_size);
        Ok(Self {
            ln_median: ln_median(&points, range),
            points,
            retained,
            range,
        })
    }
}

fn weights(count: usize, options: &FitOptions) -> Result<Vec<f64>, Fault> {
    let Some(weights) = &options.weights else {
        return Ok(vec![1.0; count]);
    };
    if weights.len() != count {
        let what = format!("{} weights for {count} points", weights.len());
        return Err(Fault::new(what, "give each point one weight"));
    }
    for weight in weights {
        if !(0.0..=1e100).contains(weight) {
            let what = format!("a weight of {weight}");
            return Err(Fault::new(what, "give weights of 0 (not used) or more"));
        }
    }
    Ok(weights.clone())
}

fn check_xmax(xmax: f64, retained: f64, model: Model) -> Result<(), Fault> {
    if model == Model::RosinRammler {
        return Err(Fault::new(
            "Rosin-Rammler has no largest size",
            "leave xmax out, or choose another function",
        ));
    }
    if !(xmax.is_finite() && xmax > 0.0) {
        let what = format!("a largest size of {xmax}");
        return Err(Fault::new(what, "give a number above 0"));
    }
    if xmax < retained && model != Model::GatesGaudinSchuhmann {
        let what = format!("a largest size of {xmax}, where not everything passed {retained}");
        return Err(Fault::new(what, "give a larger one, or none"));
    }
    Ok(())
}

/// Where the points cross 50 %; where they do not, by a log-logistic curve through the outermost two
/// that lie between 0 and 100 %.
fn ln_median(points: &[Point], range: f64) -> f64 {
    let crossing = points
        .windows(2)
        .find(|pair| pair[0].percent <= 50.0 && pair[1].percent >= 50.0);
    if let Some([low, high]) = crossing {
        let step = high.percent - low.percent;
        let share = if step > 0.0 {
            (50.0 - low.percent) / step
        } else {
            0.5
        };
        return low.ln_size + share * (high.ln_size - low.ln_size);
    }
    let mut inside = points
        .iter()
        .filter(|point| point.percent > 0.0 && point.percent < 100.0);
    let logit = |point: &Point| (point.percent / (100.0 - point.percent)).ln();
    let (Some(first), last) = (inside.next(), inside.next_back()) else {
        return 0.0;
    };
    let last = last.unwrap_or(first);
    let nearest = if logit(first).abs() < logit(last).abs() {
        first
    } else {
        last
    };
    let rise = logit(last) - logit(first);
    let slope = if rise > 0.0 {
        rise / (last.ln_size - first.ln_size)
    } else {
        2.0
    };
    // Not farther away than ten times what was measured: it is a start only.
    let away = 10.0 * range.max(0.1);
    nearest.ln_size - (logit(nearest) / slope).clamp(-away, away)
}
