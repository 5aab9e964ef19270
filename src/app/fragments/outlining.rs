//! Outlining the fragments of the selected photo, as a job.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::PhotoOutlines;
use crate::command::Asking;
use crate::delineation::{self, Delineated, Outliner, Regions};
use crate::exports;
use crate::fault::Fault;
use crate::files::last_segment;
use crate::flight::Photo;
use crate::jobs::Progress;
use crate::labels::{LabelImage, Outlines};
use crate::opening::{OutlinesOfOthers, saved_outlines};
use crate::scale::ImageKind;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::tasks::photos::read_photo;

/// What outlines of other tools are called in files.
const MASKS: &str = "masks";

impl Task {
    /// Outlining a photo's fragments.
    pub const OUTLINE: Self = Self::new("Outlining").of_flight();
    /// Reading outlines of another tool.
    pub const READ_MASKS: Self = Self::new("Reading outlines of another tool").of_flight();
}

impl State {
    /// Outlines the selected photo. What is outlined there already can be had back by undo.
    pub(super) fn outline_photo(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.fragments.waiting.clear();
        open.fragments.outlines_all = false;
        if let Some(photo) = open.selected {
            self.outline(photo);
        }
    }

    /// Outlines all photos that are not outlined yet, on the screen or in files; then says what all come to.
    pub(super) fn outline_all(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        let own = open.files.origin.flight_file();
        let stems = exports::photo_file_stems(open.flight());
        let is_saved = |stem: &str| own.is_some_and(|own| saved_outlines(own, stem).is_some());
        let photos = stems
            .iter()
            .enumerate()
            .filter(|(photo, stem)| open.fragments.of(*photo).is_none() && !is_saved(stem));
        let photos = photos.map(|(photo, _)| photo).collect();
        open.fragments.waiting = photos;
        open.fragments.outlines_all = true;
        self.outline_next();
    }

    fn outline_next(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.fragments.outlining = None;
        if let Some(photo) = open.fragments.waiting.pop_front() {
            self.outline(photo);
        } else if std::mem::take(&mut open.fragments.outlines_all) {
            self.measure_all_fragments();
        }
    }

    fn outline(&mut self, photo: usize) {
        let Some(open) = &mut self.open else {
            return;
        };
        let Some(engine) = self.network.engine(open.fragments.engine) else {
            return;
        };
        let file = open.files.photo_files.get(photo).cloned();
        let path = file.unwrap_or_default().path;
        let (flight, settings) = (open.flight().clone(), open.settings());
        let name = open.name(photo).to_owned();
        let (said, of) = (name.clone(), (open.first_number, name.clone()));
        open.fragments.outlining = Some(photo);
        let camera = flight.camera(&flight.parts().photos[photo]);
        let mut by = Outliner {
            engine: engine.engine().name().to_owned(),
            habits: Some(engine.engine().habits(camera.width, camera.height)),
            spread: None,
        };
        let work = move |progress: &Progress| -> Result<Delineated, String> {
            let missing = || format!("the file of photo '{name}' is not there");
            let pixels = read_photo(&path.ok_or_else(missing)?)?;
            let posed = &flight.parts().photos[photo];
            let camera = flight.camera(posed);
            let of_photo = |fault: Fault| format!("photo '{name}': {fault}");
            let image = delineation::photo::undistorted(&pixels, camera).map_err(of_photo)?;
            drop(pixels);
            let left_out = delineation::photo::left_out(&settings, posed, camera);
            progress.stage("outlining");
            let engine = engine.engine();
            delineation::delineated(engine, &image, &left_out, progress).map_err(of_photo)
        };
        self.start(Task::OUTLINE, work, move |state, found| {
            match found {
                Ok(found) => {
                    let Delineated {
                        outlines,
                        regions,
                        spread,
                    } = found;
                    by.spread = spread;
                    state.take_outlines(&of, outlines, Some(regions), by, Vec::new());
                }
                Err(message) => state.say(Severity::Error, &message),
            }
            state.outline_next();
        });
        let text = format!("{said}: outlining its fragments");
        self.say_of_photo(Severity::Note, &text, Some(photo));
    }

