//! The jobs under way, each with its own ending.
//!
//! The window never waits: it asks now and then whether something is done, and runs its ending. Work
//! whose result nobody wants any more is cancelled and ends on its own. `S` is what endings change: it
//! lies above this file, which knows nothing of it.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use crate::fault::Fault;
use crate::jobs::{Job, Progress};

/// What is being done. Of each task one job runs at a time. The tasks are defined beside the jobs that
/// do them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Task {
    /// For the status bar; what tells it from others.
    pub in_words: &'static str,
    /// Whether the engineer can cancel it: without footprints and triangles the flight on the screen
    /// would stay half-finished.
    pub can_be_cancelled: bool,
    /// Whether nobody wants it any more once the flight on the screen is gone.
    pub is_of_flight: bool,
    /// Whether it writes a file: leaving the program asks first.
    pub writes: bool,
}

impl Task {
    /// A task that can be cancelled, belongs to no flight and writes nothing.
    pub const fn new(in_words: &'static str) -> Self {
        Self {
            in_words,
            can_be_cancelled: true,
            is_of_flight: false,
            writes: false,
        }
    }

    /// The same, of the flight on the screen.
    #[must_use]
    pub const fn of_flight(self) -> Self {
        Self {
            is_of_flight: true,
            ..self
        }
    }

    /// The same, which the engineer cannot cancel.
    #[must_use]
    pub const fn to_the_end(self) -> Self {
        Self {
            can_be_cancelled: false,
            ..self
        }
    }

    /// The same, which writes a file.
    #[must_use]
    pub const fn writing(self) -> Self {
        Self {
            writes: true,
            ..self
        }
    }
}

/// What a job does to the state: at its end, or on its way.
pub type Ending<S> = Box<dyn FnOnce(&mut S) + Send>;

/// For a job that has something to show before its end.
pub struct Steps<S>(SyncSender<Ending<S>>);

impl<S> Steps<S> {
    /// Hands a step over as soon as there is room; false where nobody wants it any more.
    pub fn offer(&self, step: impl FnOnce(&mut S) + Send + 'static, progress: &Progress) -> bool {
        let mut step: Ending<S> = Box::new(step);
        loop {
            match self.0.try_send(step) {
                Ok(()) => return true,
                Err(TrySendError::Disconnected(_)) => return false,
                Err(TrySendError::Full(back)) => {
                    if progress.is_cancelled() {
                        return false;
                    }
                    step = back;
                    std::thread::sleep(Duration::from_millis(5));
                }
            }
        }
    }
}

/// The jobs under way.
pub struct Work<S: 'static> {
    running: Vec<(Task, Job<Ending<S>>)>,
    context: egui::Context,
    steps: Receiver<Ending<S>>,
    send_step: SyncSender<Ending<S>>,
}

