//! Swebrec and its extension in coordinates u, d, ln k, ln(a / (1 - a)), ln c.
//!
//! With t = ln(x / r) for a size r amid the points, that stays where it is:
//!
//! ```text
//! u = 1 / ln(xmax / r)
//! f(x)^b = exp(k (ln(1 - u t) / u - d)),    k = b u,    d = ln(1 - u t50) / u,    t50 = ln(x50 / r)
//! ```
//!
//! For u -> 0, xmax without end, this becomes exp(-k (t - t50)), the log-logistic curve. So what is
//! a valley without end in xmax and b is a short way in u at almost the same k, and the bounds of
//! xmax are bounds of u alone. Swebrec itself is the extension with a = 1.
//!
//! The logarithm tells a's apart that are next to 0 or 1: with an exponent of 30, a share of 1e-9 moves
//! the smallest sizes. 0 and 1 themselves are its bounds.

use super::coordinates::{
    Bounds, Coordinates, EXPONENT, FARTHEST, MOST, Optimum, Share, geometric, sum_of_squares,
};
use super::points::Points;
use crate::functions::ln_exp_m1;
use crate::{Curve, Swebrec, Swebrec5};

/// Bounds of ln(a / (1 - a)): a is 0 at the lower and 1 at the upper one, between them not nearer to
/// either than 2e-16, the last step of 1 - a in an f64.
const ODDS: [f64; 2] = [-36.0, 36.0];

/// a, from the logarithm of its odds.
fn share_of_coarse(odds: f64) -> f64 {
    if odds <= ODDS[0] {
        0.0
    } else if odds >= ODDS[1] {
        1.0
    } else {
        1.0 / (1.0 + (-odds).exp())
    }
}

/// How many starts are searched from.
const STARTS: usize = 400;

/// How many k and c are tried for them.
const EXPONENTS: u32 = 18;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SwebrecCoordinates {
    /// ln r.
    ln_middle: f64,
    /// Lowest and highest u; equal where xmax is given.
    u: [f64; 2],
    /// The xmax that belongs to the highest u.
    smallest_xmax: f64,
    extended: bool,
}

impl SwebrecCoordinates {
    pub(super) fn new(points: &Points, xmax: Option<f64>, extended: bool) -> Self {
        let smallest_xmax = xmax.unwrap_or(points.retained);
        let apart = 0.25 * points.range.max(0.1);
        let ln_middle = points.ln_median.min(smallest_xmax.ln() - apart);
        let highest = 1.0 / (smallest_xmax.ln() - ln_middle);
        Self {
            ln_middle,
            u: match xmax {
                Some(_) => [highest; 2],
                None => [1.0 / (FARTHEST + 1.0 / highest), highest],
            },
            smallest_xmax,
            extended,
        }
    }

    pub(super) fn is_extended(&self) -> bool {
        self.extended
    }

    pub(super) fn bounds(&self) -> Bounds {
        // Beyond, x50 leaves what an f64 can hold.
        let d = (300.0 / self.u[1]).min(FARTHEST);
        if self.extended {
            return [self.u, [-d, d], EXPONENT, ODDS, EXPONENT];
        }
        [self.u, [-d, d], EXPONENT, [ODDS[1]; 2], [0.0; 2]]
    }

    pub(super) fn share(&self, at: &Coordinates, ln_size: f64) -> Share {
        let &[u, d, ln_k, odds, ln_c] = at;
        let a = share_of_coarse(odds);
        let t = ln_size - self.ln_middle;
        // ln(xmax / x); of a size at xmax only rounding is left.
        let below = 1.0 / u - t;
        if below < 1e-13 * (1.0 + ln_size.abs()) {
            return Share {
                share: 1.0,
                gradient: [0.0; MOST],
                slope: 0.0,
            };
        }
        let k = ln_k.exp();
        let bent = if u * t < 0.5 {
            (-u * t).ln_1p() / u
        } else {
            (u * below).ln() / u
        };
        let bent_by_u = (-t / (1.0 - u * t) - bent) / u;
        // Beyond e^300 nothing passes, and its square is still a number.
        let coarse = a * (k * (bent - d)).min(300.0).exp();
        let mut by_u = coarse * k * bent_by_u;
        let mut by_d = -coarse * k;
        let mut by_size = -coarse * k / (1.0 - u * t);
        let (mut fines, mut by_a, mut by_c) = (0.0, 0.0, 0.0);
        if self.extended {
            let c = ln_c.exp();
            // ln(xmax / x50).
            let spread = (u * d).exp() / u;
            let steep = |y: f64| -1.0 / (-y).exp_m1();
            let log = ln_exp_m1(below) - ln_exp_m1(spread);
            let full = (c * log).min(300.0).exp();
            fines = (1.0 - a) * full;
            by_u += fines * c * (-steep(below) / (u * u) - steep(spread) * spread * (d - 1.0 / u));
            by_d -= fines * c * steep(spread) * u * spread;
            by_size -= fines * c * steep(below);
            by_c = fines * c * log;
            by_a = a * (1.0 - a) * ((k * (bent - d)).min(300.0).exp() - full);
        }
        let share = 1.0 / (1.0 + coarse + fines);
        // dP = -P^2 d(1 / P).
        let change = -share * share;
        Share {
            share,
            gradient: [
                change * by_u,
                change * by_d,
                change * coarse * k * (bent - d),
                change * by_a,
                change * by_c,
            ],
            slope: change * by_size,
        }
    }

