//! Gates-Gaudin-Schuhmann in the logarithms of both parameters: ln(xmax / the largest size that not
//! everything passed), ln m.
//!
//! Its xmax may lie below that size: it is where the straight line reaches 100 %, the size modulus,
//! which for most rock is smaller than the largest fragment.

use super::coordinates::{
    Bounds, Coordinates, EXPONENT, FARTHEST, MOST, Optimum, Share, geometric, sum_of_squares,
};
use super::points::Points;
use crate::{Curve, GatesGaudinSchuhmann};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GatesGaudinSchuhmannCoordinates {
    ln_retained: f64,
    /// Lowest and highest of the first coordinate; equal where xmax is given.
    xmax: [f64; 2],
    given: Option<f64>,
}

impl GatesGaudinSchuhmannCoordinates {
    pub(super) fn new(points: &Points, given: Option<f64>) -> Self {
        let ln_retained = points.retained.ln();
        let smallest = points.points.first().map_or(0.0, |point| point.ln_size);
        Self {
            ln_retained,
            xmax: match given {
                Some(xmax) => [xmax.ln() - ln_retained; 2],
                None => [smallest - ln_retained, FARTHEST],
            },
            given,
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        let mut bounds = [[0.0; 2]; MOST];
        bounds[0] = self.xmax;
        bounds[1] = EXPONENT;
        bounds
    }

    pub(super) fn share(&self, at: &Coordinates, ln_size: f64) -> Share {
        let (m, below) = (at[1].exp(), ln_size - self.ln_retained - at[0]);
        let mut gradient = [0.0; MOST];
        if below >= 0.0 {
            return Share {
                share: 1.0,
                gradient,
                slope: 0.0,
            };
        }
        let share = (m * below).exp();
        gradient[0] = -share * m;
        gradient[1] = share * m * below;
        Share {
            share,
            gradient,
            slope: share * m,
        }
    }

    /// Where xmax passes a size, that point stops to count and the sum has a kink: so it is searched
    /// between every two sizes for itself, and above them; from the best m of a grid.
    pub(super) fn starts(&self, points: &Points) -> Vec<Optimum> {
        let range = points.range.max(1e-3);
        let mut ends: Vec<f64> = points
            .points
            .iter()
            .map(|p| p.ln_size - self.ln_retained)
            .collect();
        ends.push(self.xmax[1]);
        let between = ends
            .windows(2)
            .filter(|ends| self.given.is_none() && ends[0] < ends[1]);
        let mut stretches: Vec<([f64; 2], Vec<f64>)> = between
            .map(|ends| {
                let inside = geometric(1e-2, 1.0, 8)
                    .map(|above| ends[0] + above * (ends[1] - ends[0]).min(30.0 * range))
                    .filter(|at| *at < ends[1]);
                ([ends[0], ends[1]], inside.collect())
            })
            .collect();
        if self.given.is_some() {
            stretches.push((self.xmax, vec![self.xmax[0]]));
        }
        let mut starts = Vec::new();
        for (stretch, largest) in stretches {
            let mut bounds = self.bounds();
            bounds[0] = stretch;
            let mut best: Option<Optimum> = None;
            for largest in largest {
                for m in geometric(0.02, 100.0, 24) {
                    let mut at = [0.0; MOST];
                    at[0] = largest;
                    at[1] = (m / range).ln().clamp(EXPONENT[0], EXPONENT[1]);
                    let sum = sum_of_squares(points, |_, ln_size| self.share(&at, ln_size).share);
                    if best.is_none_or(|best| sum < best.sum) {
                        best = Some(Optimum { at, bounds, sum });
                    }
                }
            }
            starts.extend(best);
        }
        starts
    }

    pub(super) fn curve(&self, at: &Coordinates) -> Option<Curve> {
        let xmax = self.given.unwrap_or((self.ln_retained + at[0]).exp());
        let curve = GatesGaudinSchuhmann::new(xmax, at[1].exp());
        curve.ok().map(Curve::GatesGaudinSchuhmann)
    }

    pub(super) fn parameter_gradients(&self, at: &Coordinates) -> [Coordinates; MOST] {
        let mut gradients = [[0.0; MOST]; MOST];
        gradients[0][0] = (self.ln_retained + at[0]).exp();
        gradients[1][1] = at[1].exp();
        gradients
    }
}
