//! What the residuals say about how well the coordinates, and all that follows from them, are known.
//!
//! Covariance of the free coordinates: s^2 (J^T W J)^-1 with s^2 = weighted sum of squares / degrees
//! of freedom, J the change of the percents by the coordinates. What follows from the coordinates has
//! the variance g^T C g with g its gradient (the delta method).

use nalgebra::DMatrix;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::coordinates::{Coordinates, MOST};
use super::family::Family;
use super::points::Points;

/// Percents that differ by less are the same.
const ROUNDING: f64 = 1e-9;

/// Which points say something of the `free` coordinates: not those that everything passed and of which the function says so whatever
/// these are, as it does at and above its largest size.
pub(super) fn telling(
    family: &Family,
    points: &Points,
    at: &Coordinates,
    free: &[usize],
) -> Vec<bool> {
    let is_nothing = |share: f64| 100.0 * share.abs() < ROUNDING;
    let tells = points.points.iter().map(|point| {
        let found = family.share(at, point.ln_size);
        let mut changes = free.iter().map(|&index| found.gradient[index]);
        let is_certain = is_nothing(1.0 - point.percent / 100.0)
            && is_nothing(1.0 - found.share)
            && changes.all(is_nothing);
        !is_certain
    });
    tells.collect()
}

/// The covariance at an optimum.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Uncertainty {
    pub(super) family: Family,
    pub(super) at: Coordinates,
    /// 0 in the rows and columns of coordinates that were not free.
    covariance: [Coordinates; MOST],
    degrees_of_freedom: usize,
}

impl Uncertainty {
    /// Of the `free` coordinates; `sum` with weights of mean 1. `None` where no point is left over or
    /// the points cannot tell the coordinates apart.
    pub(super) fn new(
        family: Family,
        points: &Points,
        at: Coordinates,
        free: &[usize],
        sum: f64,
        degrees_of_freedom: usize,
    ) -> Option<Self> {
        if degrees_of_freedom == 0 {
            return None;
        }
        let mut jacobian = DMatrix::zeros(points.points.len(), free.len());
        for (row, point) in points.points.iter().enumerate() {
            let gradient = family.share(&at, point.ln_size).gradient;
            for (column, &index) in free.iter().enumerate() {
                jacobian[(row, column)] = 100.0 * point.weight.sqrt() * gradient[index];
            }
        }
        // Columns of length 1, so that what is small by its unit is not taken for nothing.
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        let known = |length: &f64| *length > 0.0;
        if !lengths.iter().all(known) {
            return None;
        }
        for (mut column, length) in jacobian.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        let svd = jacobian.svd(false, true);
        let v_t = svd.v_t?;
        let singular = &svd.singular_values;
        let well_conditioned = singular.min() > 1e-9 * singular.max();
        if !well_conditioned {
            return None;
        }
        let variance = sum / degrees_of_freedom as f64;
        let mut covariance = [[0.0; MOST]; MOST];
        for (row, &i) in free.iter().enumerate() {
            for (column, &j) in free.iter().enumerate() {
                let terms = (0..singular.len())
                    .map(|s| v_t[(s, row)] * v_t[(s, column)] / (singular[s] * singular[s]));
                covariance[i][j] = variance * terms.sum::<f64>() / (lengths[row] * lengths[column]);
            }
        }
        Some(Self {
            family,
            at,
            covariance,
            degrees_of_freedom,
        })
    }

    /// The same, where `ratio` points each stand for one that was measured, with so many degrees of freedom.
    pub(super) fn of_fewer(mut self, ratio: f64, degrees_of_freedom: usize) -> Self {
        let all = self.covariance.iter_mut().flatten();
        all.for_each(|covariance| *covariance *= ratio);
        self.degrees_of_freedom = degrees_of_freedom;
        self
    }

    /// The standard error of what has this gradient.
    pub(super) fn of(&self, gradient: &Coordinates) -> f64 {
        let mut variance = 0.0;
        for (row, by_row) in self.covariance.iter().zip(gradient) {
            for (covariance, by_column) in row.iter().zip(gradient) {
                variance += by_row * covariance * by_column;
            }
        }
        variance.max(0.0).sqrt()
    }

    /// How many standard errors a two-sided interval reaches to each side: Student's t. `None` unless
    /// the level is between 0 and 1.
    pub(super) fn reach(&self, level: f64) -> Option<f64> {
        if !(level > 0.0 && level < 1.0) {
            return None;
        }
        let student = StudentsT::new(0.0, 1.0, self.degrees_of_freedom as f64).ok()?;
        Some(student.inverse_cdf(0.5 * (1.0 + level)))
    }

    /// The standard error of the share passing, and the share's slope by the size's logarithm.
    pub(super) fn at_size(&self, ln_size: f64) -> (f64, f64) {
        let share = self.family.share(&self.at, ln_size);
        (self.of(&share.gradient), share.slope)
    }
}
