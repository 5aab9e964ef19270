//! How far the points that say something lie from the fitted function.

use super::points::{Point, Points};
use crate::Curve;

/// Weighted, of points that say something of the parameters.
pub(super) struct Quality {
    /// Root of the mean squared residual, percentage points.
    pub(super) rmse: f64,
    /// 1 - residual sum of squares / sum of squares about the mean.
    pub(super) r_squared: f64,
}

impl Quality {
    /// Of the points that `tells` is true of, in their order. Where one percent passes all of these, there is no spread about their mean
    /// that a function could explain: then all points count in R squared.
    pub(super) fn new(curve: &Curve, points: &Points, tells: &[bool]) -> Self {
        let all: Vec<&Point> = points.points.iter().collect();
        let telling = points.points.iter().zip(tells);
        let telling: Vec<&Point> = telling
            .filter_map(|(point, tells)| tells.then_some(point))
            .collect();
        let first = telling.first().map(|point| point.percent);
        let differ = telling.iter().any(|point| Some(point.percent) != first);
        let explained = if differ { &telling } else { &all };
        Self {
            rmse: (residuals(curve, &telling) / total(&telling)).sqrt(),
            r_squared: 1.0 - residuals(curve, explained) / about_mean(explained),
        }
    }
}

fn total(points: &[&Point]) -> f64 {
    points.iter().map(|point| point.weight).sum()
}

/// The sum of the squared residuals.
fn residuals(curve: &Curve, points: &[&Point]) -> f64 {
    let squares = points.iter().map(|point| {
        let residual = point.percent - curve.percent_passing(point.ln_size.exp());
        point.weight * residual * residual
    });
    squares.sum()
}

/// The sum of squares about the mean.
fn about_mean(points: &[&Point]) -> f64 {
    let sum: f64 = points
        .iter()
        .map(|point| point.weight * point.percent)
        .sum();
    let mean = sum / total(points);
    let squares = points.iter().map(|point| {
        let off = point.percent - mean;
        point.weight * off * off
    });
    squares.sum()
}
