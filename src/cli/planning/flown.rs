//! `fragscale flown`: a mission against the flight that came of it.

use std::path::PathBuf;

use clap::Args;
use glam::DVec2;

use crate::cli::Answer;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::on_surface::places::place;
use crate::cli::outputs::AnswerArguments;
use crate::cli::written_beside::check_report_name;
use crate::exports::{self, DrawingFormat, FlownFigure, FlownReport};
use crate::files::Kind;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{StatedTakeOff, compare_flown};

#[derive(Debug, Args)]
pub(in crate::cli) struct FlownArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The mission as it was planned: a file of any ground station that 'fragscale mission' reads. Of several batteries
    /// once for each, in the order in which they were flown.
    #[arg(long, value_name = "FILE", required = true)]
    mission: Vec<PathBuf>,
    /// Where the drone took off, in the world and on the surface, if that is not where the mission says.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    take_off: Option<DVec2>,
    /// Draw what was planned and flown into this file, .svg, .pdf or .png; may be given more than once.
    #[arg(long, value_name = "FILE")]
    figure: Vec<PathBuf>,
    /// Write the figure, the numbers and every photo's residuals as a page to this file, .html.
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(in crate::cli) fn flown(
    arguments: &FlownArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let inputs = arguments.flight.files().chain(&arguments.mission);
    let mut outputs = arguments.answer.outputs(inputs)?;
    let mut formats = Vec::new();
    for path in &arguments.figure {
        let format = DrawingFormat::of(path);
        let format = format.map_err(|fault| FileError::new(path, fault).to_string())?;
        formats.push((path, format));
        outputs = outputs.and(path, Kind::Result)?;
    }
    if let Some(path) = &arguments.report {
        check_report_name(path)?;
        outputs = outputs.and(path, Kind::Result)?;
    }
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    let of = arguments.flight.of_mission(&opened);
    let take_off = arguments.take_off.map(StatedTakeOff::Given);
    let compared = compare_flown(&arguments.mission, of, take_off, progress);
    let compared = compared.map_err(|error| error.to_string())?;
    let parts = opened.flight.parts();
    let report = FlownReport {
        flight: &parts.name,
        unit: parts.unit,
        planned: &compared.planned,
        photos: &compared.photos,
        flown: &compared.flown,
    };
    let text = arguments.answer.deliver(
        &outputs,
        &report,
        exports::flown_table,
        exports::flown_csv,
        exports::flown_json,
    )?;
    let figure = FlownFigure {
        report: &report,
        places: &compared.places,
        is_on_map: compared.is_on_map,
    };
    for (path, format) in formats {
        let bytes = figure.bytes(format);
        let bytes = bytes.map_err(|fault| FileError::new(path, fault).to_string())?;
        outputs.write(path, &bytes, Kind::Result)?;
    }
    let mut warnings = exports::flown_warnings(&report);
    warnings.extend(compared.notes);
    if let Some(path) = &arguments.report {
        let page = figure.page(&warnings);
        let page = page.map_err(|fault| FileError::new(path, fault).to_string())?;
        outputs.write(path, page.as_bytes(), Kind::Result)?;
    }
    warnings.extend(opened.all_warnings());
    Ok(Answer::new(text, warnings))
}
