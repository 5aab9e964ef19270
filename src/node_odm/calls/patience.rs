//! Waiting, and asking again.

use std::time::{Duration, Instant};

use crate::jobs::Progress;
use crate::limits::Limits;
use crate::trouble::Trouble;

/// Waits, as long as it is wanted.
///
/// # Errors
/// Where it was cancelled.
pub(crate) fn wait(time: Duration, progress: &Progress) -> Result<(), Trouble> {
    let began = Instant::now();
    loop {
        if progress.is_cancelled() {
            return Err(Trouble::Cancelled);
        }
        let left = time.saturating_sub(began.elapsed());
        if left.is_zero() {
            return Ok(());
        }
        std::thread::sleep(left.min(Duration::from_millis(50)));
    }
}

/// Makes a call again where it failed in passing, at growing intervals, until `limits.give_up` has passed without an
/// answer; says what it waits for.
pub(crate) fn patiently<T>(
    limits: &Limits,
    progress: &Progress,
    call: impl Fn() -> Result<T, Trouble>,
) -> Result<T, Trouble> {
    let began = Instant::now();
    let mut pause = limits.shortest_pause;
    loop {
        match call() {
            Err(Trouble::Passing(fault)) if began.elapsed() < limits.give_up => {
                progress.stage(format!("{}; asking again", fault.what));
            }
            done => return done,
        }
        wait(pause, progress)?;
        pause = (pause * 2).min(limits.longest_pause);
    }
}
