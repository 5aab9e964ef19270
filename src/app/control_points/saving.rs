//! Writing the control points beside the flight that is saved.

use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind, Standing};
use crate::open_flight::OpenFlight;
use crate::opening::{control_file, control_text};

/// A list of control points that is to be written.
pub(crate) struct ControlToSave {
    path: PathBuf,
    text: String,
    /// Whether it is that of the flight on the screen.
    is_own: bool,
}

impl OpenFlight {
    /// What is to be written beside the flight at `path`; `None` where nothing is.
    pub(crate) fn control_to_save(&self, path: &Path) -> Option<ControlToSave> {
        let list = self.control_list();
        let own = self.files.origin.flight_file();
        let is_own = !self.files.stays() && own.is_some_and(|own| files::is_same_file(own, path));
        let is_wanted = match is_own {
            true => *list != self.files.saved.control,
            false => !list.is_empty(),
        };
        let photos = self.flight().parts().photos.iter();
        let photos: Vec<&str> = photos.map(|photo| photo.name.as_str()).collect();
        is_wanted.then(|| ControlToSave {
            path: control_file(path),
            text: control_text(list, &photos),
            is_own,
        })
    }
}

impl ControlToSave {
    /// Writes it; `read` is what may not be written over. Another file of that name is never replaced.
    ///
    /// # Errors
    /// Why it may not be written, or what the system says.
    pub(crate) fn write(&self, read: &Inputs) -> Result<(), FileError> {
        let path = &self.path;
        let read = match self.is_own {
            true => read.clone().without(path),
            false => read.clone(),
        };
        let at = |fault| FileError::new(path, fault);
        let is_ours = files::standing(path, Kind::Flight, &read) == Standing::Ours;
        if !is_ours && path.is_file() {
            return Err(at(Fault::new(
                "it is no list of control points that fragscale wrote, so the flight's cannot be written there",
                "move it, or save the flight under another name",
            )));
        }
        files::write(path, self.text.as_bytes(), Kind::Flight, &read, is_ours).map_err(at)
    }
}
