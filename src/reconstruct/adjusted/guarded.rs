//! What cumulus3d does when something goes wrong: its errors are in Korean and its asserts panic.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use crate::fault::Fault;
use crate::jobs::Progress;

/// What cumulus3d says went wrong; its own words are not the user's.
pub(crate) fn failed(doing: &str) -> Fault {
    let what = format!("{doing} failed");
    Fault::new(
        what,
        "leave out photos of other things, or report this with the photos",
    )
}

/// A panic inside of cumulus3d as a fault.
///
/// # Errors
/// Those of `work`, and where it panics.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, Fault>) -> Result<T, Fault> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(failed("the reconstruction")))
}

/// How often it is looked whether somebody has cancelled.
const LOOK: Duration = Duration::from_millis(20);

/// Work inside of cumulus3d that may take seconds and cannot be told to stop: on a thread of its own, for which nobody waits once
/// `progress` is cancelled. It ends by itself, and what it made is thrown away.
///
/// # Errors
/// On cancel; where it panics, named by what it is `doing`.
pub(crate) fn not_waited_for<T: Send + 'static>(
    doing: &str,
    progress: &Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Fault> {
    let (send, receive) = mpsc::channel();
    let thread = thread::Builder::new().name(doing.to_owned());
    thread
        .spawn(move || {
            // Nobody listens after a cancel.
            let _ = send.send(work());
        })
        .map_err(|_| failed(doing))?;
    loop {
        match receive.recv_timeout(LOOK) {
            Ok(made) => return Ok(made),
            Err(RecvTimeoutError::Timeout) if progress.is_cancelled() => {
                progress.advance(0, 1)?;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(failed(doing)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comes_back_with_what_it_made_or_not_at_all() {
        let progress = Progress::default();
        assert_eq!(not_waited_for("adding", &progress, || 1 + 1), Ok(2));
        let panics = not_waited_for("the adjustment", &progress, || -> u32 {
            std::panic::panic_any(())
        });
        assert!(
            panics
                .unwrap_err()
                .to_string()
                .contains("the adjustment failed")
        );
    }

    /// The work is under way until the test has its answer: no clock is needed to see that nobody waited for it.
    #[test]
    fn is_left_alone_once_it_is_cancelled() {
        let progress = Progress::default();
        let (end, until) = mpsc::channel::<()>();
        let cancel = progress.clone();
        let found = not_waited_for("waiting", &progress, move || {
            cancel.cancel();
            until.recv().is_ok()
        });
        assert!(found.unwrap_err().to_string().contains("cancelled"));
        assert!(end.send(()).is_ok());
    }
}
