//! The mean of a method's trials, its spread, and the function fitted to it.

use crate::fragmentation::Fit;

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

/// A method's mean curve.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodCurve {
    /// `Labels::method`.
    pub method: String,
    /// `Labels::trial` of each, in the order of the set.
    pub trials: Vec<String>,
    /// At every size that some trial was measured at, ascending.
    pub points: Vec<MeanPoint>,
    /// The function fitted to the means of those sizes at which every trial is known.
    pub fit: Fit,
}
