//! The process of one flight. It is told what to do by a line on its standard input, says how far it is and what came
//! of it on its standard output, and ends where its standard input does: whoever started it is not there any more.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::steps;
use crate::batch::{
    FlightDone, FlightTold, Record, SaidLine, Step, remove_unfinished_below, remove_what_is_left,
};
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::scales::review_of_scales;
use crate::cli::{fail, interrupt, print};
use crate::exports::{FlightFindings, VerdictCounts};
use crate::files::{self, Recording};
use crate::flight::{Date, Review};
use crate::formats::photos::photo_metadata;
use crate::jobs::{Job, Progress};
use crate::opening::Opened;

/// So often it is said how far the work is.
const SAY: Duration = Duration::from_millis(200);

/// The version that records are of.
const PROGRAM: &str = env!("CARGO_PKG_VERSION");

/// `fragscale batch-flight`.
pub(in crate::cli) fn flight() -> ExitCode {
    if std::env::var_os("FRAGSCALE_BACKTRACE").is_none() {
        std::panic::set_hook(Box::new(|_| {}));
    }
    let mut line = String::new();
    let told = match io::stdin().read_line(&mut line) {
        Ok(_) => serde_json::from_str::<FlightTold>(&line).map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    };
    let told = match told {
        Ok(told) => told,
        Err(error) => {
            return fail(&format!(
                "this command is for fragscale batch alone ({error})"
            ));
        }
    };
    // Without the thread the process still ends when it is done.
    let _ = std::thread::Builder::new()
        .name("who started it".to_owned())
        .spawn(|| {
            let mut byte = [0; 64];
            while matches!(io::stdin().read(&mut byte), Ok(1..)) {}
            files::remove_unfinished();
            std::process::exit(1);
        });
    let job = match Job::start("flight", move |progress| make(&told, progress)) {
        Ok(job) => job,
        Err(fault) => return fail(&fault.to_string()),
    };
    interrupt::stops(job.progress());
    let mut said = Instant::now();
    let mut last = (String::new(), -1.0);
    while !job.is_finished() {
        std::thread::sleep(Duration::from_millis(5));
        if said.elapsed() > SAY {
            said = Instant::now();
            let now = job.progress().snapshot();
            if now != last {
                let (stage, fraction) = now.clone();
                say(&SaidLine::At { stage, fraction });
                last = now;
            }
        }
    }
    match job.finish() {
        Ok(done) => say(&SaidLine::Done(done)),
        Err(fault) => fail(&fault.to_string()),
    }
}

fn say(line: &SaidLine) -> ExitCode {
    match serde_json::to_string(line) {
        Ok(text) => print(&(text + "\n")),
        Err(error) => fail(&error.to_string()),
    }
}

/// Does all of it, or finds that it is done.
fn make(told: &FlightTold, progress: &Progress) -> FlightDone {
    made(told, progress).unwrap_or_else(|error| FlightDone {
        error: Some(error),
        ..FlightDone::default()
    })
}

fn made(told: &FlightTold, progress: &Progress) -> Result<FlightDone, String> {
    let text = |error: files::FileError| error.to_string();
    if let Some(record) = Record::in_folder(&told.to) {
        let holds = record.still_holds(told, PROGRAM, progress);
        if holds.map_err(|fault| fault.to_string())? {
            return Ok(FlightDone {
                as_before: true,
                findings: Some(record.findings),
                ..FlightDone::default()
            });
        }
    }
    for asked in &told.asked.steps {
        steps::check(asked, told)?;
    }
    let recording = Recording::start();
    let before = Record::begin(&told.to).map_err(text)?;
    remove_unfinished_below(&told.to).map_err(text)?;
    progress.stage("opening");
    let flight = FlightArguments::new(
        told.flight.clone(),
        told.surface.clone(),
        told.photos.clone(),
    );
    let opened = flight.open(progress)?;
    files::make_folder(&told.to).map_err(text)?;
    let mut findings = FlightFindings::default();
    let mut error: Option<String> = None;
    let mut review: Option<Review> = None;
    let mut reference = None;
    for asked in &told.asked.steps {
        progress.stage(asked.step.as_str());
        match steps::make(asked, told, &flight, &opened, progress) {
            Ok(made) => {
                for warning in made.warnings {
                    // Steps warn of the same.
                    if !findings.warnings.contains(&warning) {
                        findings.warnings.push(warning);
                    }
                }
                error = error.or(made.failed);
                // Later steps have read the photos, too.
                review = made.review.or(review);
                if asked.step == Step::Delineate {
                    findings.sizes = made.sizes;
                }
                reference = made.reference.or(reference);
            }
            Err(failed) => {
                error = error.or(Some(failed));
                // There is nothing to compare.
                if asked.step == Step::Delineate {
                    break;
                }
            }
        }
    }
    let review = match review {
        Some(review) => review,
        None => review_of_scales(&flight, &opened, progress)?,
    };
    if let Some(reference) = &reference {
        let unit = told.asked.length_unit()?;
        findings.shifts = steps::shifts(&findings.sizes, unit, reference);
    }
    findings.photos = review.count();
    findings.verdicts = VerdictCounts::of(&review);
    findings.taken = day_of(&opened).map(|day| day.to_string());
    let mut taken_away = BTreeMap::new();
    if error.is_none() {
        let written = recording.written();
        taken_away = remove_what_is_left(&told.to, &written, &before).map_err(text)?;
        let photos = opened
            .photo_files
            .iter()
            .filter_map(|file| file.path.clone());
        let mut read = recording.files();
        read.extend(opened.inputs.iter().cloned().chain(photos));
        let found = findings.clone();
        let record = Record::of(told, PROGRAM, &read, &written, found, progress).map_err(text)?;
        record.write(&told.to).map_err(text)?;
    }
    Ok(FlightDone {
        as_before: false,
        findings: Some(findings),
        error,
        taken_away,
    })
}

/// The day of the first photo, by the cameras' clocks.
fn day_of(opened: &Opened) -> Option<Date> {
    let files = opened
        .photo_files
        .iter()
        .filter_map(|file| file.path.as_ref());
    let days = files.filter_map(|path| {
        let time = photo_metadata::read_file(path).ok()?.time?;
        time.get(..10)?.replace(':', "-").parse().ok()
    });
    days.min()
}