impl<S: 'static> Work<S> {
    /// Nothing to do yet. The context is woken when something is done.
    pub fn new(context: egui::Context) -> Self {
        // Bounded: steps wait in the job, not in memory, until the window has taken some.
        let (send_step, steps) = sync_channel(16);
        Self {
            running: Vec::new(),
            context,
            steps,
            send_step,
        }
    }

    /// Starts a task; one of the same kind that still runs is cancelled and its result dropped.
    /// `ending` is handed the result of `work` on the window's thread.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub fn start<T>(
        &mut self,
        task: Task,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
        ending: impl FnOnce(&mut S, T) + Send + 'static,
    ) -> Result<(), Fault>
    where
        T: Send + 'static,
    {
        self.cancel(task);
        let context = self.context.clone();
        let job = Job::start(task.in_words, move |progress| {
            let result = work(progress);
            context.request_repaint();
            let ending: Ending<S> = Box::new(move |state| ending(state, result));
            ending
        })?;
        self.running.push((task, job));
        Ok(())
    }

    /// Where a job sends what it has to show before its end.
    pub fn steps_of_a_job(&self) -> Steps<S> {
        Steps(self.send_step.clone())
    }

    /// The steps that have arrived, at most `most`.
    pub fn steps(&self, most: usize) -> Vec<Ending<S>> {
        self.steps.try_iter().take(most).collect()
    }

    /// Cancels a task, if it runs; its result will not be seen.
    pub fn cancel(&mut self, task: Task) {
        self.cancel_where(|running| running == task);
    }

    /// Cancels what belongs to the flight on the screen; what is written goes on.
    pub fn cancel_for_flight(&mut self) {
        self.cancel_where(|task| task.is_of_flight);
    }

    /// Cancels everything.
    pub fn cancel_all(&mut self) {
        self.cancel_where(|_| true);
    }

    fn cancel_where(&mut self, unwanted: impl Fn(Task) -> bool) {
        self.running.retain(|(task, job)| {
            let unwanted = unwanted(*task);
            if unwanted {
                job.progress().cancel();
            }
            !unwanted
        });
    }

    /// Whether a file is being written.
    pub fn is_writing(&self) -> bool {
        self.running.iter().any(|(task, _)| task.writes)
    }

    /// What runs, with its sentence and its fraction from 0 to 1.
    pub fn running(&self) -> impl Iterator<Item = (Task, (String, f64))> {
        self.running
            .iter()
            .map(|(task, job)| (*task, job.progress().snapshot()))
    }

    /// Whether this task runs.
    pub fn is_running(&self, task: Task) -> bool {
        self.running.iter().any(|(running, _)| *running == task)
    }

    /// Whether nothing runs.
    pub fn is_idle(&self) -> bool {
        self.running.is_empty()
    }

    /// The ending of the first that is done: one at a time, because it may cancel others that are done
    /// as well. A job that panicked is a fault of ours, told like any other.
    pub fn finished(&mut self) -> Option<Result<Ending<S>, Fault>> {
        let place = self.running.iter().position(|(_, job)| job.is_finished())?;
        let (_, job) = self.running.remove(place);
        Some(job.finish())
    }
}

impl<S: 'static> Drop for Work<S> {
    fn drop(&mut self) {
        for (_, job) in &self.running {
            job.progress().cancel();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COUNT: Task = Task::new("Counting");

    /// Runs endings until nothing is under way.
    fn finish(work: &mut Work<Vec<u32>>, state: &mut Vec<u32>) {
        while !work.is_idle() {
            if let Some(ending) = work.finished() {
                ending.unwrap()(state);
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_job_brings_its_ending() {
        let (mut work, mut state) = (Work::new(egui::Context::default()), Vec::new());
        work.start(COUNT, |_| 3, |state: &mut Vec<u32>, n| state.push(n))
            .unwrap();
        assert!(work.is_running(COUNT) && !work.is_writing());
        finish(&mut work, &mut state);
        assert_eq!(state, [3]);
    }

    /// The second of a kind takes the place of the first, whose ending nobody sees.
    #[test]
    fn one_of_a_kind_runs() {
        let (mut work, mut state) = (Work::new(egui::Context::default()), Vec::new());
        for number in [1, 2] {
            let ending = move |state: &mut Vec<u32>, ()| state.push(number);
            work.start(COUNT.writing(), |_| (), ending).unwrap();
            assert!(work.is_writing());
        }
        finish(&mut work, &mut state);
        assert_eq!(state, [2]);
    }

    #[test]
    fn what_belongs_to_a_flight_goes_with_it() {
        let mut work: Work<Vec<u32>> = Work::new(egui::Context::default());
        let saving = Task::new("Saving").writing();
        for task in [COUNT.of_flight(), saving] {
            work.start(task, |_| (), |_, ()| ()).unwrap();
        }
        work.cancel_for_flight();
        assert!(work.is_running(saving) && !work.is_running(COUNT.of_flight()));
    }

    #[test]
    fn steps_come_before_the_end() {
        let (mut work, mut state) = (Work::new(egui::Context::default()), Vec::new());
        let steps = work.steps_of_a_job();
        let job = move |progress: &Progress| {
            for number in 0..40 {
                steps.offer(move |state: &mut Vec<u32>| state.push(number), progress);
            }
        };
        work.start(COUNT, job, |_, ()| ()).unwrap();
        while !(work.is_idle() && state.len() == 40) {
            work.steps(8).into_iter().for_each(|step| step(&mut state));
            if let Some(ending) = work.finished() {
                ending.unwrap()(&mut state);
            }
        }
        assert!(state.iter().copied().eq(0..40));
    }
}
