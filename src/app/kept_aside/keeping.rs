//! Writes what is not saved into this window's folder.

use std::path::PathBuf;
use std::sync::Arc;

use super::folder::KeptFolder;
use super::{Kept, KeptOf};
use crate::exports;
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind};
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::opening::{control_file, outline_files};
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Keeping aside what is not saved.
    pub const KEEP_ASIDE: Self = Self::new("Keeping changes aside").to_the_end();
}

impl Kept {
    fn of(open: &OpenFlight) -> Self {
        Self {
            flight: open.number,
            settings: open.settings_to_save(),
            outlines: open.fragments.revisions(),
        }
    }
}

impl State {
    pub(super) fn is_keeping(&self) -> bool {
        self.work.is_running(Task::KEEP_ASIDE)
    }

    pub(super) fn start_keeping(&mut self) {
        let (Some(open), Some(root)) = (&self.open, &self.kept_aside.root) else {
            return;
        };
        let (now, settings) = (Kept::of(open), open.settings_to_save());
        let origin = open.files.origin.clone();
        let is_kept = self.kept_aside.kept.as_ref() == Some(&now);
        if is_kept || origin.check_saved(&settings).is_err() {
            return;
        }
        let before = self.kept_aside.kept.as_ref();
        let before = before.filter(|before| before.flight == now.flight);
        let before = before.map(|before| before.outlines.clone());
        let of = KeptOf {
            name: open.flight().parts().name.clone(),
            file: open.files.proposed(None),
        };
        let folder = match (&self.kept_aside.own, &before) {
            (Some(own), Some(_)) => own.clone(),
            // Of a flight before this one nothing is left in a new one.
            _ => match KeptFolder::make(root) {
                Ok(folder) => Arc::new(folder),
                Err(error) => {
                    let what = format!("it cannot be written ({error})");
                    let fault = Fault::new(what, "save the flight often");
                    let error = FileError::new(root, fault);
                    return self.say_not_kept(&error);
                }
            },
        };
        let path = folder.flight_file();
        let list = open.control_to_save(&path);
        let (mut outlines, mut copied) = open.outlines_to_save(&path);
        let mut gone: Vec<PathBuf> = Vec::new();
        if let Some(before) = &before {
            // The files of the others are there already.
            copied.clear();
            outlines.retain(|of| !before.contains(&(of.photo, of.revision)));
            let stems = exports::photo_file_stems(open.flight());
            let is_now = |photo: usize| now.outlines.iter().any(|(now, _)| *now == photo);
            let photos = before.iter().map(|(photo, _)| *photo);
            let stems = photos
                .filter(|photo| !is_now(*photo))
                .filter_map(|photo| stems.get(photo));
            gone.extend(stems.flat_map(|stem| outline_files(&path, stem)));
            if list.is_none() {
                gone.push(control_file(&path));
            }
        }
        let own = folder.clone();
        let work = move |_: &Progress| -> Result<(), FileError> {
            let read = Inputs::default();
            let at = |path: &PathBuf| {
                let path = path.clone();
                move |fault| FileError::new(&path, fault)
            };
            for path in gone {
                // It is not there where nothing of it was kept.
                let _ = std::fs::remove_file(path);
            }
            copied.iter().try_for_each(|copied| copied.write(&read))?;
            outlines.iter().try_for_each(|of| of.write(&read))?;
            list.iter().try_for_each(|list| list.write(&read))?;
            let text = origin.text_at(&path, &settings)?;
            files::write(&path, text.as_bytes(), Kind::Flight, &read, true).map_err(at(&path))?;
            let whose = folder.whose_file();
            let json = serde_json::to_vec(&of).map_err(|error| {
                let what = format!("the flight's place cannot be written down ({error})");
                at(&whose)(Fault::new(what, "save the flight often"))
            })?;
            // The window may have been closed meanwhile.
            if folder.is_there() {
                files::write(&whose, &json, Kind::Result, &read, true).map_err(at(&whose))?;
            }
            Ok(())
        };
        self.kept_aside.own = Some(own);
        self.start(Task::KEEP_ASIDE, work, |state, kept| match kept {
            Ok(()) => state.kept_aside.kept = Some(now),
            Err(error) => state.say_not_kept(&error),
        });
    }

    /// Said once: she saves more often then.
    fn say_not_kept(&mut self, error: &FileError) {
        if !std::mem::replace(&mut self.kept_aside.has_failed, true) {
            let sentence = format!("changes that are not saved cannot be kept aside: {error}");
            self.say(Severity::Warning, &sentence);
        }
    }
}
