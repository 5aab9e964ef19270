//! Rosin-Rammler in the logarithms of both parameters: ln(x50 / a size amid the points), ln n.

use std::f64::consts::LN_2;

use super::coordinates::{
    Bounds, Coordinates, EXPONENT, FARTHEST, MOST, Optimum, Share, geometric, sum_of_squares,
};
use super::points::Points;
use crate::{Curve, RosinRammler};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RosinRammlerCoordinates {
    ln_middle: f64,
}

impl RosinRammlerCoordinates {
    pub(super) fn new(points: &Points) -> Self {
        Self {
            ln_middle: points.ln_median,
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        let mut bounds = [[0.0; 2]; MOST];
        bounds[0] = [-FARTHEST, FARTHEST];
        bounds[1] = EXPONENT;
        bounds
    }

    pub(super) fn share(&self, at: &Coordinates, ln_size: f64) -> Share {
        let (n, t) = (at[1].exp(), ln_size - self.ln_middle - at[0]);
        // Beyond e^50 the exponent has long said everything.
        let power = LN_2 * (n * t).min(50.0).exp();
        let change = (-power).exp() * power;
        let mut gradient = [0.0; MOST];
        gradient[0] = -change * n;
        gradient[1] = change * n * t;
        Share {
            share: -(-power).exp_m1(),
            gradient,
            slope: change * n,
        }
    }

    /// For every n of a grid the median near that of the points with the least sum; the search
    /// begins at the best few of n.
    pub(super) fn starts(&self, points: &Points) -> Vec<Optimum> {
        let range = points.range.max(1e-3);
        let mut starts = Vec::new();
        for n in geometric(0.05, 200.0, 25) {
            let mut best: Option<Optimum> = None;
            for step in -10..=10 {
                let mut at = [0.0; MOST];
                at[0] = 0.1 * f64::from(step) * range;
                at[1] = (n / range).ln().clamp(EXPONENT[0], EXPONENT[1]);
                let sum = sum_of_squares(points, |_, ln_size| self.share(&at, ln_size).share);
                if best.is_none_or(|best| sum < best.sum) {
                    let bounds = self.bounds();
                    best = Some(Optimum { at, bounds, sum });
                }
            }
            starts.extend(best);
        }
        starts.sort_by(|a, b| a.sum.total_cmp(&b.sum));
        starts.truncate(8);
        starts
    }

    pub(super) fn curve(&self, at: &Coordinates) -> Option<Curve> {
        let curve = RosinRammler::new((self.ln_middle + at[0]).exp(), at[1].exp());
        curve.ok().map(Curve::RosinRammler)
    }

    pub(super) fn parameter_gradients(&self, at: &Coordinates) -> [Coordinates; MOST] {
        let mut gradients = [[0.0; MOST]; MOST];
        gradients[0][0] = (self.ln_middle + at[0]).exp();
        gradients[1][1] = at[1].exp();
        gradients
    }
}
