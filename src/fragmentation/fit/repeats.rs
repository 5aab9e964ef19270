//! How far a fit is known where its points are not measured one by one: a mean of photos, whose points are read off the photos' curves.
//!
//! Such points say the same again and again; the scatter about a function that goes through all of them is next to nothing, and
//! a band of it holds the true size once in 15 times. What is known is how far the photos differ: the function is fitted again
//! with each of them (or each of several groups) left out. By the jackknife (Tukey 1958; Efron and Tibshirani, "An Introduction to the
//! Bootstrap", 1993, chapter 11) a value has the variance (n - 1) / n times the sum of squares of its n values about their mean,
//! with Student's t of n - 1 degrees of freedom.

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::Curve;

/// The functions fitted with one repeat after another left out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Repeats {
    curves: Vec<Curve>,
}

impl Repeats {
    /// `None` of fewer than two: of one nobody knows how it differs from others.
    pub(super) fn new(curves: Vec<Curve>) -> Option<Self> {
        (curves.len() > 1).then_some(Self { curves })
    }

    /// The standard error of what a function says; `None` where one says nothing.
    pub(super) fn standard_error(&self, value: impl Fn(&Curve) -> f64) -> Option<f64> {
        let values: Vec<f64> = self.curves.iter().map(value).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let error = (squares * (count - 1.0) / count).sqrt();
        error.is_finite().then_some(error)
    }

    /// How far a two-sided interval of that reaches to each side.
    pub(super) fn reach(&self, level: f64, value: impl Fn(&Curve) -> f64) -> Option<f64> {
        if !(level > 0.0 && level < 1.0) {
            return None;
        }
        let freedom = self.curves.len() as f64 - 1.0;
        let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
        Some(student.inverse_cdf(0.5 * (1.0 + level)) * self.standard_error(value)?)
    }
}
