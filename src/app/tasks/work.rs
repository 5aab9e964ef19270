//! The jobs under way, each with its own ending.
//!
//! The window never waits: it asks now and then whether something is done, and runs its ending. Work
//! whose result nobody wants any more is cancelled and ends on its own. `S` is what endings change: it
//! lies above this file, which knows nothing of it.
//!
//! What a frame asks for because it is missing (a map, a cloud on the graphics card) is started as a wish:
//! a wish that failed, or whose work panicked, is refused until something else is wished for, so that no
//! frame tries the same again and its fault is told once.

use std::any::Any;
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

/// What is wished for, to be compared with what was refused.
type Wish = Box<dyn Any + Send>;

struct Running<S: 'static> {
    task: Task,
    job: Job<Result<Ending<S>, Fault>>,
    /// What a frame has asked for with it.
    wish: Option<Wish>,
}

struct Refused {
    task: Task,
    wish: Wish,
    why: String,
}

/// How many failed wishes of a task are remembered: more clouds than anybody looks at, and not every place
/// that a map was dragged to.
const REFUSED: usize = 16;

/// The jobs under way.
pub struct Work<S: 'static> {
    running: Vec<Running<S>>,
    /// The wishes that failed, oldest first; of each task so many at most.
    refused: Vec<Refused>,
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
            refused: Vec::new(),
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
        let work = move |progress: &Progress| Ok(work(progress));
        self.run(task, None, work, ending)
    }

    /// Starts what a frame asks for because it is not there: not while a job of the kind runs, and not where
    /// the same was refused. `ending` is handed what `work` has made; a fault is told by
    /// [`Work::finished`], and refuses the wish.
    ///
    /// # Errors
    /// Where the system has no thread left: said once as well.
    pub fn start_wished<W, T>(
        &mut self,
        task: Task,
        wish: W,
        work: impl FnOnce(&Progress) -> Result<T, Fault> + Send + 'static,
        ending: impl FnOnce(&mut S, T) + Send + 'static,
    ) -> Result<(), Fault>
    where
        W: Any + Send + Clone + PartialEq,
        T: Send + 'static,
    {
        if !self.may_start(task, &wish) {
            return Ok(());
        }
        let started = self.run(task, Some(Box::new(wish.clone())), work, ending);
        match started {
            Ok(()) => Ok(()),
            Err(fault) => match self.refuse(task, Box::new(wish), &fault) {
                true => Err(fault),
                false => Ok(()),
            },
        }
    }

    fn run<T>(
        &mut self,
        task: Task,
        wish: Option<Wish>,
        work: impl FnOnce(&Progress) -> Result<T, Fault> + Send + 'static,
        ending: impl FnOnce(&mut S, T) + Send + 'static,
    ) -> Result<(), Fault>
    where
        T: Send + 'static,
    {
        self.cancel(task);
        let context = self.context.clone();
        let job = Job::start(task.in_words, move |progress| {
            // Also where the work panics.
            let _wake = Wake(context);
            let result = work(progress)?;
            let ending: Ending<S> = Box::new(move |state| ending(state, result));
            Ok(ending)
        })?;
        self.running.push(Running { task, job, wish });
        Ok(())
    }

    /// Whether a frame that misses this may ask for it now: no job of the kind runs, and the same was not
    /// refused.
    pub fn may_start<W: Any + PartialEq>(&self, task: Task, wish: &W) -> bool {
        !self.is_running(task) && self.refused(task, wish).is_none()
    }

    /// Why this was refused, if it was.
    pub fn refused<W: Any + PartialEq>(&self, task: Task, wish: &W) -> Option<&str> {
        let mut of_task = self.refused.iter().filter(|refused| refused.task == task);
        let refused = of_task.find(|refused| refused.wish.downcast_ref() == Some(wish))?;
        Some(&refused.why)
    }

    /// Lets everything of a task be tried again: somebody has asked for it.
    pub fn try_again(&mut self, task: Task) {
        self.refused.retain(|refused| refused.task != task);
    }

    /// Notes that a wish cannot be fulfilled; whether that is news: while one drags, each frame wishes for
    /// something else that fails alike.
    fn refuse(&mut self, task: Task, wish: Wish, fault: &Fault) -> bool {
        let why = fault.to_string();
        let of_task = |refused: &Refused| refused.task == task;
        let last = self.refused.iter().rfind(|refused| of_task(refused));
        let is_news = last.is_none_or(|last| last.why != why);
        self.refused.push(Refused { task, wish, why });
        if self
            .refused
            .iter()
            .filter(|refused| of_task(refused))
            .count()
            > REFUSED
            && let Some(oldest) = self.refused.iter().position(of_task)
        {
            self.refused.remove(oldest);
        }
        is_news
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
        self.refused.retain(|refused| !refused.task.is_of_flight);
    }

    /// Cancels everything.
    pub fn cancel_all(&mut self) {
        self.cancel_where(|_| true);
        self.refused.clear();
    }

    fn cancel_where(&mut self, unwanted: impl Fn(Task) -> bool) {
        self.running.retain(|running| {
            let unwanted = unwanted(running.task);
            if unwanted {
                running.job.progress().cancel();
            }
            !unwanted
        });
    }

    /// Lets a task wait, or go on.
    pub fn pause(&self, task: Task, paused: bool) {
        for running in self.running.iter().filter(|running| running.task == task) {
            running.job.progress().pause(paused);
        }
    }

    /// Whether a task that runs is to wait.
    pub fn is_paused(&self, task: Task) -> bool {
        let mut of_task = self.running.iter().filter(|running| running.task == task);
        of_task.any(|running| running.job.progress().is_paused())
    }

    /// Whether a file is being written.
    pub fn is_writing(&self) -> bool {
        self.running.iter().any(|running| running.task.writes)
    }

    /// What runs, with its sentence and its fraction from 0 to 1.
    pub fn running(&self) -> impl Iterator<Item = (Task, (String, f64))> {
        self.running
            .iter()
            .map(|running| (running.task, running.job.progress().snapshot()))
    }

    /// Whether this task runs.
    pub fn is_running(&self, task: Task) -> bool {
        self.running.iter().any(|running| running.task == task)
    }

    /// Whether nothing runs.
    pub fn is_idle(&self) -> bool {
        self.running.is_empty()
    }

    /// The ending of the first that is done: one at a time, because it may cancel others that are done
    /// as well. A job that panicked is a fault of ours, told like any other; of wishes that fail alike one
    /// after the other only the first is told.
    pub fn finished(&mut self) -> Option<Result<Ending<S>, Fault>> {
        loop {
            let is_done = |running: &Running<S>| running.job.is_finished();
            let place = self.running.iter().position(is_done)?;
            let Running { task, job, wish } = self.running.remove(place);
            match (job.finish().and_then(|done| done), wish) {
                (Ok(ending), _) => return Some(Ok(ending)),
                (Err(fault), None) => return Some(Err(fault)),
                (Err(fault), Some(wish)) => {
                    if self.refuse(task, wish, &fault) {
                        return Some(Err(fault));
                    }
                }
            }
        }
    }
}

