//! Time effort: the times of a file, and how long the program's own steps took.

use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::fault::Fault;
use crate::formats;
use crate::fragmentation::Effort;
use crate::state::{Severity, State};
use crate::tasks::work::{Done, Task};

/// A step that the program did.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeasuredStep {
    /// What was done.
    pub step: &'static str,
    /// For which flight.
    pub flight: String,
    /// How long it took the last time.
    pub took: Duration,
}

/// The times of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct EffortFile {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub path: PathBuf,
    /// The times.
    pub effort: Effort,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
}

/// The measured steps as a table, one column a flight.
///
/// # Errors
/// Where a step is there twice for a flight, which measuring does not do.
pub fn effort(measured: &[MeasuredStep]) -> Result<Effort, Fault> {
    let mut effort = Effort::new();
    for MeasuredStep { step, flight, took } in measured {
        effort.add(step, flight, Some(took.as_secs_f64()))?;
    }
    Ok(effort)
}

impl State {
    /// Notes how long a job took, where it was a step of the engineer's work that succeeded.
    pub(crate) fn measure(&mut self, done: &Done, took: Duration) {
        let on_screen = || self.open.as_ref().map(|open| open.flight());
        let steps = match done {
            Done::Opened(loaded) => {
                let Ok(loaded) = loaded.as_ref() else {
                    return;
                };
                let [read, computed] = loaded.took;
                let flight = &loaded.opened.flight.parts().name;
                vec![
                    ("Opening the flight", flight.clone(), read),
                    ("Computing scales", flight.clone(), computed),
                ]
            }
            Done::Scales(Ok((flight, ..))) => {
                let flight = flight.parts().name.clone();
                vec![("Computing scales", flight, took)]
            }
            Done::Exported(Ok(_)) => match on_screen() {
                Some(flight) => vec![("Export", flight.parts().name.clone(), took)],
                None => Vec::new(),
            },
            _ => Vec::new(),
        };
        for (step, flight, took) in steps {
            let measured = &mut self.distributions.measured;
            measured.retain(|known| known.step != step || known.flight != flight);
            measured.push(MeasuredStep { step, flight, took });
        }
    }

    /// Reads times of steps.
    pub(super) fn read_effort(&mut self, path: PathBuf) {
        self.asking = None;
        self.start(Task::ReadEffort, move |_| {
            let read = formats::read_effort_table(&path).map_err(|error| error.to_string());
            Done::ReadEffort(path, read)
        });
    }

    /// Takes the times that were read.
    pub(crate) fn take_effort(&mut self, path: &Path, read: Result<(Effort, Vec<String>), String>) {
        match read {
            Err(why) => self.say(Severity::Error, &why),
            Ok((effort, warnings)) => {
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