    /// Takes the selected photo's outlines from a file of another tool, or a folder of them.
    pub(super) fn read_masks(&mut self, path: PathBuf, of: Option<ImageKind>) {
        let Some(open) = &mut self.open else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        open.fragments.masks_refused = None;
        let (flight, settings) = (open.flight().clone(), open.settings());
        let of_photo = (open.first_number, open.name(photo).to_owned());
        let files = open.files.photo_files.clone();
        let called = last_segment(&path.to_string_lossy()).to_owned();
        let work = move |_: &Progress| -> Result<(LabelImage, Vec<String>), String> {
            let others = OutlinesOfOthers::open(&path, of).map_err(|error| error.to_string())?;
            let posed = &flight.parts().photos[photo];
            let camera = flight.camera(posed);
            let left_out = delineation::photo::left_out(&settings, posed, camera);
            // She says which photo it is.
            let file = files.get(photo).and_then(|file| file.path.as_deref());
            // A photo that cannot be read says so where it is shown.
            let pixels = files.get(photo).and_then(|file| file.pixels()?.ok());
            let pixels = pixels.and_then(|of| delineation::photo::undistorted(&of, camera).ok());
            let masks =
                others.of_flights_photo(&flight, (photo, file), pixels.as_ref(), &left_out, true);
            let masks = masks.map_err(|fault| fault.to_string())?;
            Ok((masks.labels, masks.notes))
        };
        self.start(Task::READ_MASKS, work, move |state, read| match read {
            Ok((labels, notes)) => {
                state.mended(Task::READ_MASKS);
                let notes = notes.into_iter().map(|note| format!("{called}: {note}"));
                let notes: Vec<String> = notes.collect();
                for note in &notes {
                    let text = format!("{}: {note}", of_photo.1);
                    state.say(Severity::Warning, &text);
                }
                // A person or another tool looked at all of them.
                let outlines = Outlines::new(labels, BTreeMap::new());
                let by = Outliner {
                    engine: MASKS.to_owned(),
                    ..Outliner::default()
                };
                state.take_outlines(&of_photo, outlines, None, by, notes);
                if state.asking == Some(Asking::Masks) {
                    state.asking = None;
                }
            }
            Err(message) => {
                state.say_until_mended(Task::READ_MASKS, &message);
                if let Some(open) = &mut state.open {
                    open.fragments.masks_refused = Some(message);
                }
            }
        });
    }

    /// Takes outlines, of which that is to be said, of the photo of that name in the flight whose first reading had that number: it may have been read again since.
    fn take_outlines(
        &mut self,
        (first_number, name): &(u64, String),
        outlines: Outlines,
        regions: Option<Regions>,
        by: Outliner,
        notes: Vec<String>,
    ) {
        let Some(open) = &mut self.open else {
            return;
        };
        if open.first_number != *first_number {
            return;
        }
        let parts = open.flight().parts();
        let size = (outlines.labels().width, outlines.labels().height);
        let is_meant = |photo: &Photo| {
            let camera = open.flight().camera(photo);
            photo.name == *name && size == (camera.width as usize, camera.height as usize)
        };
        let Some(photo) = parts.photos.iter().position(is_meant) else {
            let text = format!(
                "photo '{name}' has changed since: outline it, or read its outlines, again"
            );
            self.say(Severity::Warning, &text);
            return;
        };
        let fragments = &mut open.fragments;
        if let Some(regions) = regions.filter(|_| open.selected == Some(photo)) {
            fragments.regions = Some((photo, Arc::new(regions)));
        }
        fragments.refused = None;
        let count = count(&outlines);
        match fragments.photos.get_mut(&photo) {
            Some(of) => of.outline_anew(&outlines, by, notes),
            None => {
                let of = PhotoOutlines::first(&outlines, by, notes);
                fragments.photos.insert(photo, of);
            }
        }
        let text = format!("{}: {count} fragments outlined", open.name(photo));
        self.say_of_photo(Severity::Note, &text, Some(photo));
        self.measure_fragments();
    }
}

/// How many fragments there are.
pub(super) fn count(outlines: &Outlines) -> usize {
    let areas = outlines.labels().areas();
    areas.iter().skip(1).filter(|area| **area > 0).count()
}
