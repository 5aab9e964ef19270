//! Going through a season: looking what it holds, and doing it, by the function of `fragscale batch`.

use std::path::{Path, PathBuf};
use std::sync::{Arc, PoisonError};
use std::time::Duration;

use super::{FlightState, FoundSeason, Happened, SeasonField, SeasonForm, SeasonStep};
use crate::batch::{
    Asked, BatchOptions, Event, Outcome, Record, ResultsFolder, Season, SeasonFlight, Step,
    TakenAway, run, write_results,
};
use crate::command::Asking;
use crate::exports::SeasonRow;
use crate::jobs::Progress;
use crate::opening::half_of_the_machines;
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::typed::typed;
use crate::units::LengthUnit;

impl Task {
    /// Looking which flights a season has.
    pub const LOOK_AT_SEASON: Self = Self::new("Looking at the season");
    /// Doing the flights of a season.
    pub const SEASON: Self = Self::new("Season").writing();
}

/// A path that is still typed is another one in a moment, and "/" is a walk over the whole disk.
const TYPED: Duration = Duration::from_millis(300);

impl State {
    /// Does a step of going through a season.
    pub(crate) fn step_season(&mut self, step: SeasonStep) {
        match step {
            SeasonStep::Ask => {
                self.ask(Some(Asking::Season));
                // Flights may have come, also behind a run that has ended.
                if !self.work.is_running(Task::SEASON) {
                    self.look_at_season(Duration::ZERO);
                }
            }
            SeasonStep::Fill(form) => self.fill_season(form),
            SeasonStep::Program(program) => self.season.program = Some(program),
            SeasonStep::Start => self.start_season(),
            SeasonStep::Select(flight) => self.season.selected = Some(flight),
        }
    }

    /// Takes what was chosen in the desktop's dialog.
    pub(crate) fn take_place_of_season(&mut self, field: SeasonField, path: &Path) {
        let mut form = self.season.form.clone();
        let text = path.display().to_string();
        match field {
            SeasonField::Season => form.season = text,
            SeasonField::To => form.to = text,
        }
        self.fill_season(form);
    }

    fn fill_season(&mut self, form: SeasonForm) {
        if self.work.is_running(Task::SEASON) || self.season.form == form {
            return;
        }
        let is_other = self.season.form.season != form.season;
        let is_typed = is_other || self.season.form.to != form.to;
        self.season.form = form;
        if is_other {
            // Another season says its own.
            self.season.form.steps = None;
        }
        self.season.ended = None;
        self.season.taken_away = TakenAway::default();
        self.look_at_season(if is_typed { TYPED } else { Duration::ZERO });
    }

    /// Looks which flights there are, once nothing has been typed for so long.
    fn look_at_season(&mut self, wait: Duration) {
        self.work.cancel(Task::LOOK_AT_SEASON);
        self.season.found = None;
        self.season.states.clear();
        self.season.selected = None;
        let form = self.season.form.clone();
        // Half of a path that is being typed is no place.
        let Some(path) = typed(&form.season).filter(|path| path.exists()) else {
            return;
        };
        let unit = self.preferences.unit();
        let work = move |progress: &Progress| {
            std::thread::sleep(wait);
            match progress.is_cancelled() {
                true => Err("given up".to_owned()),
                false => look(&path, &form, unit),
            }
        };
        self.start(Task::LOOK_AT_SEASON, work, |state, found| {
            state.season.found = Some(found.map(|(found, states)| {
                state.season.states = states;
                found
            }));
        });
    }

