//! Outlines saved beside flight.toml, `fragments/NAME.png` with `fragments/NAME_outlines.json`, and read from there.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::PhotoOutlines;
use crate::delineation::saved::{SavedOutlines, lens_of};
use crate::exports;
use crate::files::{self, FileError, Inputs, Kind};
use crate::formats;
use crate::jobs::Progress;
use crate::labels::Outlines;
use crate::open_flight::OpenFlight;
use crate::opening::{outline_files, read_outlines, saved_outlines};
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::tasks::stood::Stood;

impl Task {
    /// Reading saved outlines.
    pub const READ_OUTLINES: Self = Self::new("Reading outlines").of_flight();
}

/// Outlines that are to be written.
pub(crate) struct OutlinesToSave {
    /// Whose.
    pub photo: usize,
    /// Which of its revisions.
    pub revision: u64,
    pub(crate) files: [PathBuf; 2],
    /// `None` where what the files hold is undone.
    outlines: Option<Arc<Outlines>>,
    saved: SavedOutlines,
    /// Where the photo is.
    photo_file: Option<PathBuf>,
}

/// What of a photo's outlines is saved where another flight.toml is written: the files as they are.
pub(crate) struct OutlinesToCopy {
    from: [PathBuf; 2],
    to: [PathBuf; 2],
}

impl OpenFlight {
    /// The outlines that go along where the flight is saved at `path`.
    pub(crate) fn outlines_to_save(
        &self,
        path: &Path,
    ) -> (Vec<OutlinesToSave>, Vec<OutlinesToCopy>) {
        let own = self.files.origin.flight_file();
        let is_own = own.is_some_and(|own| files::is_same_file(own, path));
        let stems = exports::photo_file_stems(self.flight());
        let to_save = self.fragments.photos.iter();
        let to_save = to_save.filter(|(_, of)| match of.is_nothing() {
            true => is_own && of.is_changed(),
            false => !is_own || of.is_changed(),
        });
        let to_save = to_save.filter_map(|(photo, of)| {
            let camera = self.review.photo(*photo)?.camera;
            Some(OutlinesToSave {
                photo: *photo,
                revision: of.revision,
                files: outline_files(path, stems.get(*photo)?),
                outlines: (!of.is_nothing()).then(|| of.editing.shared()),
                photo_file: self.photo_file(*photo),
                saved: SavedOutlines {
                    photo: self.name(*photo).to_owned(),
                    picture: None,
                    by: of.by().clone(),
                    lens: lens_of(camera),
                    sure: of.now().all_sure().clone(),
                },
            })
        });
        let others = stems.iter().enumerate();
        let others = others.filter(|(photo, _)| self.fragments.of(*photo).is_none());
        let to_copy = others.filter_map(|(_, stem)| {
            let from = saved_outlines(own.filter(|_| !is_own)?, stem)?;
            let to = outline_files(path, stem);
            Some(OutlinesToCopy { from, to })
        });
        (to_save.collect(), to_copy.collect())
    }

    /// Where a photo's file is; `None` where it is not.
    fn photo_file(&self, photo: usize) -> Option<PathBuf> {
        self.files.photo_files.get(photo)?.path.clone()
    }

    /// Notes the files of the flight, which was just saved, as they stand now.
    pub(crate) fn note_saved(&mut self) {
        let Some(own) = self.files.origin.flight_file() else {
            return;
        };
        let stems = exports::photo_file_stems(self.flight());
        let photos = self.fragments.photos.keys();
        let outlines = photos.filter_map(|photo| stems.get(*photo));
        let outlines = outlines.flat_map(|stem| outline_files(own, stem));
        let outlines: Vec<PathBuf> = outlines.collect();
        let own = own.to_owned();
        self.files.stood.note_flight(&own);
        for path in &outlines {
            self.files.stood.note(path);
        }
    }
}

