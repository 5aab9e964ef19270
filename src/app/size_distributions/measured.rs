//! Time effort: the times of a file, and how long the program's own steps took.

use std::path::PathBuf;
use std::time::Duration;

use crate::fault::Fault;
use crate::fragmentation::Effort;

/// A step that the program did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredStep {
    /// What was done.
    pub step: &'static str,
    /// For which flight.
    pub flight: String,
    /// How long it took the last time.
    pub took: Duration,
}

/// The times of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct EffortFile {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub path: PathBuf,
    /// The times.
    pub effort: Effort,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
}

/// The measured steps as a table, one column a flight.
///
/// # Errors
/// Where a step is there twice for a flight, which measuring does not do.
pub fn effort(measured: &[MeasuredStep]) -> Result<Effort, Fault> {
    let mut effort = Effort::new();
    for MeasuredStep { step, flight, took } in measured {
        effort.add(step, flight, Some(took.as_secs_f64()))?;
    }
    Ok(effort)
}
