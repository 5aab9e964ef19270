//! `fragscale export`: the folder for Split-Desktop.

use std::path::PathBuf;
use std::sync::OnceLock;

use clap::{Args, ValueEnum};

use super::flight_arguments::FlightArguments;
use super::{Answer, OutputUnit};
use crate::exports::{self, ExportRequest, ScaleReport};
use crate::fault::Fault;
use crate::flight::{Limits, Verdict, judge_all};
use crate::formats::FileError;
use crate::jobs::Progress;

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The folder to export to; new, or one of an earlier export, which is then completed.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// Scales are in pixels per this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    /// Which photos: all, or those without any doubt.
    #[arg(long, value_enum, default_value = "all")]
    photos: Selection,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Selection {
    All,
    Trusted,
}

/// Opens, computes, judges, exports. `left_out` becomes what makes it fail all the same: photos that could
/// not be exported because their files are damaged.
pub(super) fn export(
    arguments: &ExportArguments,
    left_out: &OnceLock<String>,
    progress: &Progress,
) -> Result<Answer, String> {
    let opened = arguments.flight.open(progress)?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let outcomes = flight.scales(progress).map_err(in_flight)?;
    let views = flight.views(&outcomes, progress).map_err(in_flight)?;
    let limits = Limits::default();
    let files = opened.photo_files.iter().map(|file| &file.state);
    let judged = judge_all(flight, &outcomes, Some(&views), files, &limits);
    let selected: Vec<bool> = judged
        .iter()
        .map(|(verdict, _)| arguments.photos == Selection::All || *verdict == Verdict::Trust)
        .collect();
    if !selected.contains(&true) {
        let fault = Fault::new(
            format!("none of its {} photos is without doubt", judged.len()),
            "export all photos, and read the doubts in the sheet",
        );
        return Err(in_flight(fault));
    }
    let photo_files: Vec<Option<PathBuf>> = opened
        .photo_files
        .iter()
        .map(|file| file.path.clone())
        .collect();
    let unit = arguments.unit.into();
    let summary = exports::export_for_split_desktop(
        &arguments.to,
        &ExportRequest {
            flight,
            outcomes: &outcomes,
            views: &views,
            judged: &judged,
            photo_files: &photo_files,
            selected: &selected,
            unit,
            limits: &limits,
            settings: &opened.settings,
            crs: opened.crs.as_deref(),
            inputs: &opened.inputs,
            warnings: &opened.warnings,
        },
        progress,
    )
    .map_err(|error| error.to_string())?;
    if summary.damaged > 0 {
        let fault = Fault::new(
            format!(
                "{} of {} photos are not exported, because their files are damaged",
                summary.damaged, summary.photos
            ),
            "give whole copies of them and export again: what is there stays",
        );
        // Set once, here.
        let _ = left_out.set(FileError::new(&arguments.to, fault).to_string());
    }
    let report = ScaleReport::new(flight, &outcomes, unit).of_photos(&selected);
    let mut warnings = opened.warnings;
    warnings.extend(summary.warnings.iter().cloned());
    warnings.extend(super::notes_of(&report));
    Ok(Answer {
        text: format!(
            "{}: {summary}
",
            arguments.to.display()
        ),
        warnings,
    })
}
