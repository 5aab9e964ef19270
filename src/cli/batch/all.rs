//! All flights of a season: one line of progress for each, the tables, the exit status.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::arguments::{BatchArguments, BatchFormat, Refused};
use crate::batch::{
    Arrivals, BatchOptions, Ended, Event, Outcome, ResultsFolder, Season, SeasonFlight, Seen,
    TakenAway, notes_on_results, run, write_results,
};
use crate::cli::{fail, interrupt, print, say};
use crate::exports::{SeasonRow, season_json_line, size_text};
use crate::fault::one_line;
use crate::jobs::{Job, Progress};
use crate::numbers::counted;
use crate::units::LengthUnit;

/// Some flights failed.
const SOME_FAILED: u8 = 3;

/// So often it is looked for new flights.
const LOOK: Duration = Duration::from_secs(1);

/// What stays of a batch that is interrupted.
pub(in crate::cli) fn kept() -> String {
    "what is done stays: the same command goes on with the rest".to_owned()
}

/// `fragscale batch`.
pub(in crate::cli) fn batch(arguments: BatchArguments) -> ExitCode {
    let (season, options) = match arguments.season() {
        Ok(season) => season,
        Err(Refused::Season(what)) => return fail(&what),
        Err(Refused::Usage(what)) => {
            say(&format!("error: {what}; see 'fragscale batch --help'"));
            return ExitCode::from(2);
        }
    };
    let work = move |progress: &Progress| {
        let unit = season.asked.length_unit()?;
        let batch = Batch {
            season,
            options,
            unit,
            format: arguments.format,
        };
        let settle = Duration::from_secs(arguments.settle);
        match arguments.watch.is_some() {
            true => batch.watch(settle, progress),
            false => batch.once(progress),
        }
    };
    let done = Job::start("batch", work).and_then(|job| {
        interrupt::stops(job.progress());
        job.finish()
    });
    match done.map_err(|fault| fault.to_string()).flatten() {
        Ok((text, failed)) => {
            let printed = print(&text);
            match failed {
                None => printed,
                Some(what) => {
                    say(&format!("error: {what}"));
                    ExitCode::from(SOME_FAILED)
                }
            }
        }
        Err(message) => interrupt::interrupted().unwrap_or_else(|| fail(&message)),
    }
}

/// A season that is being done.
struct Batch {
    season: Season,
    options: BatchOptions,
    unit: LengthUnit,
    format: BatchFormat,
}

impl Batch {
    /// All flights that are there. What is for standard output, and what failed.
    fn once(&self, progress: &Progress) -> Result<(String, Option<String>), String> {
        let to = &self.options.to;
        let found = self.season.flights(to).map_err(|error| error.to_string())?;
        for note in &found.notes {
            say(&format!("warning: {}", one_line(note)));
        }
        if found.flights.is_empty() {
            let left_out = match to.is_dir() {
                true => format!(" beside the folder of the results, {}", to.display()),
                false => String::new(),
            };
            return Err(format!(
                "{}: there is no flight in it{left_out}; name others",
                self.season.name
            ));
        }
        let _held = ResultsFolder::open(to).map_err(|error| error.to_string())?;
        let ended = self.run(&found.flights, progress)?;
        let count = |outcome| {
            ended
                .iter()
                .filter(|ended| ended.outcome == outcome)
                .count()
        };
        let [done, as_before, failed] =
            [Outcome::Done, Outcome::AsBefore, Outcome::Failed].map(count);
        let rows: Vec<SeasonRow> = ended.into_iter().map(|ended| ended.row).collect();
        for note in notes_on_results(to, &rows) {
            say(&format!("warning: {}", one_line(&note)));
        }
        let table = self.write(rows, found.notes)?;
        let page = to.join("season.html");
        say(&format!(
            "{}: {done} done, {as_before} as before, {failed} failed; open {}",
            counted(found.flights.len(), "flight"),
            page.display()
        ));
        let text = match self.format {
            BatchFormat::Table => table,
            // Each was said when it was done.
            BatchFormat::Jsonl => String::new(),
        };
        let what = || {
            let csv = to.join("season.csv");
            let count = found.flights.len();
            format!(
                "{failed} of {count} flights failed; {} says why",
                csv.display()
            )
        };
        Ok((text, (failed > 0).then(what)))
    }