    /// For every u of a grid (and a) the exponents with the least sum; the best of these.
    pub(super) fn starts(&self, points: &Points) -> Vec<Optimum> {
        let range = points.range.max(0.1);
        let to_smallest = 1.0 / self.u[1];
        let above = geometric(0.01, 30.0, 7).map(|above| 1.0 / (to_smallest + above * range));
        let mut us: Vec<f64> = vec![self.u[1]];
        if self.u[0] < self.u[1] {
            us.extend(above.filter(|u| *u > self.u[0]));
            us.push(self.u[0]);
        }
        let shares: &[f64] = if self.extended {
            &[
                ODDS[0], -28.0, -14.0, -7.0, -3.0, -1.0, 1.0, 3.0, 7.0, 14.0, 28.0, ODDS[1],
            ]
        } else {
            &[ODDS[1]]
        };
        let mut starts = Vec::new();
        for u in us {
            // The median may be a little aside of where the points cross 50 %.
            let terms = [-0.15, 0.0, 0.15].map(|aside| Terms::new(self, points, u, aside * range));
            for &odds in shares {
                for gentle in [true, false] {
                    let bests = terms
                        .iter()
                        .map(|terms| terms.best(self, points, odds, gentle));
                    starts.extend(bests.min_by(|a, b| a.sum.total_cmp(&b.sum)));
                }
            }
        }
        starts.sort_by(|a, b| a.sum.total_cmp(&b.sum));
        starts.truncate(STARTS);
        starts
    }

    pub(super) fn curve(&self, at: &Coordinates) -> Option<Curve> {
        let &[u, d, ln_k, odds, ln_c] = at;
        let a = share_of_coarse(odds);
        let xmax = if u == self.u[1] {
            self.smallest_xmax
        } else {
            (self.ln_middle + 1.0 / u).exp()
        };
        let x50 = (self.ln_middle - (u * d).exp_m1() / u).exp();
        let b = ln_k.exp() / u;
        if self.extended {
            return Swebrec5::new(x50, xmax, b, a, ln_c.exp())
                .ok()
                .map(Curve::Swebrec5);
        }
        Swebrec::new(x50, xmax, b).ok().map(Curve::Swebrec)
    }

    pub(super) fn parameter_gradients(&self, at: &Coordinates) -> [Coordinates; MOST] {
        let &[u, d, ln_k, odds, ln_c] = at;
        let a = share_of_coarse(odds);
        let mut gradients = [[0.0; MOST]; MOST];
        gradients[0][0] = -(self.ln_middle + 1.0 / u).exp() / (u * u);
        let t50 = -(u * d).exp_m1() / u;
        let x50 = (self.ln_middle + t50).exp();
        gradients[1][0] = x50 * (-d * (u * d).exp() - t50) / u;
        gradients[1][1] = -x50 * (u * d).exp();
        let b = ln_k.exp() / u;
        gradients[2][0] = -b / u;
        gradients[2][2] = b;
        gradients[3][3] = a * (1.0 - a);
        gradients[4][4] = ln_c.exp();
        gradients
    }
}

/// Both terms at every point for a grid of exponents, before they are weighed with a.
struct Terms {
    u: f64,
    d: f64,
    /// k, and the first term at every point.
    coarse: Vec<(f64, Vec<f64>)>,
    /// c, and the second.
    fines: Vec<(f64, Vec<f64>)>,
}

impl Terms {
    fn new(family: &SwebrecCoordinates, points: &Points, u: f64, aside: f64) -> Self {
        let t50 = points.ln_median + aside - family.ln_middle;
        let t50 = t50.min(1.0 / u - 1e-3 * points.range.max(0.1));
        let d = (-u * t50).ln_1p() / u;
        let spread = (u * d).exp() / u;
        let range = points.range.max(0.1);
        let below: Vec<f64> = points
            .points
            .iter()
            .map(|point| 1.0 / u - (point.ln_size - family.ln_middle))
            .collect();
        let term = |log: &dyn Fn(f64) -> f64, exponent: f64| {
            let exponent = (exponent / range).clamp(1.1e-3, 0.9e3);
            let at = |y: &f64| {
                if *y > 1e-12 {
                    (exponent * log(*y)).min(300.0).exp()
                } else {
                    0.0
                }
            };
            (exponent, below.iter().map(at).collect())
        };
        let coarse = |y: f64| (y / spread).ln() / u;
        let fines = |y: f64| ln_exp_m1(y) - ln_exp_m1(spread);
        let exponents = geometric(0.3, 100.0, EXPONENTS);
        Self {
            u,
            d,
            coarse: exponents.clone().map(|k| term(&coarse, k)).collect(),
            fines: if family.extended {
                exponents.map(|c| term(&fines, c)).collect()
            } else {
                vec![(1.0, vec![0.0; below.len()])]
            },
        }
    }

    /// The exponents with the least sum at one a, in the gentle or in the steep half of the k.
    fn best(
        &self,
        family: &SwebrecCoordinates,
        points: &Points,
        odds: f64,
        gentle: bool,
    ) -> Optimum {
        let a = share_of_coarse(odds);
        let mut bounds = family.bounds();
        // At a bound the search runs along it.
        for (index, at) in [(0, self.u), (3, odds)] {
            if bounds[index].contains(&at) {
                bounds[index] = [at; 2];
            }
        }
        let mut best = Optimum {
            at: [self.u, self.d, 0.0, odds, 0.0],
            bounds,
            sum: f64::INFINITY,
        };
        let (gentler, steeper) = self.coarse.split_at(self.coarse.len() / 2);
        for (k, coarse) in if gentle { gentler } else { steeper } {
            for (c, fines) in &self.fines {
                let share =
                    |index: usize, _| 1.0 / (1.0 + a * coarse[index] + (1.0 - a) * fines[index]);
                let sum = sum_of_squares(points, share);
                if sum < best.sum {
                    best.sum = sum;
                    best.at[2] = k.ln();
                    best.at[4] = if family.extended { c.ln() } else { 0.0 };
                }
            }
        }
        best
    }
}
