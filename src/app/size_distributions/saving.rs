//! Writing the figure and the report of the size distributions.

use std::path::PathBuf;

use crate::app::state::{Severity, State};

impl State {
    /// Writes the figure.
    pub(super) fn save_figure(&mut self, path: PathBuf) {
        self.say(Severity::Error, &format!("{}: not yet", path.display()));
    }

    /// Writes the report.
    pub(super) fn save_report(&mut self, path: PathBuf) {
        self.say(Severity::Error, &format!("{}: not yet", path.display()));
    }
}