/// Wakes the window when it is dropped.
struct Wake(egui::Context);

impl Drop for Wake {
    fn drop(&mut self) {
        self.0.request_repaint();
    }
}

impl<S: 'static> Drop for Work<S> {
    fn drop(&mut self) {
        for running in &self.running {
            running.job.progress().cancel();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU32, Ordering};

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
    /// A frame asks for what is missing, over and over; the work panics, or fails. It is told once, and tried
    /// again when something else is asked for.
    #[test]
    fn a_wish_that_failed_is_not_tried_again() {
        let (mut work, mut state) = (Work::new(egui::Context::default()), Vec::new());
        let tries = Arc::new(AtomicU32::new(0));
        let mut said = Vec::new();
        let mut frames = |wish: f64, work: &mut Work<Vec<u32>>, state: &mut Vec<u32>| {
            for _ in 0..20 {
                let tries = tries.clone();
                let job = move |_: &Progress| {
                    tries.fetch_add(1, Ordering::Relaxed);
                    match wish {
                        1.0 | 2.0 => panic!("no ground"),
                        3.0 => Err(Fault::new("no room", "make some")),
                        _ => Ok(4),
                    }
                };
                if state.is_empty() {
                    work.start_wished(COUNT, wish, job, |state: &mut Vec<u32>, n| state.push(n))
                        .unwrap();
                }
                while !work.is_idle() {
                    match work.finished() {
                        Some(Ok(ending)) => ending(state),
                        Some(Err(fault)) => said.push(fault.to_string()),
                        None => std::thread::yield_now(),
                    }
                }
            }
            (tries.load(Ordering::Relaxed), said.len())
        };
        assert_eq!(frames(1.0, &mut work, &mut state), (1, 1));
        assert!(work.refused(COUNT, &1.0).unwrap().contains("no ground"));
        assert_eq!(work.refused(COUNT, &2.0), None);
        // The same again of another wish: tried, and not said once more.
        assert_eq!(frames(2.0, &mut work, &mut state), (2, 1));
        assert_eq!(frames(3.0, &mut work, &mut state), (3, 2));
        assert_eq!(frames(4.0, &mut work, &mut state), (4, 2));
        assert_eq!(state, [4]);
        state.clear();
        assert_eq!(frames(1.0, &mut work, &mut state), (4, 2));
        work.try_again(COUNT);
        assert_eq!(frames(1.0, &mut work, &mut state), (5, 3));
        // Another flight begins anew.
        work.cancel_for_flight();
        assert!(!work.may_start(COUNT, &1.0));
        work.cancel_all();
        assert!(work.may_start(COUNT, &1.0));
    }
}
