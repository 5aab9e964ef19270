//! The search for the least weighted sum of squared residuals, within bounds.
//!
//! MINPACK's Levenberg-Marquardt (the `levenberg-marquardt` crate) knows no bounds: it runs in angles
//! z, of which coordinate = middle + half width sin z, as CERN's Minuit does. At a bound that is
//! stationary whatever the slope; so where a coordinate ends next to its bound, the search is
//! repeated with it at the bound, and the lesser sum is kept.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::coordinates::{Bounds, Coordinates, MOST, Optimum, sum_of_squares};
use super::family::Family;
use super::points::Points;

/// Evaluations a coordinate that are enough to tell good starts from bad ones.
const SHORT: usize = 6;

/// Evaluations a coordinate that bring a good start near to its rest.
const LONG: usize = 20;

/// Evaluations a coordinate in which the search comes to rest.
const TO_THE_END: usize = 200;

/// So many of the starts are searched for long, the best ones after a short search. With 10 of 80
/// starts the extended Swebrec missed the least sum of 6 of 458 real curves, of one by half.
const FINALISTS: usize = 80;

/// Where sums after a long search differ by this share, the lesser is surely the better.
const NEARLY: f64 = 1.02;

/// The best optimum first; the others in the order of their sums.
pub(super) fn optima(family: &Family, points: &Points) -> Vec<Optimum> {
    let starts = family.starts(points);
    let search = |optima: Vec<Optimum>, patience| -> Vec<Optimum> {
        let optima = optima.iter();
        optima
            .map(|at| minimise(family, points, at, patience))
            .collect()
    };
    let short = distinct(search(starts, SHORT), FINALISTS);
    let mut long = distinct(search(short, LONG), FINALISTS);
    let least = long.first().map_or(0.0, |best| best.sum);
    long.retain(|optimum| optimum.sum <= NEARLY * least);
    let at_bounds = long.iter().map(|at| along_its_bounds(family, points, *at));
    let mut rested = search(at_bounds.collect(), TO_THE_END);
    if family.is_extended() {
        // Next to 1, a has few digits, and the sum is a staircase in it: so the others by themselves.
        for optimum in &mut rested {
            let mut at_its_a = *optimum;
            at_its_a.bounds[3] = [optimum.at[3]; 2];
            let there = minimise(family, points, &at_its_a, LONG);
            (optimum.at, optimum.sum) = (there.at, there.sum);
        }
    }
    sort(&mut rested);
    rested
}

/// In the order of their sums, at most `count`, each place once.
fn distinct(mut optima: Vec<Optimum>, count: usize) -> Vec<Optimum> {
    sort(&mut optima);
    let mut kept: Vec<Optimum> = Vec::new();
    for optimum in optima {
        let known = kept.iter().any(|other| {
            (other.sum - optimum.sum).abs() <= 1e-6 * other.sum
                && (0..MOST).all(|i| (other.at[i] - optimum.at[i]).abs() < 1e-3)
        });
        if !known && kept.len() < count {
            kept.push(optimum);
        }
    }
    kept
}

fn sort(optima: &mut [Optimum]) {
    optima.sort_by(|a, b| a.sum.total_cmp(&b.sum));
}

/// The optimum with the coordinates that ended next to a bound put there, where that is no worse.
fn along_its_bounds(family: &Family, points: &Points, mut optimum: Optimum) -> Optimum {
    for index in 0..MOST {
        let [low, high] = optimum.bounds[index];
        let near = 1e-2 * (high - low);
        let at = optimum.at[index];
        let bound = if low < high && at - low < near {
            low
        } else if low < high && high - at < near {
            high
        } else {
            continue;
        };
        let mut there = optimum;
        there.at[index] = bound;
        there.bounds[index] = [bound; 2];
        there.sum = f64::INFINITY;
        let there = minimise(family, points, &there, LONG);
        if there.sum <= optimum.sum * (1.0 + 1e-12) {
            optimum = there;
        }
    }
    optimum
}

/// From one place to where the search comes to rest, with at most `patience` evaluations a
/// coordinate.
fn minimise(family: &Family, points: &Points, start: &Optimum, patience: usize) -> Optimum {
    let bounds = &start.bounds;
    let mut problem = Problem {
        family,
        points,
        bounds,
        free: (0..MOST)
            .filter(|&index| bounds[index][0] < bounds[index][1])
            .collect(),
        at: start.at,
        angles: DVector::zeros(0),
    };
    if !problem.free.is_empty() {
        let angles = problem.angles_of(&start.at);
        problem.angles = angles.clone();
        problem.set_params(&angles);
        let solver = LevenbergMarquardt::new()
            .with_ftol(1e-14)
            .with_xtol(1e-14)
            .with_gtol(1e-14)
            .with_patience(patience)
            .with_stepbound(1.0);
        // Whatever it says at the end, the place is judged by its sum.
        (problem, _) = solver.minimize(problem);
    }
    let share = |_, ln_size| family.share(&problem.at, ln_size).share;
    let sum = sum_of_squares(points, share);
    if sum < start.sum {
        return Optimum {
            at: problem.at,
            sum,
            ..*start
        };
    }
    *start
}

/// The residuals in angles of the free coordinates.
struct Problem<'a> {
    family: &'a Family,
    points: &'a Points,
    bounds: &'a Bounds,
    free: Vec<usize>,
    at: Coordinates,
    angles: DVector<f64>,
}

impl Problem<'_> {
    fn middle_and_half(&self, index: usize) -> (f64, f64) {
        let [low, high] = self.bounds[index];
        (0.5 * (low + high), 0.5 * (high - low))
    }

    fn angles_of(&self, at: &Coordinates) -> DVector<f64> {
        let angle = |&index: &usize| {
            let (middle, half) = self.middle_and_half(index);
            // At the bound itself nothing would move.
            ((at[index] - middle) / half).clamp(-0.9999, 0.9999).asin()
        };
        DVector::from_iterator(self.free.len(), self.free.iter().map(angle))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, angles: &DVector<f64>) {
        self.angles.copy_from(angles);
        for (&index, angle) in self.free.iter().zip(angles.iter()) {
            let (middle, half) = self.middle_and_half(index);
            self.at[index] = middle + half * angle.sin();
        }
    }

    fn params(&self) -> DVector<f64> {
        self.angles.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let points = &self.points.points;
        let residual = |point: &super::points::Point| {
            let share = self.family.share(&self.at, point.ln_size).share;
            point.weight.sqrt() * (100.0 * share - point.percent)
        };
        Some(DVector::from_iterator(
            points.len(),
            points.iter().map(residual),
        ))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let points = &self.points.points;
        let by_angle = self.free.iter().zip(self.angles.iter());
        let by_angle: Vec<f64> = by_angle
            .map(|(&index, angle)| self.middle_and_half(index).1 * angle.cos())
            .collect();
        let mut jacobian = DMatrix::zeros(points.len(), self.free.len());
        for (row, point) in points.iter().enumerate() {
            let gradient = self.family.share(&self.at, point.ln_size).gradient;
            for (column, (&index, by_angle)) in self.free.iter().zip(&by_angle).enumerate() {
                jacobian[(row, column)] = 100.0 * point.weight.sqrt() * gradient[index] * by_angle;
            }
        }
        Some(jacobian)
    }
}