    fn start_season(&mut self) {
        if self.is_busy(Task::SEASON) {
            return;
        }
        let Some(found) = self.season.season().cloned() else {
            return;
        };
        let program = self
            .season
            .program
            .clone()
            .map_or_else(std::env::current_exe, Ok);
        let program = match program {
            Ok(program) => program,
            Err(error) => {
                let text = format!("this program is not found ({error}); install it anew");
                return self.say(Severity::Error, &text);
            }
        };
        self.season.ended = None;
        self.season.taken_away = TakenAway::default();
        self.season.states = vec![FlightState::Waiting; found.flights.len()];
        // Of its own: a cancelled run may still have something to say.
        self.season.happened = Arc::default();
        let happened = self.season.happened.clone();
        let options = BatchOptions {
            program,
            to: found.to.clone(),
            jobs: BatchOptions::usual_jobs(),
            memory: half_of_the_machines(),
            force: false,
        };
        let work = move |progress: &Progress| {
            let tell = |happens: Happened| {
                let mut happened = happened.lock().unwrap_or_else(PoisonError::into_inner);
                happened.push(happens);
            };
            do_season(&found, &options, &tell, progress)
        };
        self.start(
            Task::SEASON,
            work,
            |state, ended: Result<String, String>| {
                state.end_season();
                match &ended {
                    Ok(said) => state.say(Severity::Note, said),
                    Err(why) => {
                        let before = state.notice.take();
                        state.say(Severity::Error, why);
                        if state.asking == Some(Asking::Season) {
                            // The small window says it.
                            state.notice = before;
                        }
                    }
                }
                state.season.ended = Some(ended);
            },
        );
    }

    /// Takes what has happened to the flights of the season. Where somebody is just putting something there, the next frame does.
    pub(crate) fn take_season(&mut self) {
        let Ok(mut happened) = self.season.happened.try_lock() else {
            return;
        };
        let all = std::mem::take(&mut *happened);
        drop(happened);
        self.season.take(all);
    }

    /// Takes the last of what has happened, where the run has ended as where she has cancelled it, and says what it took away.
    fn end_season(&mut self) {
        // No frame takes what is left behind here: who is just putting something there is waited for.
        let happened = self.season.happened.lock();
        let mut happened = happened.unwrap_or_else(PoisonError::into_inner);
        let all = std::mem::take(&mut *happened);
        drop(happened);
        self.season.take(all);
        let away: Vec<String> = self.season.taken_away.lines().collect();
        for line in away {
            self.say(Severity::Note, &line);
        }
    }

    /// What the list says once she has cancelled it.
    pub(crate) fn season_cancelled(&mut self) {
        // What finished flights took away is gone.
        self.end_season();
        self.season.happened = Arc::default();
        for state in &mut self.season.states {
            if matches!(state, FlightState::Running(..)) {
                *state = FlightState::Waiting;
            }
        }
        let what = "Cancelled. What is done stays: Start goes on with the rest.";
        self.season.ended = Some(Ok(what.to_owned()));
    }
}

/// What a season holds, and what earlier runs have left of it.
fn look(
    path: &Path,
    form: &SeasonForm,
    unit: LengthUnit,
) -> Result<(FoundSeason, Vec<FlightState>), String> {
    // Results know the way to their flights, wherever the program was started.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut season = match Season::is_season(&path) {
        true => Season::read(&path).map_err(|error| error.to_string())?,
        false => {
            let mut asked = Asked::of(&[Step::Scales, Step::Check]);
            asked.unit = match Asked::UNITS.contains(&unit.symbol()) {
                true => unit.symbol().to_owned(),
                false => "ft".to_owned(),
            };
            Season::of_folders(std::slice::from_ref(&path), asked)
                .map_err(|error| error.to_string())?
        }
    };
    let of_season = season.asked.names_reference();
    if let Some(steps) = &form.steps {
        season.asked.set_steps(steps);
    }
    let to = typed(&form.to).map(|to| std::path::absolute(&to).unwrap_or(to));
    let to = to.or_else(|| season.to.clone());
    let to = to.unwrap_or_else(|| proposed(&path));
    let found = season.flights(&to).map_err(|error| error.to_string())?;
    let states = found.flights.iter().map(|flight| {
        let record = Record::in_folder(&to.join(&flight.results));
        record.map_or(FlightState::Waiting, |record| {
            FlightState::Earlier(Box::new(earlier(flight, record)))
        })
    });
    let states = states.collect();
    let mut of_flights = found.flights.iter();
    let found = FoundSeason {
        has_reference: of_season || of_flights.any(|flight| flight.reference.is_some()),
        season,
        flights: found.flights,
        notes: found.notes,
        to,
    };
    Ok((found, states))
}

fn earlier(flight: &SeasonFlight, record: Record) -> SeasonRow {
    let taken = record.findings.taken.as_ref();
    SeasonRow {
        blast: flight.blast.clone(),
        date: flight
            .date
            .or_else(|| taken.and_then(|taken| taken.parse().ok())),
        flight: flight.path.display().to_string(),
        results: flight.results.clone(),
        findings: Some(record.findings),
        error: None,
    }
}

