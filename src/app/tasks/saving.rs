//! Saving the flight.

use std::path::PathBuf;

use super::work::Task;
use crate::command::{Asking, Command, Destination};
use crate::files::{self, Kind};
use crate::flight::FlightSettings;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{FlightOrigin, OpenOptions, control_file};
use crate::state::{Severity, State};

impl Task {
    /// Writing flight.toml.
    pub const SAVE: Self = Self::new("Saving").writing().to_the_end();
}

impl State {
    /// Writes flight.toml where it was read, or asks where to.
    pub(crate) fn save(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        match open.files.origin.flight_file() {
            // The bundled flight stays as it came, and what was kept aside is saved where it was.
            Some(path) if !open.files.stays() => {
                let path = path.to_owned();
                self.save_as(path.into());
            }
            _ => self.ask_where_to_save(),
        }
    }

    /// Asks for the file, where there is something to be saved.
    pub(crate) fn ask_where_to_save(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        match open.files.origin.check_saved(&open.settings_to_save()) {
            Ok(()) => self.ask(Some(Asking::SaveAs)),
            Err(fault) => {
                self.after_saving = None;
                self.say(Severity::Error, &fault.to_string());
            }
        }
    }

    /// Writes flight.toml at a place; asks before another file is replaced.
    pub(crate) fn save_as(&mut self, to: Destination) {
        // Another small window stays.
        if self.asking == Some(Asking::SaveAs) {
            self.asking = None;
        }
        if self.open.is_none() || self.is_busy(Task::SAVE) {
            return;
        }
        self.take_notes();
        let own = self.open.as_ref().filter(|open| !open.files.stays());
        let own = own.and_then(|open| open.files.origin.flight_file());
        if own.is_some_and(|own| files::is_same_file(own, &to.path)) {
            if to.replace || !self.asks_for_changed(&to) {
                self.start_saving(to.path, true);
            }
            return;
        }
        let read = self.read_beside(&to.path);
        if self.may_write(&to, Kind::Flight, &read, Command::SaveAs) {
            self.start_saving(to.path, to.replace);
        } else if self.held_back.is_none() {
            // Not saved, and nothing to answer.
            self.after_saving = None;
        }
    }

    /// Asks, where another window or program has changed what saving would write since it was read; whether it does.
    fn asks_for_changed(&mut self, to: &Destination) -> bool {
        let Some(open) = &self.open else {
            return false;
        };
        let path = open.files.origin.flight_file().unwrap_or(&to.path);
        let (outlines, _) = open.outlines_to_save(path);
        let list = open.control_to_save(path).map(|_| control_file(path));
        let beside = outlines.iter().flat_map(|of| &of.files).chain(&list);
        let paths = [path].into_iter().chain(beside.map(PathBuf::as_path));
        let changed = open.files.stood.changed(paths);
        let Some(changed) = changed.map(|path| path.display().to_string()) else {
            return false;
        };
        let there = format!(
            "{changed} was changed since it was read here, by another window or program: what was changed there would be lost. (To keep \
             both, save under another name.)"
        );
        self.ask_to_replace(to, there, Command::SaveAs);
        true
    }

    /// Writes flight.toml; with `replace` over a file that is there.
    fn start_saving(&mut self, path: PathBuf, replace: bool) {
        let read = self.read_beside(&path);
        let Some(open) = &self.open else {
            return;
        };
        let (settings, origin) = (open.settings_to_save(), open.files.origin.clone());
        let flight = origin.clone();
        let list = open.control_to_save(&path);
        let (outlines, copied) = open.outlines_to_save(&path);
        let work = move |_: &Progress| {
            let beside = || -> Result<Vec<(usize, u64)>, FileError> {
                copied.iter().try_for_each(|copied| copied.write(&read))?;
                outlines
                    .iter()
                    .try_for_each(|outlines| outlines.write(&read))?;
                let saved = outlines.iter();
                Ok(saved.map(|of| (of.photo, of.revision)).collect())
            };
            let text = origin.text_at(&path, &settings);
            let with_list = text.and_then(|text| {
                list.iter().try_for_each(|list| list.write(&read))?;
                Ok(text)
            });
            let saved = with_list.and_then(|text| {
                files::write(&path, text.as_bytes(), Kind::Flight, &read, replace)
                    .map_err(|fault| FileError::new(&path, fault))
            });
            match saved {
                Ok(()) => match beside() {
                    Ok(outlines) => Ok((origin.saved_at(&path), settings, outlines)),
                    Err(error) => Err((error.to_string(), Some(path))),
                },
                Err(error) => Err((error.to_string(), None)),
            }
        };
        self.start(Task::SAVE, work, move |state, saved| match saved {
            Ok((origin, settings, outlines)) => {
                // Before it is asked whether anything is left to save.
                if state.is_on_screen(&flight) {
                    state.take_saved_outlines(&outlines);
                }
                state.take_saved(&flight, origin, settings);
            }
            Err((message, written)) => {
                // What was written before it failed nobody else has changed.
                if state.is_on_screen(&flight)
                    && let (Some(open), Some(written)) = (&mut state.open, written)
                {
                    open.files.stood.note_flight(&written);
                }
                state.after_saving = None;
                state.say(Severity::Error, &message);
            }
        });
    }

    fn is_on_screen(&self, flight: &FlightOrigin) -> bool {
        let open = self.open.as_ref();
        open.is_some_and(|open| open.files.origin == *flight)
    }

    /// Takes that the flight of this origin was saved: where, with these settings.
    fn take_saved(
        &mut self,
        flight: &FlightOrigin,
        origin: FlightOrigin,
        settings: FlightSettings,
    ) {
        if let Some(path) = origin.flight_file() {
            let path = path.to_owned();
            self.preferences.remember(&path);
            self.say(Severity::Note, &format!("{}: saved", path.display()));
        }
        // She may have gone on to another flight meanwhile.
        let on_screen = self
            .open
            .as_mut()
            .filter(|open| open.files.origin == *flight);
        if let Some(open) = on_screen {
            if let Some(path) = origin.flight_file() {
                open.files.path = path.to_owned();
                // They stand in the file now.
                open.files.options = OpenOptions::default();
            }
            (open.files.bundled, open.files.kept) = (false, None);
            if let Some(path) = origin.flight_file() {
                open.files.read.add(path);
            }
            open.files.origin = origin;
            open.files.saved = settings;
            open.note_saved();
            self.warn_of_waiting_notes();
        }
        let changed = self.open.as_ref().is_some_and(|open| open.is_changed());
        match self.after_saving.take() {
            // Changed again meanwhile: she is asked again.
            Some(held_back) if changed => self.held_back = Some(held_back),
            Some(held_back) => self.go_on(held_back),
            None => {}
        }
    }
}
