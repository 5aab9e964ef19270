//! The processes of flights: started as memory allows, listened to, ended.
//!
//! ```text
//! process  one of them
//! ```
//!
//! Estimates may be wrong. Where the system tells what processes hold, more than the stated memory is not taken for
//! long: the flight that began last is taken back and done alone later; one that takes more alone fails.

mod process;

use std::collections::{BTreeMap, VecDeque};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

pub use self::process::COMMAND as FLIGHT_COMMAND;
use self::process::{FlightProcess, Heard, Start};
use crate::asked::Asked;
use crate::exports::SeasonRow;
use crate::fault::Fault;
use crate::files::FileError;
use crate::jobs::Progress;
use crate::memory::{estimate, file_sizes};
use crate::opening::memory_in_words;
use crate::record::write_failed;
use crate::schedule::{Limits, begins};
use crate::season::SeasonFlight;
use crate::told::{FlightDone, FlightTold, SaidLine};

/// So often it is looked whether the work is still wanted, and what memory processes hold.
const LOOK: Duration = Duration::from_millis(100);

/// How flights are done.
#[derive(Debug, Clone)]
pub struct BatchOptions {
    /// The command `fragscale`.
    pub program: PathBuf,
    /// The folder of the season's results.
    pub to: PathBuf,
    /// How many flights at once, at most.
    pub jobs: NonZero<usize>,
    /// How many bytes they may take together.
    pub memory: u64,
    /// Whether files of others may be replaced.
    pub force: bool,
}

impl BatchOptions {
    /// As many flights at once as there are two processors for: a flight keeps several busy.
    pub fn usual_jobs() -> NonZero<usize> {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        NonZero::new(cores / 2).unwrap_or(NonZero::<usize>::MIN)
    }
}

/// What became of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All steps were done.
    Done,
    /// All of it was there already.
    AsBefore,
    /// It, or a step of it, failed.
    Failed,
}

/// A flight that is done with.
#[derive(Debug, Clone, PartialEq)]
pub struct Ended {
    /// Its place among the flights.
    pub flight: usize,
    /// What became of it.
    pub outcome: Outcome,
    /// For the tables.
    pub row: SeasonRow,
    /// How many results of earlier runs were taken away, by the file or folder that they were or lay in.
    pub taken_away: BTreeMap<String, usize>,
}

/// What happens.
#[derive(Debug)]
pub enum Event<'a> {
    /// A flight begins; its place among the flights.
    Begun(usize),
    /// How far it is: its place, the stage in words, and the fraction of the stage.
    At(usize, &'a str, f64),
    /// It took too much memory beside others, and is done alone later.
    TakenBack(usize),
    /// A flight is done with.
    Ended(&'a Ended),
}

/// Does the steps with all flights; what fails, fails alone. Returns them in their order.
///
/// # Errors
/// Only where the work was cancelled: what was done until then stays.
pub fn run(
    asked: &Asked,
    flights: &[SeasonFlight],
    options: &BatchOptions,
    on_event: &dyn Fn(Event<'_>),
    progress: &Progress,
) -> Result<Vec<Ended>, Fault> {
    let (say, hear) = mpsc::channel();
    let mut work = Running {
        asked,
        flights,
        options,
        on_event,
        say,
        started: 0,
        waiting: (0..flights.len()).map(|flight| (flight, None)).collect(),
        running: Vec::new(),
        ended: Vec::new(),
    };
    let done = work.all(&hear, progress);
    // On a cancel; else there is none. All are asked before the first is waited for.
    work.running.iter_mut().for_each(FlightProcess::ask_to_end);
    work.running.iter_mut().for_each(FlightProcess::end);
    done?;
    let mut ended = work.ended;
    ended.sort_by_key(|ended| ended.flight);
    Ok(ended)
}

struct Running<'a> {
    asked: &'a Asked,
    flights: &'a [SeasonFlight],
    options: &'a BatchOptions,
    on_event: &'a dyn Fn(Event<'_>),
    say: Sender<(u64, Heard)>,
    /// How many processes were started: one that was ended may still say something when its flight is begun again.
    started: u64,
    /// Flights with what they need, once that is known.
    waiting: VecDeque<(usize, Option<u64>)>,
    /// The one that began last is the last.
    running: Vec<FlightProcess>,
    ended: Vec<Ended>,
}

