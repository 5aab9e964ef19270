//! Percent error of the passing at each size.

/// What a percent error is, for headers and notes of outputs.
pub const PERCENT_ERROR: &str = "percent error = 100 (P - P reference) / P reference of the percent passing; above 0 \
     the method says that more passes (finer) than the reference; undefined where the reference is 0";

/// How far off a method is at one size of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PercentError {
    /// In the set's unit.
    pub size: f64,
    /// Mean percent passing of the reference.
    pub reference: f64,
    /// Mean percent passing of the method, between its points linear in the logarithm of the size;
    /// `None` where no trial is known.
    pub passing: Option<f64>,
    /// `passing` less `reference`, percentage points.
    pub difference: Option<f64>,
    /// See [`PERCENT_ERROR`]; `None` where the reference is 0 or the method unknown.
    pub percent_error: Option<f64>,
    /// Whether the percent error is within the envelope's percent (30), either side.
    pub within: Option<bool>,
}
