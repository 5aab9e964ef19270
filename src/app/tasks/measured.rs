//! Writing what was measured on the surface.

use super::work::Task;
use crate::command::{Command, Destination, MeasuredTable};
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::state::{Severity, State};

impl Task {
    /// Writing a table of what was measured.
    pub const SAVE_MEASURED: Self = Self::new("Writing the table").writing();
}

impl State {
    /// Writes a table as CSV; asks before a file is replaced.
    pub(crate) fn save_measured(&mut self, table: MeasuredTable, to: Destination) {
        self.asking = None;
        if self.open.is_none() || self.is_busy(Task::SAVE_MEASURED) {
            return;
        }
        let csv = self.open.as_ref().and_then(|open| open.measured_csv(table));
        let csv = match csv {
            Some(Ok(csv)) => csv,
            Some(Err(error)) => return self.say(Severity::Error, &error),
            None => return self.say(Severity::Error, "nothing is measured now; measure first"),
        };
        let read = self.read();
        let command = |to| Command::SaveMeasured(table, to);
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("writing");
            let Destination { path, replace } = to;
            match files::write(&path, csv.as_bytes(), Kind::Result, &read, replace) {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_MEASURED, work, Self::take_written);
    }
}
