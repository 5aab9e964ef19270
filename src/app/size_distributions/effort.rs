//! Reading times of steps, and noting how long the program's own took.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::measured::{EffortFile, MeasuredStep};
use crate::formats;
use crate::fragmentation::Effort;
use crate::jobs::Progress;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Reading times of steps.
    pub const READ_EFFORT: Self = Self::new("Reading times");
}

impl State {
    /// Notes how long a step of the engineer's work took the last time.
    pub(crate) fn note_step(&mut self, step: &'static str, flight: &str, took: Duration) {
        let measured = &mut self.distributions.measured;
        measured.retain(|known| known.step != step || known.flight != flight);
        measured.push(MeasuredStep {
            step,
            flight: flight.to_owned(),
            took,
        });
    }

    /// Reads times of steps.
    pub(super) fn read_effort(&mut self, path: PathBuf) {
        self.asking = None;
        let work = move |_: &Progress| {
            let read = formats::read_effort_table(&path).map_err(|error| error.to_string());
            (path, read)
        };
        self.start(Task::READ_EFFORT, work, |state, (path, read)| {
            state.take_effort(&path, read);
        });
    }

    /// Takes the times that were read.
    fn take_effort(&mut self, path: &Path, read: Result<(Effort, Vec<String>), String>) {
        match read {
            Err(why) => self.say_until_mended(Task::READ_EFFORT, &why),
            Ok((effort, warnings)) => {
                self.mended(Task::READ_EFFORT);
                let name = path.file_name().unwrap_or_default();
                let name = name.to_string_lossy().into_owned();
                for warning in &warnings {
                    self.say(Severity::Warning, &format!("{name}: {warning}"));
                }
                self.say(Severity::Note, &format!("{name}: times of steps"));
                self.distributions.effort = Some(EffortFile {
                    name,
                    path: path.to_owned(),
                    effort,
                    warnings,
                });
            }
        }
    }
}
