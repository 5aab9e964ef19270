//! A network of hers, read as a job: its description with the files that this names.

use std::path::PathBuf;
use std::sync::Arc;

use super::engine_choice::EngineChoice;
use crate::command::Asking;
use crate::delineation::Engine;
use crate::files::last_segment;
use crate::jobs::Progress;
use crate::opening::read_named_engine;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Reading a network of hers.
    pub const READ_NETWORK: Self = Self::new("Reading a network");
}

impl State {
    /// Reads the network that a file describes, and chooses it.
    pub(super) fn read_network(&mut self, path: PathBuf) {
        self.network.refused = None;
        let work = move |progress: &Progress| {
            let name = path.to_string_lossy();
            progress.stage(format!("reading {}", last_segment(&name)));
            read_named_engine(&path).map_err(|error| error.to_string())
        };
        self.start(Task::READ_NETWORK, work, move |state, read| match read {
            Ok(model) => {
                state.mended(Task::READ_NETWORK);
                let text = format!("network {}: ready to outline fragments", model.name());
                state.say(Severity::Note, &text);
                state.network.model = Some(Arc::new(model));
                if let Some(open) = &mut state.open {
                    open.fragments.engine = EngineChoice::Named;
                }
                if state.asking == Some(Asking::Network) {
                    state.asking = None;
                }
            }
            Err(message) => {
                state.say_until_mended(Task::READ_NETWORK, &message);
                state.network.refused = Some(message);
            }
        });
    }
}