/// A folder beside that of the flights, or beside SEASON.toml.
fn proposed(path: &Path) -> PathBuf {
    let name = match path.is_dir() {
        true => path.file_name(),
        false => path.file_stem(),
    };
    let name = name.unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{name} results"))
}

/// The folder of the results; a run that was cancelled may need a moment to leave it.
fn held(to: &Path, progress: &Progress) -> Result<ResultsFolder, String> {
    for _ in 0..50 {
        if let Ok(folder) = ResultsFolder::open(to) {
            return Ok(folder);
        }
        progress.advance(0, 1).map_err(|fault| fault.to_string())?;
        std::thread::sleep(Duration::from_millis(100));
    }
    ResultsFolder::open(to).map_err(|error| error.to_string())
}

/// Does a season; a sentence about what came of it.
fn do_season(
    found: &FoundSeason,
    options: &BatchOptions,
    tell: &dyn Fn(Happened),
    progress: &Progress,
) -> Result<String, String> {
    let asked = &found.season.asked;
    asked.check()?;
    let unit = asked.length_unit()?;
    let _held = held(&options.to, progress)?;
    progress.stage("doing the flights");
    let on_event = |event: Event<'_>| match event {
        Event::Begun(flight) => {
            let now = FlightState::Running("opening".to_owned(), 0.0);
            tell(Happened::new(flight, now));
        }
        Event::At(flight, stage, fraction) => {
            let now = FlightState::Running(stage.to_owned(), fraction);
            tell(Happened::new(flight, now));
        }
        Event::TakenBack(flight) => tell(Happened::new(flight, FlightState::Waiting)),
        Event::Ended(ended) => {
            let row = Box::new(ended.row.clone());
            tell(Happened {
                flight: ended.flight,
                now: FlightState::Ended(ended.outcome, row),
                taken_away: ended.taken_away.clone(),
            });
        }
    };
    let ended = run(asked, &found.flights, options, &on_event, progress);
    let ended = ended.map_err(|fault| fault.to_string())?;
    let count = |outcome| {
        ended
            .iter()
            .filter(|ended| ended.outcome == outcome)
            .count()
    };
    let [done, as_before, failed] = [Outcome::Done, Outcome::AsBefore, Outcome::Failed].map(count);
    let rows = ended.into_iter().map(|ended| ended.row).collect();
    let name = &found.season.name;
    let notes = found.notes.clone();
    write_results(&options.to, name, unit, rows, notes, false)
        .map_err(|error| error.to_string())?;
    Ok(format!(
        "{done} done, {as_before} as before, {failed} failed; the tables are season.html and season.csv in {}",
        options.to.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::preferences::Preferences;

    /// Also of a flight whose end is just being told by its worker.
    #[test]
    fn what_a_cancelled_season_took_away_is_said() {
        let mut state = State::new(egui::Context::default(), Preferences::default());
        let running = || FlightState::Running("opening".to_owned(), 0.0);
        state.season.states = vec![running(), running()];
        let happened = state.season.happened.clone();
        let (holds, is_held) = std::sync::mpsc::channel();
        let worker = std::thread::spawn(move || {
            let mut happened = happened.lock().expect("a lock");
            holds.send(()).expect("somebody waits");
            std::thread::sleep(Duration::from_millis(100));
            let row = SeasonRow {
                blast: "north".to_owned(),
                date: None,
                flight: "north".to_owned(),
                results: "north".to_owned(),
                findings: None,
                error: None,
            };
            happened.push(Happened {
                flight: 0,
                now: FlightState::Ended(Outcome::Done, Box::new(row)),
                taken_away: std::iter::once(("check.txt".to_owned(), 1)).collect(),
            });
        });
        is_held.recv().expect("it is held");
        state.season_cancelled();
        worker.join().expect("it has ended");
        let words = state.season.states.iter().map(FlightState::in_words);
        assert_eq!(words.collect::<Vec<_>>(), ["done", "waiting"]);
        let said = state.log.iter().map(|line| line.text.as_str());
        let said = said.filter(|text| text.starts_with("taken away: check.txt of 1 flight,"));
        assert_eq!(said.count(), 1);
    }
}
