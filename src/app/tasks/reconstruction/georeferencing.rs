//! Bringing the reconstruction on the screen to the world: fitting it, and writing the flight that is
//! made of it.

use std::path::Path;

use crate::command::{Command, Destination};
use crate::files::{self, FileError, Kind};
use crate::jobs::Progress;
use crate::open_flight::georeferencing::GeoreferenceForm;
use crate::opening::{self, GeoreferenceRequest};
use crate::state::{Severity, State};
use crate::tasks::work::Task;

impl Task {
    /// Fitting a reconstruction to the world.
    pub const GEOREFERENCE: Self = Self::new("Georeferencing").of_flight();
}

impl State {
    /// Types into the small window: a fit of what stood there before does not count any more.
    pub(crate) fn fill_georeference(&mut self, form: GeoreferenceForm) {
        let Some(open) = &mut self.open else {
            return;
        };
        // The length is a note until its distance is taken over.
        let same = GeoreferenceForm {
            length: form.length.clone(),
            ..open.georeferencing.form.clone()
        };
        if same != form {
            open.georeferencing.outcome = None;
            self.work.cancel(Task::GEOREFERENCE);
        }
        open.georeferencing.form = form;
    }

    /// Fits.
    pub(crate) fn start_georeference(&mut self, request: GeoreferenceRequest) {
        let Some(open) = &mut self.open else {
            return;
        };
        let Some(reconstruction) = &open.files.reconstruction else {
            return;
        };
        open.georeferencing.outcome = None;
        let path = reconstruction.path.clone();
        let work = move |progress: &Progress| {
            let result = opening::georeference(&path, &request, progress);
            (request.photos, result.map_err(|error| error.to_string()))
        };
        self.start(Task::GEOREFERENCE, work, |state, outcome| {
            if let Some(open) = &mut state.open {
                open.georeferencing.outcome = Some(outcome);
            }
        });
    }

    /// Writes the georeferenced flight and opens it; asks before a file is replaced.
    pub(crate) fn save_georeferenced(&mut self, to: Destination, keep_surface: bool) {
        let command = move |to| Command::SaveGeoreferenced { to, keep_surface };
        if !self.is_busy(Task::SAVE) && self.may_write(&to, Kind::Flight, &self.read(), command) {
            self.start_saving_georeferenced(to, keep_surface);
        }
    }

    /// The same once that is clear.
    fn start_saving_georeferenced(&mut self, to: Destination, keep_surface: bool) {
        let Destination { path, replace } = to;
        let read = self.read();
        let Some(open) = &self.open else {
            return;
        };
        let known = (&open.files.reconstruction, &open.georeferencing.outcome);
        let (Some(reconstruction), Some((photos, Ok(fitted)))) = known else {
            self.say(
                Severity::Error,
                "nothing is fitted any more; fit once more, then save",
            );
            return;
        };
        let (reconstruction, fitted) = (reconstruction.path.clone(), fitted.clone());
        let photos = photos.clone();
        let surface = open.files.origin.surface().map(Path::to_owned);
        let surface = surface.filter(|_| keep_surface);
        self.asking = None;
        let work = move |_: &Progress| {
            let (photos, surface) = (photos.as_deref(), surface.as_deref());
            let text = fitted.flight_text(&path, &reconstruction, photos, surface);
            let written = text.and_then(|text| {
                files::write(&path, text.as_bytes(), Kind::Flight, &read, replace)
                    .map_err(|fault| FileError::new(&path, fault))
            });
            match written {
                Ok(()) => Ok(path),
                Err(error) => Err(error.to_string()),
            }
        };
        self.start(Task::SAVE, work, |state, saved| match saved {
            Ok(path) => {
                state.say(Severity::Note, &format!("{}: saved", path.display()));
                state.apply(Command::Open(path));
            }
            Err(message) => state.say(Severity::Error, &message),
        });
    }
}
