//! Writing what was measured on the surface, and reading what volumes are over.

use std::path::{Path, PathBuf};

use super::work::Task;
use crate::command::{Command, Destination, MeasuredTable};
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::SecondBase;
use crate::opening::{SecondSurface, StatedWorld, volume_base};
use crate::state::{Severity, State};

impl Task {
    /// Writing a table of what was measured.
    pub const SAVE_MEASURED: Self = Self::new("Writing the table").writing();
    /// Reading the second surface that a volume is over.
    pub const VOLUME_BASE: Self = Self::new("Base of the volume").of_flight();
}

impl State {
    /// Reads a second surface for volumes to be over, as the command does.
    pub(crate) fn read_volume_base(&mut self, path: PathBuf) {
        self.asking = None;
        self.read_second_surface(
            Task::VOLUME_BASE,
            path,
            volume_base,
            |open, path, second| {
                open.take_second_base(SecondBase {
                    path,
                    surface: second.surface,
                    other_heights: second.other_heights,
                });
            },
        );
    }

    /// Reads a second surface in the flight's world by `read`; `take` gets it.
    pub(super) fn read_second_surface(
        &mut self,
        task: Task,
        path: PathBuf,
        read: fn(&Path, &StatedWorld<'_>, &Progress) -> Result<SecondSurface, FileError>,
        take: impl FnOnce(&mut OpenFlight, PathBuf, SecondSurface) + Send + 'static,
    ) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, crs) = (open.flight().clone(), open.files.crs.clone());
        let work = move |progress: &Progress| {
            let parts = flight.parts();
            let world = StatedWorld {
                crs: crs.as_deref(),
                unit: parts.unit_known.then_some(parts.unit),
                around: parts.surface.bounds(),
            };
            read(&path, &world, progress).map(|second| (path, second))
        };
        self.start(task, work, move |state, read| match read {
            Ok((path, second)) => {
                state.mended(task);
                for warning in &second.warnings {
                    state.say(Severity::Warning, warning);
                }
                if let Some(open) = &mut state.open {
                    open.files.read.extend(&second.read);
                    take(open, path, second);
                }
            }
            Err(error) => state.say_until_mended(task, &error.to_string()),
        });
    }

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
        let of = self.open.as_ref().map(|open| open.number);
        self.start(Task::SAVE_MEASURED, work, move |state, written| {
            let open = state.open.as_mut().filter(|open| Some(open.number) == of);
            if let (Ok(_), Some(open), MeasuredTable::Points) = (&written, open, table) {
                open.pointer.picked.keep();
            }
            state.take_written(written);
        });
    }
}
