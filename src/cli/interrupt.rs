//! Ctrl+C. The work is asked to stop, as the window's Cancel does, so that it ends what it has started (COLMAP)
//! and removes what is half written; where it does not look up soon enough, the program ends without it.
//!
//! A closed terminal (SIGHUP) and SIGTERM are taken for the same, but where another computer works: nobody meant to
//! throw that away, and it goes on without a terminal. The program ends then as if it were killed, and says what stays.

use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::say;
use crate::files;
use crate::jobs::Progress;

/// How long the work has to stop by itself. Cancelling takes at most a second by what it promises.
const GRACE: Duration = Duration::from_secs(2);
/// The same where another computer has to be told.
const LONG_GRACE: Duration = Duration::from_secs(15);

/// The exit status of a command that the user interrupted.
const INTERRUPTED: u8 = 130;

/// The work under way, and what stays of it.
static UNDER_WAY: Mutex<(Option<Progress>, Option<String>)> = Mutex::new((None, None));

/// From now on Ctrl+C is answered here; a second one ends the program at once. `kept` says what stays of interrupted
/// work, where something does; `takes_long` whether another computer has to be told that it is.
pub(super) fn listen(kept: Option<String>, takes_long: bool) {
    under_way(|(_, stays)| *stays = kept);
    let grace = if takes_long { LONG_GRACE } else { GRACE };
    #[cfg(unix)]
    if takes_long {
        end_where_terminated();
    }
    // Without the handler, which only fails where another one is set, an interrupt could leave a temporary file.
    let _ = ctrlc::set_handler(move || {
        let work = under_way(|(work, _)| work.clone());
        let Some(work) = work.filter(|work| !work.is_cancelled()) else {
            end(INTERRUPTED.into());
        };
        work.cancel();
        // Elsewhere, so that a second interrupt is heard.
        let waits = move || {
            std::thread::sleep(grace);
            end(INTERRUPTED.into());
        };
        if std::thread::Builder::new().spawn(waits).is_err() {
            end(INTERRUPTED.into());
        }
    });
}

/// From now on SIGHUP and SIGTERM end the program without asking the work to stop. To be called while there is one
/// thread: those that it starts hold the signals back, as it does, for the one that waits for them. (So would programs
/// that it starts; whoever works on another computer starts none.)
#[cfg(unix)]
fn end_where_terminated() {
    let signals = ctrlc::Signal::SIGHUP | ctrlc::Signal::SIGTERM;
    if signals.thread_block().is_err() {
        return;
    }
    let waits = move || {
        if let Ok(signal) = signals.wait() {
            // As shells count those that a signal has ended.
            end(128 + signal as i32);
        }
    };
    if std::thread::Builder::new().spawn(waits).is_err() {
        // They are taken for Ctrl+C then.
        let _ = signals.thread_unblock();
    }
}

fn end(status: i32) -> ! {
    files::remove_unfinished();
    say_so();
    std::process::exit(status);
}

/// What stays of the work, now that it has ended by itself.
pub(super) fn keeps(said: &str) {
    under_way(|(_, kept)| *kept = Some(said.to_owned()));
}

/// The work that Ctrl+C is to stop.
pub(super) fn stops(work: &Progress) {
    under_way(|(under_way, _)| *under_way = Some(work.clone()));
}

/// Whether the user interrupted the work; it is said then, with the exit status that it has.
pub(super) fn interrupted() -> Option<ExitCode> {
    let was = under_way(|(work, _)| work.as_ref().is_some_and(Progress::is_cancelled));
    was.then(|| {
        say_so();
        ExitCode::from(INTERRUPTED)
    })
}

fn say_so() {
    let kept = under_way(|(_, kept)| kept.take());
    let kept = kept.map_or_else(String::new, |kept| format!("; {kept}"));
    say(&format!("interrupted{kept}"));
}

fn under_way<T>(of: impl FnOnce(&mut (Option<Progress>, Option<String>)) -> T) -> T {
    of(&mut UNDER_WAY.lock().unwrap_or_else(PoisonError::into_inner))
}
