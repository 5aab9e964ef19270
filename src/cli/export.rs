//! `fragscale export`: the folder for Split-Desktop.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::flight_arguments::FlightArguments;
use super::outputs::Force;
use super::{Answer, OutputUnit};
use crate::exports::{self, ExportRequest, Replace, ScaleReport};
use crate::fault::Fault;
use crate::flight::{Limits, Verdict, judge_all};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening;

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
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Selection {
    All,
    Trusted,
}

/// Opens, computes, judges, exports. It fails at its end where photos could not be exported because
/// their files are damaged; the others are.
pub(super) fn export(arguments: &ExportArguments, progress: &Progress) -> Result<Answer, String> {
    let opened = arguments.flight.open(progress)?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let flight = &opened.flight;
    let outcomes = flight.scales(progress).map_err(in_flight)?;
    let views = flight.views(&outcomes, progress).map_err(in_flight)?;
    let limits = Limits::default();
    let colours = opening::compare_colours(flight, &opened.photo_files, &[], progress);
    let colours = colours.map_err(in_flight)?;
    let evidence = opening::with_colours(&opened.looked_up.evidence, colours.iter().map(Some));
    let judged = judge_all(flight, &outcomes, Some(&views), &evidence, &limits);
    let selected: Vec<bool> = judged
        .iter()
        .map(|judged| arguments.photos == Selection::All || judged.verdict == Verdict::Trust)
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
            evidence: &evidence,
            judged: &judged,
            photo_files: &photo_files,
            selected: &selected,
            unit,
            limits: &limits,
            settings: &opened.settings,
            crs: opened.crs.as_deref(),
            inputs: &opened.inputs,
            warnings: &opened.all_warnings(),
            read: &opened.read,
            source: opened.origin.file(),
            replace: match arguments.force.force {
                true => Replace::Anything,
                false => Replace::Nothing,
            },
        },
        progress,
    )
    .map_err(|error| error.to_string())?;
    let failed = (summary.damaged > 0).then(|| {
        let fault = Fault::new(
            format!(
                "{} of {} photos are not exported, because their files are damaged",
                summary.damaged, summary.photos
            ),
            "give whole copies of them and export again: what is there stays",
        );
        FileError::new(&arguments.to, fault).to_string()
    });
    let report = ScaleReport::new(flight, &outcomes, unit)
        .with_evidence(&evidence)
        .of_photos(&selected);
    let mut warnings = opened.all_warnings();
    warnings.extend(summary.warnings.iter().cloned());
    warnings.extend(super::notes_of(&report));
    Ok(Answer {
        text: format!("{}: {summary}\n", arguments.to.display()),
        warnings,
        failed,
    })
}
