//! `fragscale export`: the folder for Split-Desktop.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::flight_arguments::FlightArguments;
use super::named_photos::NamedPhotos;
use super::outputs::Force;
use super::{Answer, OutputUnit};
use crate::exports::{self, ExportRequest, Provenance, Replace, ScaleReport};
use crate::fault::Fault;
use crate::flight::{Along, Limits, Review};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{Opened, apart_from_photos};
use crate::scale::Onto;

#[derive(Debug, Args)]
pub(super) struct ExportArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The folder to export to; new, or one of an earlier export, which is then completed. (What that has of photos that are
    /// not written now, as where --photo names others, is taken away.)
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// Scales are in pixels per this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    /// Which photos, without those that the flight's reviews leave out: all, or those without any doubt
    /// and those that were accepted.
    #[arg(long, value_enum, default_value = "all")]
    photos: Selection,
    #[command(flatten)]
    named: NamedPhotos,
    /// Also write each photo seen squarely, with one scale for the whole image: onto the best plane
    /// through what it shows, onto a horizontal plane, or laid over the surface from straight above.
    #[arg(long, value_enum, value_name = "ONTO")]
    rectified: Option<Rectified>,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Rectified {
    Fit,
    Horizontal,
    Ortho,
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
enum Selection {
    All,
    Trusted,
}

/// Opens, reviews, exports. It fails at its end where photos could not be exported because
/// their files are damaged; the others are.
pub(super) fn export(arguments: &ExportArguments, progress: &Progress) -> Result<Answer, String> {
    let opened = arguments.flight.open(progress)?;
    let (answer, _) = export_of(arguments, &opened, progress)?;
    Ok(answer)
}

/// The same of a flight that is open, with its review.
pub(super) fn export_of(
    arguments: &ExportArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<(Answer, Review), String> {
    for folder in exports::export_folders(&arguments.to) {
        apart_from_photos(&folder, &opened.photo_files).map_err(|error| error.to_string())?;
    }
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let review = opened.review(&Limits::default(), progress);
    let review = review.map_err(in_flight)?;
    let named = arguments.named.of(&opened.flight).map_err(in_flight)?;
    let mut selected = review.going_along(match arguments.photos {
        Selection::All => Along::All,
        Selection::Trusted => Along::Trusted,
    });
    let mut not_along = Vec::new();
    for (photo, (selected, is_named)) in review.photos().zip(selected.iter_mut().zip(&named)) {
        if arguments.named.is_any() && *is_named && !*selected {
            let why = match photo.goes_along(Along::All) {
                true => "it has a doubt that nobody has accepted",
                false => "a [[review]] table leaves it out",
            };
            not_along.push(format!("photo '{}' is not exported: {why}", photo.name()));
        }
        *selected &= is_named;
    }
    if !selected.contains(&true) {
        let count = named.iter().filter(|named| **named).count();
        let is_all = count == review.count();
        let named = if is_all { "" } else { " that are named" };
        let its = if is_all { "its" } else { "the" };
        let (all, none) = match (count, is_all) {
            (1, false) => (
                "the photo that is named is".to_owned(),
                "the photo that is named is not".to_owned(),
            ),
            _ => (
                format!("all of {its} {count} photos{named} are"),
                format!("none of {its} {count} photos{named} is"),
            ),
        };
        let fault = match arguments.photos {
            Selection::All => Fault::new(
                format!("{all} left out by [[review]] tables"),
                "remove those that do not hold",
            ),
            Selection::Trusted => Fault::new(
                format!("{none} without doubt or accepted"),
                "export all photos, and read the doubts in the sheet",
            ),
        };
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
            review: &review,
            from: &Provenance {
                file: opened.origin.file(),
                inputs: &opened.inputs,
                read: &opened.read,
                photo_files: &photo_files,
                settings: &opened.settings,
                crs: opened.crs.as_deref(),
                warnings: &opened.all_warnings(),
            },
            selected: &selected,
            unit,
            rectified: arguments.rectified.map(|onto| match onto {
                Rectified::Fit => Onto::FittedPlane,
                Rectified::Horizontal => Onto::HorizontalPlane,
                Rectified::Ortho => Onto::Surface,
            }),
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
    let report = ScaleReport::new(&review, unit).of_photos(&selected);
    let mut warnings = opened.all_warnings();
    warnings.extend(not_along);
    warnings.extend(summary.warnings.iter().cloned());
    warnings.extend(super::scales::notes_of(&report));
    let answer = Answer {
        text: format!("{}: {summary}\n", arguments.to.display()),
        warnings,
        failed,
    };
    Ok((answer, review))
}
