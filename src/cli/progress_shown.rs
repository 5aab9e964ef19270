//! Runs the work of a command as a job, and shows how far it is: a bar on a terminal, a line now and then in a log.

use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::{interrupt, say};
use crate::jobs::{Job, Progress};

/// Work that is over sooner shows no progress bar.
const QUICK: Duration = Duration::from_millis(500);
/// Where nobody looks at a bar, so often a line says how far it is.
const LOGGED: Duration = Duration::from_secs(60);

/// Runs the work on a thread of its own, with a progress bar on a terminal where it takes long, and a line now and then in a
/// file.
pub(super) fn run<T: Send + 'static>(
    work: impl FnOnce(&Progress) -> Result<T, String> + Send + 'static,
) -> Result<T, String> {
    let job = Job::start("work", work).map_err(|fault| fault.to_string())?;
    interrupt::stops(job.progress());
    match io::stderr().is_terminal() {
        true => show_progress(&job),
        false => log_progress(&job),
    }
    job.finish().map_err(|fault| fault.to_string())?
}

fn show_progress<T: Send + 'static>(job: &Job<T>) {
    let mut bar = None;
    watch(job, |passed| {
        if passed > QUICK {
            let bar = bar.get_or_insert_with(new_bar);
            let (sentence, fraction) = job.progress().snapshot();
            bar.set_message(sentence);
            // `as` saturates.
            bar.set_position((fraction * 1000.0) as u64);
        }
    });
    if let Some(bar) = bar {
        bar.finish_and_clear();
    }
}

/// A line after each [`LOGGED`]: of work of hours a log says how far it is.
fn log_progress<T: Send + 'static>(job: &Job<T>) {
    let mut due = LOGGED;
    watch(job, |passed| {
        if passed > due {
            due += LOGGED;
            say(&logged(passed, job.progress().snapshot()));
        }
    });
}

/// What a log says of a stage after so long: its sentence and its fraction, NaN where that is not known.
fn logged(passed: Duration, (sentence, fraction): (String, f64)) -> String {
    let percent = match fraction.is_finite() {
        true => format!(" {:.0} %", 100.0 * fraction),
        false => String::new(),
    };
    format!("after {} min: {sentence}{percent}", passed.as_secs() / 60)
}

/// Looks at the work now and then until it is done, told how long it has taken.
fn watch<T: Send + 'static>(job: &Job<T>, mut look: impl FnMut(Duration)) {
    let began = Instant::now();
    while !job.is_finished() {
        // Short work is not kept waiting.
        let pause = began.elapsed() / 16;
        std::thread::sleep(pause.clamp(Duration::from_millis(1), Duration::from_millis(50)));
        look(began.elapsed());
    }
}

fn new_bar() -> ProgressBar {
    let bar = ProgressBar::new(1000);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {elapsed}  {msg}") {
        bar.set_style(style);
    }
    bar
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_says_how_far_work_is() {
        let after = |seconds, fraction| {
            logged(
                Duration::from_secs(seconds),
                ("matching".to_owned(), fraction),
            )
        };
        assert_eq!(after(61, 0.416), "after 1 min: matching 42 %");
        assert_eq!(after(7200, f64::NAN), "after 120 min: matching");
    }
}
