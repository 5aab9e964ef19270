//! The plan as a file: what the command `map` writes.

use crate::command::{Command, Destination};
use crate::exports::{Plan, PlanFormat, taken_in_words};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::map::MapCommand;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Writing the map.
    pub const SAVE_MAP: Self = Self::new("Writing the map").writing();
}

impl State {
    /// Writes the map; asks before a file is replaced.
    pub(super) fn save_map(&mut self, to: Destination) {
        self.asking = None;
        if self.is_busy(Task::SAVE_MAP) {
            return;
        }
        let Some(open) = &self.open else {
            return;
        };
        let format = match PlanFormat::of(&to.path) {
            Ok(format) => format,
            Err(fault) => {
                let error = FileError::new(&to.path, fault);
                self.say(Severity::Error, &error.to_string());
                return;
            }
        };
        let made = open.map.made.as_ref();
        let Some(made) = made.filter(|made| made.revision == open.map.revision) else {
            let text = "the map is still being made; write it when it is there";
            self.say(Severity::Error, text);
            return;
        };
        let times = open.pictures.times.iter().flatten();
        let taken = taken_in_words(times.map(String::as_str));
        let plan = made.plan.clone();
        let (read, unit) = (self.read(), self.preferences.unit());
        let command = |to| Command::Map(MapCommand::Save(to));
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("drawing and writing the map");
            let Destination { path, replace } = to;
            let plan = Plan {
                taken,
                ..(*plan).clone()
            };
            let written: Result<(), Fault> = format
                .bytes(&plan, unit)
                .and_then(|bytes| files::write(&path, &bytes, Kind::Result, &read, replace));
            match written {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_MAP, work, Self::take_written);
    }
}
