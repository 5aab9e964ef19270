//! Long work of the window, one file a job: what is handed to it, what it does, and what its result
//! does to the state.

pub mod beside;
pub mod computing;
pub mod dialog;
pub mod exporting;
pub mod histogram;
pub mod measured;
pub mod opening;
pub mod photos;
pub mod picture;
pub mod reconstruction;
pub mod saving;
pub mod scale_objects;
pub(crate) mod stood;
pub mod tint;
pub mod work;

pub use work::{Task, Work};

use std::any::Any;

use crate::fault::Fault;
use crate::jobs::Progress;
use crate::state::{Severity, State};

impl State {
    /// Starts a task, or says why it cannot be started.
    pub(crate) fn start<T: Send + 'static>(
        &mut self,
        task: Task,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
        ending: impl FnOnce(&mut Self, T) + Send + 'static,
    ) {
        if let Err(fault) = self.work.start(task, work, ending) {
            self.say(Severity::Error, &fault.to_string());
        }
    }

    /// Starts what a frame misses, where it was not refused; says why it cannot be started. See
    /// [`Work::start_wished`].
    pub(crate) fn start_wished<W: Any + Send + Clone + PartialEq, T: Send + 'static>(
        &mut self,
        task: Task,
        wish: W,
        work: impl FnOnce(&Progress) -> Result<T, Fault> + Send + 'static,
        ending: impl FnOnce(&mut Self, T) + Send + 'static,
    ) {
        if let Err(fault) = self.work.start_wished(task, wish, work, ending) {
            self.say(Severity::Error, &fault.to_string());
        }
    }

    /// Whether a task of this kind still writes; then says so.
    pub(crate) fn is_busy(&mut self, task: Task) -> bool {
        let busy = self.work.is_running(task);
        if busy {
            let text = format!(
                "{}: the one before is still under way; wait for it",
                task.in_words
            );
            self.say(Severity::Error, &text);
        }
        busy
    }
}
