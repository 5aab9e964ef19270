//! Long work: a named thread with progress, cancel and a result.
//!
//! The work is handed a [`Progress`], says now and then how far it is and asks whether it should
//! stop, or wait; whoever started it looks at the same `Progress` whenever it likes. Nobody waits for
//! anybody.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::fault::Fault;

/// How far a piece of work is, shared between the worker and its watchers. Clones share one state.
#[derive(Debug, Clone, Default)]
pub struct Progress(Arc<State>);

#[derive(Debug, Default)]
struct State {
    /// Bits of an f64 in 0..=1, or of NaN where the work cannot tell.
    fraction: AtomicU64,
    sentence: Mutex<String>,
    cancelled: AtomicBool,
    /// Whether the work is to wait at its next look. The lock is for waiting alone.
    paused: AtomicBool,
    waiting: Mutex<()>,
    goes_on: Condvar,
}

/// A paused work looks so often whether it is wanted, should nobody wake it.
const LOOK: Duration = Duration::from_millis(200);

impl Progress {
    /// Begins a stage of the work: says it in words and starts its fraction anew.
    pub fn stage(&self, sentence: impl Into<String>) {
        *self
            .0
            .sentence
            .lock()
            .unwrap_or_else(PoisonError::into_inner) = sentence.into();
        self.0.fraction.store(0.0_f64.to_bits(), Ordering::Relaxed);
    }

    /// Notes that `done` of `total` are done; waits as long as the work is paused.
    ///
    /// # Errors
    /// A fault "cancelled" once somebody has cancelled the work: pass it on with `?`.
    pub fn advance(&self, done: u64, total: u64) -> Result<(), Fault> {
        // Counts beyond 2^53 lose digits here, which a progress bar does not show.
        let fraction = done as f64 / total.max(1) as f64;
        self.0
            .fraction
            .store(fraction.min(1.0).to_bits(), Ordering::Relaxed);
        self.wait_while_paused();
        if self.is_cancelled() {
            return Err(Fault::new("cancelled", "start it again when you want it"));
        }
        Ok(())
    }

    /// The stage's sentence and its fraction, 0 to 1.
    pub fn snapshot(&self) -> (String, f64) {
        let sentence = self
            .0
            .sentence
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        (
            sentence.clone(),
            f64::from_bits(self.0.fraction.load(Ordering::Relaxed)),
        )
    }

    /// Asks the work to stop at its next look, also where it is paused.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
        self.0.goes_on.notify_all();
    }

    /// Asks the work to wait at its next look, or to go on.
    pub fn pause(&self, paused: bool) {
        self.0.paused.store(paused, Ordering::Relaxed);
        self.0.goes_on.notify_all();
    }

    /// Whether somebody has asked the work to wait.
    pub fn is_paused(&self) -> bool {
        self.0.paused.load(Ordering::Relaxed)
    }

    fn wait_while_paused(&self) {
        while self.is_paused() && !self.is_cancelled() {
            let lock = &self.0.waiting;
            let guard = lock.lock().unwrap_or_else(PoisonError::into_inner);
            // Woken between looking and waiting it looks again soon.
            drop(self.0.goes_on.wait_timeout(guard, LOOK));
        }
    }

    /// Whether somebody has asked the work to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }
}

/// Work under way on a thread of its own.
#[derive(Debug)]
pub struct Job<T> {
    progress: Progress,
    thread: JoinHandle<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `work` on a thread called `name`.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub fn start(
        name: &str,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
    ) -> Result<Self, Fault> {
        let progress = Progress::default();
        let theirs = progress.clone();
        let thread = std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || work(&theirs))
            .map_err(|e| {
                Fault::new(
                    format!("no thread for '{name}': {e}"),
                    "close other programs",
                )
            })?;
        Ok(Self { progress, thread })
    }

    /// What to watch, and how to cancel.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Whether [`Job::finish`] would return at once.
    pub fn is_finished(&self) -> bool {
        self.thread.is_finished()
    }

    /// Waits for the end and hands over the result.
    ///
    /// # Errors
    /// Where the work panicked: a defect of ours, told instead of taking the program down.
    pub fn finish(self) -> Result<T, Fault> {
        self.thread.join().map_err(|payload| {
            let what = payload
                .downcast_ref::<&str>()
                .map(|text| (*text).to_owned())
                .or_else(|| payload.downcast_ref::<String>().cloned())
                .unwrap_or_default();
            Fault::new(
                format!("a defect in fragscale: {what}"),
                "please report it, with the file that brought it about",
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_job_reports_and_returns() {
        let job = Job::start("count", |progress| {
            progress.stage("counting");
            progress.advance(1, 4).unwrap();
            7
        })
        .unwrap();
        let progress = job.progress().clone();
        assert_eq!(job.finish(), Ok(7));
        assert_eq!(progress.snapshot(), ("counting".to_owned(), 0.25));
    }

    #[test]
    fn a_cancelled_job_stops_at_its_next_look() {
        let job = Job::start("wait", |progress| {
            while progress.advance(0, 1).is_ok() {
                std::thread::yield_now();
            }
            "stopped"
        })
        .unwrap();
        assert!(!job.is_finished());
        job.progress().cancel();
        assert_eq!(job.finish(), Ok("stopped"));
    }

    /// Work on several threads: paused nobody does a piece more, and all of them are done in the end.
    #[test]
    fn a_paused_job_waits_and_goes_on() {
        use std::sync::atomic::AtomicU32;
        use std::time::Instant;
        let done = Arc::new(AtomicU32::new(0));
        let counted = done.clone();
        let job = Job::start("count", move |progress| {
            std::thread::scope(|scope| {
                for _ in 0..3 {
                    scope.spawn(|| {
                        for _ in 0..2000 {
                            if progress.advance(1, 2).is_err() {
                                return;
                            }
                            counted.fetch_add(1, Ordering::Relaxed);
                            std::thread::sleep(Duration::from_micros(50));
                        }
                    });
                }
            });
        })
        .unwrap();
        let progress = job.progress().clone();
        let count = || done.load(Ordering::Relaxed);
        while count() < 30 {
            std::thread::yield_now();
        }
        progress.pause(true);
        // Each thread ends the piece that it is at.
        std::thread::sleep(Duration::from_millis(100));
        let before = count();
        std::thread::sleep(Duration::from_millis(300));
        assert_eq!(count(), before);
        assert!(before < 6000 && !job.is_finished() && progress.is_paused());
        progress.pause(false);
        job.finish().unwrap();
        assert_eq!(count(), 6000);

        // Cancelled while it waits it ends.
        let job = Job::start("wait", |progress| while progress.advance(0, 1).is_ok() {}).unwrap();
        job.progress().pause(true);
        std::thread::sleep(Duration::from_millis(50));
        let begun = Instant::now();
        job.progress().cancel();
        job.finish().unwrap();
        assert!(begun.elapsed() < Duration::from_secs(1));
    }

    #[test]
    fn a_panic_becomes_a_sentence() {
        let job = Job::start("break", |_| -> u8 { panic!("the ground was not there") }).unwrap();
        let fault = job.finish().unwrap_err();
        assert!(fault.what.contains("the ground was not there"), "{fault}");
    }
}
