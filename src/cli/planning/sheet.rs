//! `--sheet`: a plan on paper, for whoever flies it.

use std::path::PathBuf;

use clap::Args;

use crate::cli::outputs::Outputs;
use crate::cli::written_beside::check_report_name;
use crate::exports::{FlightSheet, flight_sheet};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;

#[derive(Debug, Args)]
pub(super) struct SheetArguments {
    /// Write a page to print for the pilot to this file, .html: map, numbers, checklist, photos.
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
}

impl SheetArguments {
    /// The outputs with the sheet among them.
    ///
    /// # Errors
    /// Where the sheet cannot be written to a file of its name.
    pub(super) fn among<'a>(&'a self, outputs: Outputs<'a>) -> Result<Outputs<'a>, String> {
        let Some(path) = &self.sheet else {
            return Ok(outputs);
        };
        check_report_name(path)?;
        outputs.and(path, Kind::Result)
    }

    /// Writes the sheet, where one is asked for.
    ///
    /// # Errors
    /// Where it cannot be drawn or written.
    pub(super) fn write(
        &self,
        outputs: &Outputs<'_>,
        sheet: &FlightSheet<'_>,
    ) -> Result<(), String> {
        let Some(path) = &self.sheet else {
            return Ok(());
        };
        let in_sheet = |fault: Fault| FileError::new(path, fault).to_string();
        let page = flight_sheet(sheet).map_err(in_sheet)?;
        outputs.write(path, page.as_bytes(), Kind::Result)
    }
}
