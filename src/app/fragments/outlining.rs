//! Outlining the fragments of the selected photo, as a job.

use std::sync::Arc;

use super::PhotoOutlines;
use crate::delineation::{self, Delineated, ENGINES};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::labels::Outlines;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::tasks::photos::read_photo;

impl Task {
    /// Outlining a photo's fragments.
    pub const OUTLINE: Self = Self::new("Outlining").of_flight();
}

impl State {
    /// Outlines the selected photo. What is outlined there already can be had back by undo.
    pub(super) fn outline_photo(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        let file = open.files.photo_files.get(photo).cloned();
        let path = file.unwrap_or_default().path;
        let (flight, settings) = (open.flight().clone(), open.settings());
        let Some(engine) = ENGINES.get(open.fragments.engine).copied() else {
            return;
        };
        let number = open.number;
        let name = open.name(photo).to_owned();
        let said = name.clone();
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
            delineation::delineated(engine, &image, &left_out, progress).map_err(of_photo)
        };
        self.start(Task::OUTLINE, work, move |state, found| match found {
            Ok(found) => state.take_outlines(number, photo, found, engine.name()),
            Err(message) => state.say(Severity::Error, &message),
        });
        self.say(Severity::Note, &format!("{said}: outlining its fragments"));
    }

    fn take_outlines(&mut self, number: u64, photo: usize, found: Delineated, engine: &str) {
        let Some(open) = &mut self.open else {
            return;
        };
        if open.number != number {
            return;
        }
        let fragments = &mut open.fragments;
        let Delineated { outlines, regions } = found;
        fragments.regions = Some((photo, Arc::new(regions)));
        fragments.refused = None;
        let count = count(&outlines);
        match fragments.photos.get_mut(&photo) {
            Some(of) => {
                let change = of.now().become_these(&outlines);
                of.make(change);
                engine.clone_into(&mut of.engine);
            }
            None => {
                let of = PhotoOutlines::new(outlines, engine.to_owned(), false);
                fragments.photos.insert(photo, of);
            }
        }
        let text = format!("{}: {count} fragments outlined", open.name(photo));
        self.say(Severity::Note, &text);
        self.measure_fragments();
    }
}

/// How many fragments there are.
pub(super) fn count(outlines: &Outlines) -> usize {
    let areas = outlines.labels().areas();
    areas.iter().skip(1).filter(|area| **area > 0).count()
}
