//! What may be written from the window: the rule is that of the commands (`files::overwrite`). Before a
//! file is replaced she is asked, and her answer counts as `--force`; what was read for what is on the
//! screen is not written over whatever she answers.

use std::path::{Path, PathBuf};

use crate::command::{Command, Destination};
use crate::exports;
use crate::files::{self, Inputs, Kind, Standing};
use crate::formats::FileError;
use crate::state::{HeldBack, Severity, State};
use crate::typed::typed;

impl State {
    /// Everything that was read for what is on the screen.
    pub(crate) fn read(&self) -> Inputs {
        let mut read = Inputs::default();
        if let Some(open) = &self.open {
            read.extend(&open.files.read);
            let form = &open.georeferencing.form;
            for list in [&form.positions, &form.control_points] {
                if let Some(path) = typed(list) {
                    read.add(&path);
                }
            }
        }
        let sources = &self.distributions.history.now().sources;
        let tables = sources.iter().filter_map(|source| source.path.as_deref());
        let times = self.distributions.effort.as_ref();
        for path in tables.chain(times.map(|times| times.path.as_path())) {
            read.add(path);
        }
        read
    }

    /// The same for saving the flight to `path`: where it was opened it may be saved, but the bundled
    /// one stays as it came.
    pub(crate) fn read_beside(&self, path: &Path) -> Inputs {
        let read = self.read();
        let Some(open) = self.open.as_ref().filter(|open| !open.files.stays()) else {
            return read;
        };
        let files = [
            open.files.origin.flight_file(),
            open.files.opened_file.as_deref(),
        ];
        let own = files.into_iter().flatten();
        match own.into_iter().any(|own| files::is_same_file(own, path)) {
            true => read.without(path),
            false => read,
        }
    }

    /// Whether a file can be written now; else says why not, or asks. `command` writes it.
    pub(crate) fn may_write(
        &mut self,
        to: &Destination,
        kind: Kind,
        read: &Inputs,
        command: impl FnOnce(Destination) -> Command,
    ) -> bool {
        self.may_write_all(to, std::slice::from_ref(&to.path), kind, read, command)
    }

    /// The same of several files in the folder `to`: the first one that stands there is asked for.
    pub(crate) fn may_write_all(
        &mut self,
        to: &Destination,
        paths: &[PathBuf],
        kind: Kind,
        read: &Inputs,
        command: impl FnOnce(Destination) -> Command,
    ) -> bool {
        if to.replace {
            return true;
        }
        for path in paths {
            let there = match self.standing(path, kind, read) {
                Ok(None) => continue,
                Ok(Some(there)) => there,
                Err(error) => {
                    self.say(Severity::Error, &error.to_string());
                    return false;
                }
            };
            let there = format!("There is a file already: {}. {there}", path.display());
            self.ask_to_replace(to, there, command);
            return false;
        }
        true
    }

    /// Whether it is the file of the flight whose changes were kept aside and are on the screen.
    fn is_of_kept(&self, path: &Path) -> bool {
        let open = self.open.as_deref();
        let kept = open.and_then(|open| open.files.kept.as_ref());
        kept.is_some_and(|kept| files::is_same_file(&kept.file, path))
    }

    /// What is to be asked before a file is written: `None` where nothing stands there.
    fn standing(
        &self,
        path: &Path,
        kind: Kind,
        read: &Inputs,
    ) -> Result<Option<&'static str>, FileError> {
        Ok(match files::standing(path, kind, read) {
            Standing::Free if !path.is_file() => None,
            Standing::Free => Some("It is empty."),
            Standing::Ours => Some("fragscale wrote it."),
            Standing::Foreign if self.is_of_kept(path) => {
                Some("It is the flight that these changes belong to.")
            }
            Standing::Foreign if kind == Kind::Flight => {
                Some("It is no flight file that fragscale wrote.")
            }
            Standing::Foreign => Some("It is no result that fragscale wrote."),
            Standing::Read(_) | Standing::ReadFolder(_) | Standing::Folder => {
                let written = files::may_write(path, kind, read, true);
                written.map_err(|fault| FileError::new(path, fault))?;
                return Ok(None);
            }
        })
    }

    /// Whether a folder can be exported to now; else asks.
    pub(crate) fn may_export(&mut self, to: &Destination) -> bool {
        let Some(open) = &self.open else {
            return false;
        };
        let (folder, name) = (&to.path, &open.flight().parts().name);
        let other = exports::other_flight_in(folder, name, open.files.origin.file());
        let Some(other) = other.filter(|_| !to.replace) else {
            return true;
        };
        let there = format!(
            "{} holds the export of another flight, {other}. Its pictures and tables would go.",
            folder.display()
        );
        self.ask_to_replace(to, there, Command::Export);
        false
    }

    /// Holds back what would replace something: her answer sends it again, and it may.
    pub(crate) fn ask_to_replace(
        &mut self,
        to: &Destination,
        there: String,
        command: impl FnOnce(Destination) -> Command,
    ) {
        let to = Destination {
            path: to.path.clone(),
            replace: true,
        };
        let command = Box::new(command(to));
        self.held_back = Some(HeldBack::Replace { command, there });
    }
}
