//! What the process of one flight is told, one line of JSON on its standard input, and what it says, lines of JSON on
//! its standard output.

use std::collections::BTreeMap;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::asked::Asked;
use crate::exports::FlightFindings;

/// What is to be done with a flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlightTold {
    /// The flight, as every command takes it.
    pub flight: PathBuf,
    /// `--surface`.
    pub surface: Option<PathBuf>,
    /// `--photo-folder`.
    pub photos: Option<PathBuf>,
    /// The table that its fragments are held against.
    pub reference: Option<PathBuf>,
    /// The folder of its results.
    pub to: PathBuf,
    /// The steps.
    pub asked: Asked,
    /// Whether files of others may be replaced.
    pub force: bool,
}

/// A line that the process says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SaidLine {
    /// How far it is.
    At {
        /// In words.
        stage: String,
        /// Of the stage, 0 to 1.
        fraction: f64,
    },
    /// The last line: what came of it.
    Done(FlightDone),
}

/// What came of a flight.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FlightDone {
    /// Whether all of it was there already, of the same inputs.
    pub as_before: bool,
    /// What is known of the flight; `None` where it could not be opened.
    pub findings: Option<FlightFindings>,
    /// Why it, or a step of it, failed: one line.
    pub error: Option<String>,
    /// How many results of earlier runs were taken away, by the file or folder that they were or lay in.
    #[serde(default)]
    pub taken_away: BTreeMap<String, usize>,
}