impl Running<'_> {
    fn all(&mut self, hear: &Receiver<(u64, Heard)>, progress: &Progress) -> Result<(), Fault> {
        let mut looked = Instant::now();
        loop {
            progress.advance(self.ended.len() as u64, self.flights.len() as u64)?;
            self.begin();
            if self.running.is_empty() && self.waiting.is_empty() {
                return Ok(());
            }
            match hear.recv_timeout(LOOK) {
                Ok((number, heard)) => self.heard(number, heard),
                // This thread has a sender itself.
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
            }
            if looked.elapsed() > LOOK {
                looked = Instant::now();
                self.look_at_memory();
            }
        }
    }

    /// Starts those that there is room for.
    fn begin(&mut self) {
        let limits = Limits {
            jobs: self.options.jobs.get(),
            memory: self.options.memory,
        };
        while let Some((flight, need)) = self.waiting.front_mut() {
            let flight = *flight;
            let own = &self.flights[flight];
            let need = *need.get_or_insert_with(|| {
                let (surface, photos) = (own.surface.as_deref(), own.photos.as_deref());
                estimate(file_sizes(&own.path, surface, photos), self.asked)
            });
            let taken: Vec<u64> = self.running.iter().map(|process| process.need).collect();
            if !begins(limits, &taken, need) {
                return;
            }
            self.waiting.pop_front();
            (self.on_event)(Event::Begun(flight));
            let told = FlightTold {
                flight: own.path.clone(),
                surface: own.surface.clone(),
                photos: own.photos.clone(),
                reference: own.reference.clone(),
                to: self.options.to.join(&own.results),
                asked: self.asked.clone(),
                force: self.options.force,
            };
            self.started += 1;
            let start = Start {
                program: &self.options.program,
                number: self.started,
                flight,
                need,
                jobs: limits.jobs,
            };
            match FlightProcess::start(&start, &told, self.say.clone()) {
                Ok(process) => self.running.push(process),
                Err(fault) => self.failed(flight, &fault),
            }
        }
    }

    fn heard(&mut self, number: u64, heard: Heard) {
        let mut running = self.running.iter();
        let Some(place) = running.position(|process| process.number == number) else {
            return;
        };
        let flight = self.running[place].flight;
        match heard {
            Heard::Line(SaidLine::At { stage, fraction }) => {
                (self.on_event)(Event::At(flight, &stage, fraction));
            }
            Heard::Line(SaidLine::Done(done)) => self.running[place].done = Some(done),
            Heard::Closed => match self.running.remove(place).conclude() {
                Ok(done) => self.done(flight, done),
                Err(fault) => self.failed(flight, &fault),
            },
        }
    }

    /// Holds the processes to the memory that was stated.
    fn look_at_memory(&mut self) {
        let held = self.running.iter().filter_map(FlightProcess::memory);
        let held = held.fold(0_u64, u64::saturating_add);
        if held <= self.options.memory {
            return;
        }
        let Some(mut process) = self.running.pop() else {
            return;
        };
        process.end();
        let flight = process.flight;
        if self.running.is_empty() {
            let given = memory_in_words(self.options.memory);
            let what = format!("it takes more memory than the {given} that are given");
            self.failed(flight, &Fault::new(what, "give more (--memory)"));
        } else {
            self.waiting.push_front((flight, Some(u64::MAX)));
            (self.on_event)(Event::TakenBack(flight));
        }
    }

    fn failed(&mut self, flight: usize, fault: &Fault) {
        let path: &Path = &self.flights[flight].path;
        let error = FileError::new(path, fault.clone()).to_string();
        self.done(
            flight,
            FlightDone {
                error: Some(error),
                ..FlightDone::default()
            },
        );
    }

    fn done(&mut self, flight: usize, done: FlightDone) {
        let own = &self.flights[flight];
        let taken = done
            .findings
            .as_ref()
            .and_then(|findings| findings.taken.as_ref());
        let date = own
            .date
            .or_else(|| taken.and_then(|taken| taken.parse().ok()));
        if let Some(error) = &done.error {
            // Where even that cannot be written, the table says it.
            let _ = write_failed(&self.options.to.join(&own.results), error);
        }
        let outcome = match (&done.error, done.as_before) {
            (Some(_), _) => Outcome::Failed,
            (None, true) => Outcome::AsBefore,
            (None, false) => Outcome::Done,
        };
        let ended = Ended {
            flight,
            outcome,
            row: SeasonRow {
                blast: own.blast.clone(),
                date,
                flight: own.path.display().to_string(),
                results: own.results.clone(),
                findings: done.findings,
                error: done.error,
            },
            taken_away: done.taken_away,
        };
        (self.on_event)(Event::Ended(&ended));
        self.ended.push(ended);
    }
}
