//! The search for the least weighted sum of squared residuals, within bounds.
//!
//! MINPACK's Levenberg-Marquardt (the `levenberg-marquardt` crate) knows no bounds: it runs in angles
//! z, of which coordinate = middle + half width sin z, as CERN's Minuit does. At a bound that is
//! stationary whatever the slope; so where a coordinate ends next to its bound, the search is
//! repeated with it at the bound, and the lesser sum is kept.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::coordinates::{Bounds, Coordinates, Family, MOST, sum_of_squares};
use super::points::Points;

/// A place where the search came to rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Optimum {
    pub(super) at: Coordinates,
    /// Where low and high are equal the coordinate was not free.
    pub(super) bounds: Bounds,
    /// With weights of mean 1.
    pub(super) sum: f64,
}

/// Of the starts that look best after a short search, this many are searched to the end.
const FINALISTS: usize = 8;

/// The best optimum first; the others in the order of their sums.
pub(super) fn optima(family: &Family, points: &Points) -> Vec<Optimum> {
    let mut found: Vec<Optimum> = family
        .starts(points)
        .iter()
        .map(|(at, bounds)| minimise(family, points, at, bounds, 6))
        .collect();
    sort(&mut found);
    // Those that came to the same place run on as one.
    let mut finalists: Vec<Optimum> = Vec::new();
    for optimum in found {
        let known = finalists.iter().any(|other| {
            (other.sum - optimum.sum).abs() <= 1e-7 * other.sum
                && (0..MOST).all(|i| (other.at[i] - optimum.at[i]).abs() < 1e-4)
        });
        if !known && finalists.len() < FINALISTS {
            finalists.push(optimum);
        }
    }
    let mut rested: Vec<Optimum> = finalists
        .iter()
        .map(|optimum| {
            let free = minimise(family, points, &optimum.at, &optimum.bounds, 100);
            along_its_bounds(family, points, free)
        })
        .collect();
    sort(&mut rested);
    rested
}

fn sort(optima: &mut [Optimum]) {
    optima.sort_by(|a, b| a.sum.total_cmp(&b.sum));
}

/// The optimum with the coordinates that ended next to a bound put there, where that is no worse.
fn along_its_bounds(family: &Family, points: &Points, mut optimum: Optimum) -> Optimum {
    for index in 0..MOST {
        let [low, high] = optimum.bounds[index];
        let near = 1e-3 * (high - low);
        let at = optimum.at[index];
        let bound = if low < high && at - low < near {
            low
        } else if low < high && high - at < near {
            high
        } else {
            continue;
        };
        let (mut start, mut bounds) = (optimum.at, optimum.bounds);
        start[index] = bound;
        bounds[index] = [bound; 2];
        let there = minimise(family, points, &start, &bounds, 100);
        if there.sum <= optimum.sum * (1.0 + 1e-12) {
            optimum = there;
        }
    }
    optimum
}

/// From one start to where it comes to rest, with at most `patience` evaluations a coordinate.
fn minimise(
    family: &Family,
    points: &Points,
    start: &Coordinates,
    bounds: &Bounds,
    patience: usize,
) -> Optimum {
    let mut problem = Problem {
        family,
        points,
        bounds,
        free: (0..MOST)
            .filter(|&index| bounds[index][0] < bounds[index][1])
            .collect(),
        at: *start,
        angles: DVector::zeros(0),
    };
    problem.angles = problem.angles_of(start);
    if !problem.free.is_empty() {
        let solver = LevenbergMarquardt::new()
            .with_patience(patience)
            .with_stepbound(1.0);
        let angles = problem.angles.clone();
        problem.set_params(&angles);
        // Whatever it says at the end, the place is judged by its sum.
        (problem, _) = solver.minimize(problem);
    }
    let sum = sum_of_squares(points, |_, ln_size| {
        family.share(&problem.at, ln_size).share
    });
    Optimum {
        at: problem.at,
        bounds: *bounds,
        sum: if sum.is_finite() { sum } else { f64::INFINITY },
    }
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
        let mut jacobian = DMatrix::zeros(points.len(), self.free.len());
        for (row, point) in points.iter().enumerate() {
            let gradient = self.family.share(&self.at, point.ln_size).gradient;
            for (column, &index) in self.free.iter().enumerate() {
                let (_, half) = self.middle_and_half(index);
                let by_angle = half * self.angles[column].cos();
                jacobian[(row, column)] = 100.0 * point.weight.sqrt() * gradient[index] * by_angle;
            }
        }
        Some(jacobian)
    }
}
