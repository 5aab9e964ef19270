//! The folder that a reconstruction comes out in: which one may be, what lies in it when the work begins again,
//! and how its files are written.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use crate::engine::{Engine, Sparse};
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind};
use crate::flight::{FlightFile, PhotoSource};
use crate::formats::{FAILED, MODEL, UNFINISHED};
use crate::kept_model::{files_of, keep, kept_in};
use crate::photo_set::PhotoSet;
use crate::written::cannot;
use crate::written::made_of;
use crate::written::work_folder::{empty_work, lock_work};

pub(super) const FLIGHT: &str = "flight.toml";
/// What a finished model is of, beside it.
const OF: &str = "photos.txt";
const ANOTHER: &str = "name a new folder";

/// The folder that comes out.
pub(crate) struct Folder {
    pub(super) path: PathBuf,
    /// For what an engine keeps.
    pub(crate) work: PathBuf,
    /// The photos, which are never written over.
    read: Inputs,
    /// What the model in it is to be of: the engine, and a line a photo.
    of: String,
    /// The flight.toml that is there, where the same photos are reconstructed once more.
    before: Option<String>,
    /// Keeps other runs out.
    lock: Option<File>,
}

/// A flight may be made in a folder that is to be made, is empty, or is that of a run that did not end.
///
/// # Errors
/// Where it holds other things.
pub(super) fn checked(to: &Path) -> Result<(), Fault> {
    if to.join(FLIGHT).exists() {
        return Err(Fault::new("there is a flight in it already", ANOTHER));
    }
    let is_empty = match fs::read_dir(to) {
        Ok(mut entries) => entries.next().is_none(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => true,
        Err(error) => return Err(cannot("be read", &error)),
    };
    match is_empty || to.join(UNFINISHED).exists() {
        true => Ok(()),
        false => Err(Fault::new("the folder is not empty", ANOTHER)),
    }
}

/// The flight.toml in a folder, where it is one that a reconstruction wrote, whatever was set in it since;
/// `None` where there is none.
///
/// # Errors
/// Where it is another flight's.
fn before(to: &Path) -> Result<Option<String>, Fault> {
    if !to.join(MODEL).join(OF).exists() {
        return checked(to).map(|()| None);
    }
    let text = match fs::read_to_string(to.join(FLIGHT)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(cannot("be read", &error)),
        Ok(text) => text,
    };
    let is_ours = FlightFile::parse(&text).is_ok_and(|flight| {
        match flight.photo_source() {
            PhotoSource::Poses("poses.csv") => {
                matches!(flight.surface(), Some("pile.laz" | "pile.ply"))
            }
            // Of a model that is not in the world.
            PhotoSource::Reconstruction(MODEL, None) => {
                matches!(flight.surface(), None | Some("pile.ply"))
            }
            _ => false,
        }
    });
    match is_ours {
        true => Ok(Some(text)),
        false => {
            let what = "the flight in it is not what a reconstruction wrote any more";
            Err(Fault::new(what, ANOTHER))
        }
    }
}

/// The folder, where a flight may be made in it.
///
/// # Errors
/// Where it may not, or lies among the photos.
pub(crate) fn folder(to: &Path, photos: &Path) -> Result<Folder, FileError> {
    let at = |fault| FileError::new(to, fault);
    let before = before(to).map_err(at)?;
    let read = Inputs::of([photos]);
    // Said before the work, not after it.
    files::may_write(&to.join(FLIGHT), Kind::Flight, &read, before.is_some()).map_err(at)?;
    let work = to.join(UNFINISHED);
    Ok(Folder {
        path: to.to_owned(),
        work: work.parent().unwrap_or(to).to_owned(),
        read,
        of: String::new(),
        before,
        lock: None,
    })
}

impl Folder {
    /// Makes the folder and keeps other runs out of it; throws unfinished work away that is of other photos, or of
    /// another engine's. Where the
    /// flight is finished and of these photos, its model is taken.
    ///
    /// # Errors
    /// Where the folder cannot be written, another run works in it, or it holds a flight of other photos.
    pub(crate) fn go_on_with(
        &mut self,
        photos: &PhotoSet,
        engine: &dyn Engine,
    ) -> Result<(), FileError> {
        let text = made_of::text(photos, engine);
        let of = self.path.join(UNFINISHED);
        let written = |error: io::Error| FileError::new(&of, cannot("be written", &error));
        let model = self.path.join(MODEL);
        if self.before.is_some() {
            // One that cannot be read is of nothing.
            let before = fs::read_to_string(model.join(OF)).unwrap_or_default();
            if let Some(differs) = made_of::difference(&before, &text) {
                let what = format!("there is a flight in it already, {differs}");
                return Err(FileError::new(&self.path, Fault::new(what, ANOTHER)));
            }
        }
        self.lock = Some(lock_work(&self.path, &self.work)?);
        if !fs::read_to_string(&of).is_ok_and(|before| before == text) {
            empty_work(&self.work).map_err(written)?;
            if let Some(sparse) = self.before.as_ref().and_then(|_| kept_in(&model)) {
                keep(&self.work, &sparse).map_err(|fault| FileError::new(&self.work, fault))?;
            }
            self.write(&of, text.as_bytes())?;
        }
        match fs::remove_file(self.path.join(FAILED)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(written(error)),
            _ => {}
        }
        self.of = text;
        Ok(())
    }

    /// Takes the unfinished work away, once the flight is whole.
    pub(super) fn throw_work_away(&mut self) {
        self.lock = None;
        // What is left over harms nobody.
        let _ = fs::remove_dir_all(&self.work);
    }

    /// Notes why the photos could not be reconstructed, for whoever opens the folder: the same photos once more
    /// end the same way.
    pub(crate) fn write_why(&self, fault: &Fault) -> Result<(), FileError> {
        self.write(&self.path.join(FAILED), fault.to_string().as_bytes())
    }

    /// Writes the model in its own frame, whose folder is returned, with what it is of.
    pub(super) fn write_model(&self, sparse: &Sparse) -> Result<PathBuf, FileError> {
        let model = self.path.join(MODEL);
        fs::create_dir_all(&model)
            .map_err(|error| FileError::new(&self.path, cannot("be written", &error)))?;
        let kept = files_of(sparse).map(|mut files| {
            files.push((OF, self.of.clone().into_bytes()));
            files
        });
        for (name, bytes) in kept.unwrap_or_else(|| sparse.files.to_vec()) {
            self.write(&model.join(name), &bytes)?;
        }
        Ok(model)
    }

    /// The text of flight.toml: a new one's, in which what the engineer has set since one was first written stays.
    /// How sure the cloud is, is the new one's.
    ///
    /// # Errors
    /// Where the new one is of another world, in which lengths and places that were set would be wrong.
    pub(super) fn flight_text(&self, new: Vec<u8>) -> Result<Vec<u8>, FileError> {
        let parsed = |text: &str| FlightFile::parse(text).ok();
        let Some(before) = self.before.as_deref() else {
            return Ok(new);
        };
        let made = std::str::from_utf8(&new).ok().and_then(parsed);
        let (Some(old), Some(made)) = (parsed(before), made) else {
            return Ok(new);
        };
        if old.crs() != made.crs() {
            let named = |flight: &FlightFile| flight.crs().unwrap_or("none").to_owned();
            let what = format!(
                "the flight in it has the coordinate system {}, and this one would have {}",
                named(&old),
                named(&made)
            );
            return Err(FileError::new(&self.path, Fault::new(what, ANOTHER)));
        }
        // The cloud lies in a file of another kind: that has to be named.
        if old.surface() != made.surface() {
            return Ok(new);
        }
        let mut settings = old.settings();
        settings.errors.surface = made.settings().errors.surface;
        let merged = FlightFile::text_with_settings(before, &settings);
        Ok(merged.map_or(new, String::into_bytes))
    }

    /// Writes a file of the folder, which nobody else's files lie in.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> Result<(), FileError> {
        let written = files::write(path, bytes, Kind::Result, &self.read, true);
        written.map_err(|fault| FileError::new(path, fault))
    }
}
