//! A season of blasts: what its small window holds. `applying` does its steps.

mod applying;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use crate::batch::{Outcome, Season, SeasonFlight, Step, TakenAway};
use crate::exports::SeasonRow;

/// A step of going through a season.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SeasonStep {
    /// Opens its small window.
    Ask,
    /// Types into it.
    Fill(SeasonForm),
    /// Says which command does a flight, in place of this program.
    Program(PathBuf),
    /// Does what is not done of it.
    Start,
    /// Selects a flight of the list.
    Select(usize),
}

/// A field of the small window that names a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeasonField {
    /// The SEASON.toml, or the folder above the flights.
    Season,
    /// The folder of the results.
    To,
}

/// What is typed and chosen in the small window.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SeasonForm {
    /// The SEASON.toml, or the folder above the flights.
    pub season: String,
    /// The folder of the results; empty for the one that is proposed.
    pub to: String,
    /// The steps; `None` for those that the season says.
    pub steps: Option<Vec<Step>>,
}

/// The season that was named.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundSeason {
    /// Itself, with the steps that are chosen.
    pub season: Season,
    /// Its flights.
    pub flights: Vec<SeasonFlight>,
    /// What to know, a sentence each.
    pub notes: Vec<String>,
    /// Whether the season or any of its flights names what psd holds sizes against, whether that is chosen or not.
    pub has_reference: bool,
    /// The folder of its results.
    pub to: PathBuf,
}

/// How a flight of the list is.
#[derive(Debug, Clone, PartialEq)]
pub enum FlightState {
    /// Nothing was done with it here.
    Waiting,
    /// It was done by an earlier run; whether it still holds is known when the season is done again.
    Earlier(Box<SeasonRow>),
    /// It is being done: the stage in words, and the fraction of the stage.
    Running(String, f64),
    /// It is done with.
    Ended(Outcome, Box<SeasonRow>),
}

impl FlightState {
    /// In a word or two.
    pub fn in_words(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Earlier(_) => "done earlier",
            Self::Running(..) => "running",
            Self::Ended(Outcome::Done, _) => "done",
            Self::Ended(Outcome::AsBefore, _) => "as before",
            Self::Ended(Outcome::Failed, _) => "failed",
        }
    }

    /// A sign before it, so that colour is not all.
    pub fn sign(&self) -> &'static str {
        match self {
            Self::Waiting => "○",
            Self::Running(..) => "▶",
            Self::Ended(Outcome::Failed, _) => "✖",
            Self::Earlier(_) | Self::Ended(..) => "✔",
        }
    }

    /// What is known of the flight.
    pub fn row(&self) -> Option<&SeasonRow> {
        match self {
            Self::Earlier(row) | Self::Ended(_, row) => Some(row),
            Self::Waiting | Self::Running(..) => None,
        }
    }
}

/// What happens to a flight of the list.
#[derive(Debug)]
pub(crate) struct Happened {
    /// Its place.
    flight: usize,
    /// How it is from now on.
    now: FlightState,
    /// How many results of earlier runs it took away, by the file or folder that they were or lay in.
    taken_away: BTreeMap<String, usize>,
}

impl Happened {
    /// Without taking anything away.
    fn new(flight: usize, now: FlightState) -> Self {
        Self {
            flight,
            now,
            taken_away: BTreeMap::new(),
        }
    }
}

/// What the small window holds.
#[derive(Debug, Default)]
pub struct SeasonList {
    /// What is typed.
    pub form: SeasonForm,
    /// What was named; an error is one line; `None` until it has been looked at.
    pub found: Option<Result<FoundSeason, String>>,
    /// How each of its flights is.
    pub states: Vec<FlightState>,
    /// The flight that is selected.
    pub selected: Option<usize>,
    /// What the last run came to, in a sentence; or why it failed.
    pub ended: Option<Result<String, String>>,
    /// What the last run took away of earlier ones.
    pub taken_away: TakenAway,
    /// The command that does a flight; this program where nobody says another.
    pub program: Option<PathBuf>,
    /// Where the run puts what happens, until it is taken.
    happened: Arc<Mutex<Vec<Happened>>>,
}

impl SeasonList {
    /// The season that was named, where it can be used.
    pub fn season(&self) -> Option<&FoundSeason> {
        self.found.as_ref()?.as_ref().ok()
    }

    /// The flight that is selected.
    pub fn selected_flight(&self) -> Option<(&Path, &FlightState)> {
        let place = self.selected?;
        let flight = self.season()?.flights.get(place)?;
        Some((&flight.path, self.states.get(place)?))
    }

    /// Takes what has happened to its flights.
    fn take(&mut self, happened: Vec<Happened>) {
        for happened in happened {
            self.taken_away.add(&happened.taken_away);
            if let Some(state) = self.states.get_mut(happened.flight) {
                *state = happened.now;
            }
        }
    }

    /// Done with, of all; and how many of these failed.
    pub fn counts(&self) -> [usize; 3] {
        let ended = |state: &&FlightState| matches!(state, FlightState::Ended(..));
        let failed = |state: &&FlightState| matches!(state, FlightState::Ended(Outcome::Failed, _));
        let states = self.states.iter();
        [
            states.clone().filter(ended).count(),
            self.states.len(),
            states.filter(failed).count(),
        ]
    }
}