impl OutlinesToSave {
    /// Writes both files, or takes them away.
    ///
    /// # Errors
    /// Why they may not be written, or what the system says.
    pub(crate) fn write(&self, read: &Inputs) -> Result<(), FileError> {
        let [picture, json] = &self.files;
        let Some(outlines) = &self.outlines else {
            for path in &self.files {
                let own = read.clone().without(path);
                if files::standing(path, Kind::Result, &own) == files::Standing::Ours {
                    // What cannot be taken away is there again when the flight is opened, and can be undone again.
                    let _ = std::fs::remove_file(path);
                }
            }
            return Ok(());
        };
        let bytes = exports::labels_png(outlines.labels())
            .map_err(|fault| FileError::new(picture, fault))?;
        let photo = self.photo_file.as_deref();
        let saved = SavedOutlines {
            picture: photo.and_then(|file| files::sha256_of_file(file, || false).ok()),
            ..self.saved.clone()
        };
        write_both([picture, json], [&bytes, saved.to_json().as_bytes()], read)
    }
}

impl OutlinesToCopy {
    /// Copies both files.
    ///
    /// # Errors
    /// As above, and where they cannot be read.
    pub(crate) fn write(&self, read: &Inputs) -> Result<(), FileError> {
        let [picture, json] = &self.from;
        let picture = formats::read_bytes(picture)?;
        let json = formats::read_bytes(json)?;
        let [to_picture, to_json] = &self.to;
        write_both([to_picture, to_json], [&picture, &json], read)
    }
}

/// Writes a picture and what it is of, over their own earlier ones at most.
fn write_both(paths: [&PathBuf; 2], bytes: [&[u8]; 2], read: &Inputs) -> Result<(), FileError> {
    if let Some(folder) = paths[0].parent() {
        files::make_folder(folder)?;
    }
    for (path, bytes) in paths.into_iter().zip(bytes) {
        let read = read.clone().without(path);
        let at = |fault| FileError::new(path, fault);
        let is_ours = files::standing(path, Kind::Result, &read) == files::Standing::Ours;
        files::write(path, bytes, Kind::Result, &read, is_ours).map_err(at)?;
    }
    Ok(())
}

impl State {
    /// Reads the selected photo's outlines, where files beside the flight have them and none are there.
    pub(crate) fn read_outlines(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        let fragments = &open.fragments;
        let is_read = self.work.is_running(Task::READ_OUTLINES) && fragments.reading == Some(photo);
        if is_read || fragments.sought.contains(&photo) || fragments.of(photo).is_some() {
            return;
        }
        let Some(own) = open.files.origin.flight_file() else {
            return;
        };
        let stems = exports::photo_file_stems(open.flight());
        let stem = stems.get(photo);
        let files = stem.and_then(|stem| saved_outlines(own, stem));
        let Some(files) = files else {
            for path in stem.into_iter().flat_map(|stem| outline_files(own, stem)) {
                open.files.stood.note(&path);
            }
            open.fragments.sought.push(photo);
            return;
        };
        // As long as they are not read they are somebody's: saving asks before it writes over them. A job that the next photo
        // ends leaves it at that, and they are sought once more.
        for path in &files {
            open.files.stood.note_not_taken(path);
        }
        open.fragments.reading = Some(photo);
        let (flight, number) = (open.flight().clone(), open.number);
        let photo_file = open.photo_file(photo);
        let work = move |_: &Progress| {
            let mut stood = Stood::default();
            files.iter().for_each(|path| stood.note(path));
            let posed = &flight.parts().photos[photo];
            let read = read_outlines(
                &files,
                &posed.name,
                flight.camera(posed),
                photo_file.as_deref(),
            );
            (read, stood)
        };
        self.start(Task::READ_OUTLINES, work, move |state, (read, stood)| {
            let open = state.open.as_mut();
            let Some(open) = open.filter(|open| open.number == number) else {
                return;
            };
            open.fragments.sought.push(photo);
            match read {
                // What was outlined meanwhile stays.
                Ok(_) if open.fragments.of(photo).is_some() => {}
                Ok(read) => {
                    open.files.stood.take(stood);
                    let of = PhotoOutlines::saved(read.outlines, read.by);
                    open.fragments.photos.insert(photo, of);
                    for note in &read.notes {
                        state.say(Severity::Warning, note);
                    }
                }
                Err(error) => state.say(Severity::Error, &error.to_string()),
            }
            state.measure_fragments();
        });
    }

    /// These revisions are in files now.
    pub(crate) fn take_saved_outlines(&mut self, saved: &[(usize, u64)]) {
        let Some(open) = &mut self.open else {
            return;
        };
        for (photo, revision) in saved {
            if let Some(of) = open.fragments.photos.get_mut(photo) {
                of.saved = (!of.is_nothing()).then_some(*revision);
            }
        }
    }
}
