//! How long the program's own steps took: beside those of a file, for the table of time effort.

use std::time::Duration;

/// A step that the program did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredStep {
    /// What was done.
    pub step: &'static str,
    /// For which flight.
    pub flight: String,
    /// How long it took.
    pub took: Duration,
}
