//! A mission beside the flight that came of it, as numbers and as lines of the picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::exports::{FlownReport, flown_warnings};
use crate::flight::Flight;
use crate::opening::ComparedFlight;
use crate::render::{PlannedLine, flown_lines};
use crate::units::LengthUnit;

/// A mission beside the flight on the screen.
pub struct FlownMission {
    /// The mission's file.
    pub file: PathBuf,
    /// What came of it.
    pub compared: ComparedFlight,
    /// What is to be said beside the numbers, one sentence each.
    pub warnings: Vec<String>,
    /// As lines of the picture.
    pub(super) lines: Arc<Vec<PlannedLine>>,
}

impl FlownMission {
    /// What the exports say of it.
    pub fn report<'a>(&'a self, flight: &'a str, unit: LengthUnit) -> FlownReport<'a> {
        FlownReport {
            flight,
            unit,
            planned: &self.compared.planned,
            photos: &self.compared.photos,
            flown: &self.compared.flown,
        }
    }

    pub(super) fn of(file: &Path, compared: ComparedFlight, flight: &Flight) -> Self {
        let parts = flight.parts();
        let lines = flown_lines(
            &compared.planned,
            &compared.places,
            &compared.flown,
            parts.cameras.first(),
        );
        let mut flown = Self {
            file: file.to_owned(),
            lines: Arc::new(lines),
            compared,
            warnings: Vec::new(),
        };
        // A mission that is only looked at has no photos that could be missing.
        if !flown.compared.photos.is_empty() {
            flown.warnings = flown_warnings(&flown.report(&parts.name, parts.unit));
        }
        flown.warnings.extend(flown.compared.notes.iter().cloned());
        flown
    }
}