    /// Flights as they arrive, until the user interrupts.
    fn watch(
        &self,
        settle: Duration,
        progress: &Progress,
    ) -> Result<(String, Option<String>), String> {
        let to = &self.options.to;
        let _held = ResultsFolder::open(to).map_err(|error| error.to_string())?;
        say("waiting for flights; Ctrl+C ends it");
        let begun = Instant::now();
        let mut arrivals = Arrivals::new(settle);
        let mut rows: HashMap<String, SeasonRow> = HashMap::new();
        let mut said = String::new();
        loop {
            let flights = match self.season.flights(to) {
                Ok(found) => found.flights,
                Err(error) => {
                    let error = error.to_string();
                    if error != said {
                        say(&format!("warning: {error}"));
                        said = error;
                    }
                    Vec::new()
                }
            };
            let seen: Vec<(&Path, Seen)> = flights
                .iter()
                .map(|flight| (flight.path.as_path(), Seen::of(flight)))
                .collect();
            let (taken, _) = arrivals.look(&seen, begun.elapsed());
            if !taken.is_empty() {
                let taken: Vec<SeasonFlight> = taken
                    .into_iter()
                    .filter_map(|place| flights.get(place).cloned())
                    .collect();
                for ended in self.run(&taken, progress)? {
                    rows.insert(ended.row.results.clone(), ended.row);
                }
                // In the order of the season, not in that of their arrival.
                let known = flights
                    .iter()
                    .filter_map(|flight| rows.get(&flight.results));
                self.write(known.cloned().collect(), Vec::new())?;
            }
            let pause = Instant::now();
            while pause.elapsed() < LOOK {
                progress.advance(0, 1).map_err(|fault| fault.to_string())?;
                std::thread::sleep(Duration::from_millis(50));
            }
        }
    }

    fn run(&self, flights: &[SeasonFlight], progress: &Progress) -> Result<Vec<Ended>, String> {
        let all = flights.len();
        let done = Cell::new(0);
        let away = RefCell::new(TakenAway::default());
        let on_event = |event: Event<'_>| match event {
            Event::Begun(_) | Event::At(..) => {}
            Event::TakenBack(flight) => {
                let name = &flights[flight].blast;
                say(&format!(
                    "{name}: it takes more memory than there is beside others, and is done later, alone"
                ));
            }
            Event::Ended(ended) => {
                done.set(done.get() + 1);
                away.borrow_mut().add(&ended.taken_away);
                say(&format!("[{}/{all}] {}", done.get(), self.line(ended)));
                if self.format == BatchFormat::Jsonl
                    && let Ok(line) = season_json_line(&ended.row, self.unit)
                {
                    let _ = print(&line);
                }
            }
        };
        let ended = run(
            &self.season.asked,
            flights,
            &self.options,
            &on_event,
            progress,
        );
        // Also where it was interrupted: what finished flights took away is gone.
        away.borrow().lines().for_each(|line| say(&line));
        ended.map_err(|fault| fault.to_string())
    }

    /// A flight in a line.
    fn line(&self, ended: &Ended) -> String {
        let word = match ended.outcome {
            Outcome::Done => "done",
            Outcome::AsBefore => "as before",
            Outcome::Failed => "failed",
        };
        let row = &ended.row;
        let mut said: Vec<String> = Vec::new();
        if let Some(error) = &row.error {
            said.push(error.clone());
        } else if let Some(findings) = &row.findings {
            said.push(format!(
                "{} photos: {}",
                findings.photos,
                findings.verdicts.in_words()
            ));
            for percent in [50.0, 80.0] {
                if let Some(size) = size_text(row.size(percent)) {
                    said.push(format!("P{percent} {size} {}", self.unit.symbol()));
                }
            }
        }
        let said = one_line(&format!("{}: {}", row.blast, said.join("; ")));
        format!("{word:<9}  {said}")
    }

    fn write(&self, rows: Vec<SeasonRow>, notes: Vec<String>) -> Result<String, String> {
        let (to, force) = (&self.options.to, self.options.force);
        let written = write_results(to, &self.season.name, self.unit, rows, notes, force);
        written.map_err(|error| error.to_string())
    }
}
