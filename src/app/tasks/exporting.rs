//! Exporting the chosen photos.

use std::path::PathBuf;
use std::time::Instant;

use super::stood::changed_in_words;
use super::work::Task;
use crate::command::Destination;
use crate::exports::{self, ExportRequest, Provenance, Replace};
use crate::flight::{Along, Doubt};
use crate::jobs::Progress;
use crate::opening;
use crate::scale::Onto;
use crate::state::{Severity, State};

impl Task {
    /// Writing the export folder.
    pub const EXPORT: Self = Self::new("Export").writing();
}

impl State {
    /// Exports the chosen photos; asks before the export of another flight is replaced.
    pub(crate) fn export(&mut self, to: Destination) {
        self.asking = None;
        if !self.is_busy(Task::EXPORT) && self.may_export(&to) {
            let replace = match to.replace {
                true => Replace::OtherFlight,
                false => Replace::Nothing,
            };
            self.start_export(to.path, replace);
        }
    }

    /// Exports the chosen photos, into a folder with the export of another flight where that may be
    /// replaced.
    fn start_export(&mut self, folder: PathBuf, replace: Replace) {
        let read = self.read();
        let Some(open) = &self.open else {
            return;
        };
        if !open.review.is_looked_at() || !open.is_computed() {
            self.say(
                Severity::Error,
                "scales, footprints and scale fields are still being computed; export when they are there",
            );
            return;
        }
        let mut review = open.review.clone();
        let photo_files = open.files.photo_files.clone();
        let seen = open.review.going_along(Along::Trusted);
        let unit = self.preferences.unit();
        let rectified = (self.preferences.export_rectified).then_some(Onto::FittedPlane);
        let settings = open.settings_to_save();
        let (crs, inputs) = (open.files.crs.clone(), open.files.inputs.clone());
        let mut warnings = open.all_warnings();
        let read_as = open.files.read_as.clone();
        let source = open.files.origin.file().to_owned();
        // For who finds the export later, and that file beside it: she knows.
        warnings.extend(open.is_changed().then(|| {
            format!(
                "{}: the export is of the flight as it was in the window, with changes that were not saved in this file",
                source.display()
            )
        }));
        let work = move |progress: &Progress| {
            let begun = Instant::now();
            for folder in exports::export_folders(&folder) {
                let apart = opening::apart_from_photos(&folder, &photo_files);
                apart.map_err(|error| error.to_string())?;
            }
            let changed = read_as.all_changed();
            let changed: Vec<String> = changed.iter().map(|path| changed_in_words(path)).collect();
            warnings.extend(changed.iter().cloned());
            // Those that the window has not come to yet.
            let compared = opening::compare_all_pixels(&mut review, &photo_files, progress);
            compared.map_err(|fault| fault.to_string())?;
            let selected = review.going_along(Along::Trusted);
            let files = photo_files.iter().map(|file| file.path.clone());
            let files: Vec<Option<PathBuf>> = files.collect();
            let request = ExportRequest {
                review: &review,
                from: &Provenance {
                    file: &source,
                    inputs: &inputs,
                    read: &read,
                    photo_files: &files,
                    settings: &settings,
                    crs: crs.as_deref(),
                    warnings: &warnings,
                },
                selected: &selected,
                unit,
                rectified,
                replace,
            };
            let exported = exports::export_for_split_desktop(&folder, &request, progress);
            let summary = exported.map_err(|error| error.to_string())?;
            let sentence = format!("{}: {summary}", folder.display());
            let name = review.flight().parts().name.clone();
            let mut warnings = summary.warnings;
            warnings.extend(changed);
            let lost = review.photos().zip(seen.iter().zip(&selected));
            let lost = lost.filter(|(_, (seen, is_selected))| **seen && !**is_selected);
            warnings.extend(lost.map(|(photo, _)| {
                let why = photo.doubts.first().map(Doubt::to_string);
                let why = why.unwrap_or_default();
                format!("{}: not exported: {why}", photo.name())
            }));
            Ok((sentence, warnings, name, begun.elapsed()))
        };
        self.start(Task::EXPORT, work, |state, exported: Result<_, String>| {
            let (sentence, warnings, flight, took) = match exported {
                Ok(exported) => exported,
                Err(message) => return state.say_until_mended(Task::EXPORT, &message),
            };
            state.mended(Task::EXPORT);
            state.note_step("Export", &flight, took);
            for warning in warnings {
                state.say(Severity::Warning, &warning);
            }
            state.say(Severity::Note, &sentence);
        });
    }
}
