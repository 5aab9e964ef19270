//! The command line (contract, sections 5 and 6): understands the arguments, starts the work as a
//! job, shows its progress, writes what it returns, and turns errors into one line and an exit
//! status.
//!
//! 0: done. 1: the input could not be used. 2: the command line could not be understood. 130: the
//! user interrupted it.
//!
//! With the environment variable FRAGSCALE_BACKTRACE set, a panic prints its place as usual.

mod anova;
mod batch;
mod check;
mod distribution_arguments;
mod effort;
mod export;
mod flight_arguments;
mod interrupt;
mod models;
mod of_photos;
mod on_surface;
mod outputs;
mod planning;
mod psd;
mod psd_compare;
mod psd_fit;
#[cfg(feature = "render")]
mod render;
mod sample;
mod written_beside;

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;

use flight_arguments::{FlightArguments, MemoryArguments};
use models::{georeference, reconstruct};
use of_photos::{delineate, map, rectify, scale_map};
use on_surface::{profile, volume};
use outputs::{AnswerArguments, Outputs};
use planning::{flown, mission, plan};

use crate::batch::FLIGHT_COMMAND;
use crate::exports;
use crate::fault::one_line;
use crate::flight::{Limits, Review};
use crate::formats::FileError;
use crate::jobs::{Job, Progress};
use crate::opening::{self, Opened};
use crate::units::LengthUnit;

/// Work that is over sooner shows no progress bar.
const QUICK: Duration = Duration::from_millis(500);
/// Where nobody looks at a bar, so often a line says how far it is.
const LOGGED: Duration = Duration::from_secs(60);

/// Image scales for blast fragmentation photos, from a drone flight's point cloud.
#[derive(Debug, Parser)]
#[command(
    name = "fragscale",
    version,
    about,
    args_conflicts_with_subcommands = true
)]
struct Arguments {
    /// Open this flight in a window, perhaps with its surface and the folder of its photos; without
    /// it, the window's start page.
    #[cfg(feature = "app")]
    flight: Vec<PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the scale of every photo of a flight.
    Scales(ScalesArguments),
    /// Export photos with their scales for Split-Desktop.
    Export(export::ExportArguments),
    /// Write the scale of every pixel of a photo: numbers (TIFF) or colours with a legend (PNG).
    ScaleMap(scale_map::ScaleMapArguments),
    /// Show a photo squarely, with one scale everywhere: onto a plane or from straight above.
    Rectify(rectify::RectifyArguments),
    /// Outline the fragments of photos and measure each where it lies: label images, a table, the size
    /// distribution.
    Delineate(delineate::DelineateArguments),
    /// Draw the flight as a plan: hillshade, footprints, grid, scale bar; GeoTIFF, SVG, PDF or PNG.
    Map(map::MapArguments),
    /// Look for what makes a flight's scales wrong: places, cameras, colours that do not match.
    Check(check::CheckArguments),
    /// Bring a reconstruction in a frame of its own to the world by known positions or distances.
    Georeference(georeference::GeoreferenceArguments),
    /// Analyse the variance of values in groups: does a measurement repeat?
    Anova(anova::AnovaArguments),
    /// Sum up the time that each step of each method or trial took.
    Effort(effort::EffortArguments),
    /// Fit and compare size distributions.
    #[command(subcommand)]
    Psd(psd::PsdCommand),
    /// Measure the surface over a line: heights, crest, toe and angle of repose.
    Profile(profile::ProfileArguments),
    /// Measure area and volume inside a polygon, over a level, its rim or another surface.
    Volume(volume::VolumeArguments),
    /// Plan a flight over the surface, so that each photo has the wished scale; write its mission.
    Plan(Box<plan::PlanArguments>),
    /// Say what a drone's mission does, or write it for another ground station.
    Mission(mission::MissionArguments),
    /// Compare a mission with the flight that came of it: how far off each photo is, which are missing.
    Flown(flown::FlownArguments),
    /// Do scales, check, export, scale maps and delineation with many flights: a season of blasts.
    Batch(batch::BatchArguments),
    /// One flight of a batch, in a process of its own; what to do comes on standard input.
    #[command(hide = true, name = FLIGHT_COMMAND)]
    BatchFlight,
    /// Say what a file or folder holds.
    Info(InfoArguments),
    /// Reconstruct a flight from its photos alone: poses, lenses, a cloud.
    Reconstruct(Box<reconstruct::ReconstructArguments>),
    /// Make a simulated flight whose every answer is known.
    Sample(sample::SampleArguments),
    /// Draw a picture of a flight: the surface, cameras, corner rays and footprints.
    #[cfg(feature = "render")]
    Render(render::RenderArguments),
}

#[derive(Debug, Args)]
struct ScalesArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    memory: MemoryArguments,
    /// Scales are in pixels per this unit.
    #[arg(long, value_enum, default_value = "cm")]
    unit: OutputUnit,
    #[command(flatten)]
    answer: AnswerArguments,
}

#[derive(Debug, Args)]
struct InfoArguments {
    /// Any file or folder that fragscale reads.
    file: PathBuf,
    /// How to write it.
    #[arg(long, value_enum, default_value = "text")]
    format: InfoFormat,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum OutputUnit {
    Mm,
    Cm,
    M,
    In,
    Ft,
}

impl From<OutputUnit> for LengthUnit {
    fn from(unit: OutputUnit) -> Self {
        match unit {
            OutputUnit::Mm => Self::Millimetre,
            OutputUnit::Cm => Self::Centimetre,
            OutputUnit::M => Self::Metre,
            OutputUnit::In => Self::Inch,
            OutputUnit::Ft => Self::Foot,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ScalesFormat {
    Table,
    Csv,
    Json,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum InfoFormat {
    Text,
    Json,
}

/// What a command has to say when it is done.
struct Answer {
    /// To standard output; empty where it went into a file.
    text: String,
    /// To standard error, one line each.
    warnings: Vec<String>,
    /// Why the command fails although it did what it could: one line.
    failed: Option<String>,
}

impl Answer {
    /// Of a command that did what it was asked.
    fn new(text: String, warnings: Vec<String>) -> Self {
        Self {
            text,
            warnings,
            failed: None,
        }
    }
}

/// What a command does, on the job's thread.
type Work = Box<dyn FnOnce(&Progress) -> Result<Answer, String> + Send>;

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if !error.use_stderr() => return print(&error.to_string()),
        Err(error) => {
            let mut what =
                unknown_command().unwrap_or_else(|| usage_in_one_line(&error.to_string()));
            if let Some(tip) = folder_called_like_a_command() {
                what = format!("{tip}; as a command: {what}");
            }
            say(&format!("error: {what}"));
            return ExitCode::from(2);
        }
    };
    match &arguments.command {
        Some(Command::Reconstruct(arguments)) => {
            interrupt::listen(Some(arguments.kept()), arguments.takes_long_to_end());
        }
        Some(Command::Delineate(arguments)) => {
            interrupt::listen(Some(arguments.kept()), false);
        }
        Some(Command::Batch(_)) => interrupt::listen(Some(batch::kept()), false),
        _ => interrupt::listen(None, false),
    }
    let Some(command) = arguments.command else {
        #[cfg(feature = "app")]
        return window(arguments.flight);
        #[cfg(not(feature = "app"))]
        {
            say(
                "error: this fragscale was built without the window, so it needs a command; see 'fragscale --help'",
            );
            return ExitCode::from(2);
        }
    };
    // A panic is a defect that the job reports in a sentence; its details are for developers.
    if std::env::var_os("FRAGSCALE_BACKTRACE").is_none() {
        std::panic::set_hook(Box::new(|_| {}));
    }
    let work: Work = match command {
        // These have standard output for themselves, and exit statuses of their own.
        Command::Batch(arguments) => return batch::batch(arguments),
        Command::BatchFlight => return batch::flight(),
        Command::Scales(arguments) => Box::new(move |progress| scales(&arguments, progress)),
        Command::Export(arguments) => {
            Box::new(move |progress| export::export(&arguments, progress))
        }
        Command::ScaleMap(arguments) => {
            Box::new(move |progress| scale_map::scale_map(&arguments, progress))
        }
        Command::Delineate(arguments) => {
            Box::new(move |progress| delineate::delineate(&arguments, progress))
        }
        Command::Rectify(arguments) => {
            Box::new(move |progress| rectify::rectify(&arguments, progress))
        }
        Command::Map(arguments) => Box::new(move |progress| map::map(&arguments, progress)),
        Command::Check(arguments) => Box::new(move |progress| check::check(&arguments, progress)),
        Command::Georeference(arguments) => {
            Box::new(move |progress| georeference::georeference(&arguments, progress))
        }
        Command::Anova(arguments) => Box::new(move |_| anova::anova(&arguments)),
        Command::Effort(arguments) => Box::new(move |_| effort::effort(&arguments)),
        Command::Mission(arguments) => Box::new(move |_| mission::mission(&arguments)),
        Command::Psd(command) => Box::new(move |progress| psd::psd(&command, progress)),
        Command::Profile(arguments) => {
            Box::new(move |progress| profile::profile(&arguments, progress))
        }
        Command::Volume(arguments) => {
            Box::new(move |progress| volume::volume(&arguments, progress))
        }
        Command::Plan(arguments) => Box::new(move |progress| plan::plan(&arguments, progress)),
        Command::Flown(arguments) => Box::new(move |progress| flown::flown(&arguments, progress)),
        Command::Info(arguments) => Box::new(move |progress| info(&arguments, progress)),
        Command::Reconstruct(arguments) => {
            Box::new(move |progress| reconstruct::run(&arguments, progress))
        }
        Command::Sample(arguments) => {
            Box::new(move |progress| sample::sample(&arguments, progress))
        }
        #[cfg(feature = "render")]
        Command::Render(arguments) => {
            Box::new(move |progress| render::render(&arguments, progress))
        }
    };
    let answer = match run_with_progress(work) {
        Ok(answer) => answer,
        Err(message) => return interrupt::interrupted().unwrap_or_else(|| fail(&message)),
    };
    for warning in answer.warnings {
        say(&format!("warning: {}", one_line(&warning)));
    }
    let printed = print(&answer.text);
    match answer.failed {
        Some(message) => fail(&message),
        None => printed,
    }
}

/// Opens the window, with a flight where one is named.
#[cfg(feature = "app")]
fn window(flight: Vec<PathBuf>) -> ExitCode {
    if let Some(what) = unknown_command() {
        say(&format!("error: {what}"));
        return ExitCode::from(2);
    }
    let ran = crate::app::run(flight);
    // What was being written when the window closed is not finished.
    crate::files::remove_unfinished();
    match ran {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(&message),
    }
}

fn scales(arguments: &ScalesArguments, progress: &Progress) -> Result<Answer, String> {
    let mut outputs = arguments.answer.outputs(arguments.flight.files())?;
    let (flight, memory) = (&arguments.flight, &arguments.memory);
    let (opened, (text, notes)) = memory.with_flight(flight, false, progress, |opened| {
        outputs.read(&opened.read)?;
        let review = review_of_scales(flight, opened, progress)?;
        scales_text(arguments, opened, &review)
    })?;
    answer_of_scales(&outputs, text, &opened, notes)
}

/// The review of a flight that is open, for its scales: no photo's colours are read.
fn review_of_scales(
    flight: &FlightArguments,
    opened: &Opened,
    progress: &Progress,
) -> Result<Review, String> {
    let in_flight = |fault| FileError::new(&flight.flight, fault).to_string();
    let (flight, looked_up) = (opened.flight.clone(), opened.looked_up.clone());
    let review = Review::of_scales(flight, looked_up, &Limits::default(), progress);
    let mut review = review.map_err(in_flight)?;
    review.take_decisions(&opened.settings.decisions);
    review.look(progress).map_err(in_flight)?;
    review.compute_fields(progress).map_err(in_flight)?;
    Ok(review)
}

/// The scales of a flight that was reviewed.
fn deliver_scales(
    arguments: &ScalesArguments,
    mut outputs: Outputs<'_>,
    opened: &Opened,
    review: &Review,
) -> Result<Answer, String> {
    outputs.read(&opened.read)?;
    let (text, notes) = scales_text(arguments, opened, review)?;
    answer_of_scales(&outputs, text, opened, notes)
}

/// The scales of a reviewed flight as they are written, and what fell back or failed.
fn scales_text(
    arguments: &ScalesArguments,
    opened: &Opened,
    review: &Review,
) -> Result<(String, Vec<String>), String> {
    let in_flight = |fault| FileError::new(&arguments.flight.flight, fault).to_string();
    let report = exports::ScaleReport::new(review, arguments.unit.into())
        .with_scale_objects(&opened.settings.scale_objects)
        .map_err(in_flight)?;
    let (csv, json) = (exports::scales_csv, exports::scales_json);
    let text = arguments
        .answer
        .text(&report, exports::scales_table, csv, json)?;
    Ok((text, notes_of(&report).collect()))
}

/// Delivers the text, with all warnings.
fn answer_of_scales(
    outputs: &Outputs<'_>,
    text: String,
    opened: &Opened,
    notes: Vec<String>,
) -> Result<Answer, String> {
    let text = outputs.deliver(text)?;
    let mut warnings = opened.all_warnings();
    warnings.extend(notes);
    Ok(Answer::new(text, warnings))
}

/// What fell back or failed.
fn notes_of(report: &exports::ScaleReport<'_>) -> impl Iterator<Item = String> {
    report.noted().into_iter().map(|noted| {
        let verdict = if noted.has_scale { "" } else { "no scale: " };
        format!("{}: {verdict}{}", noted.whose, noted.notes)
    })
}

fn info(arguments: &InfoArguments, progress: &Progress) -> Result<Answer, String> {
    let value = opening::info(&arguments.file, progress).map_err(|error| error.to_string())?;
    let text = match arguments.format {
        InfoFormat::Json => format!("{value}\n"),
        InfoFormat::Text => info_text(&value),
    };
    Ok(Answer::new(text, Vec::new()))
}

/// The top level of an `info` value, a line each; of lists how long they are.
fn info_text(value: &Value) -> String {
    let mut text = String::new();
    for (key, value) in value.as_object().into_iter().flatten() {
        let shown = match value {
            Value::Null => "not stated".to_owned(),
            Value::String(text) => text.clone(),
            Value::Array(list) if key == "warnings" => {
                for warning in list {
                    text += &format!("warning: {}\n", warning.as_str().unwrap_or_default());
                }
                continue;
            }
            Value::Array(list) if key == "topics" => {
                for topic in list {
                    let of = |key: &str| topic[key].as_str().unwrap_or_default();
                    let poses = match topic["gives_poses"].as_bool() {
                        Some(true) => ", gives poses",
                        _ => "",
                    };
                    let (name, kind, count) = (of("name"), of("type"), &topic["messages"]);
                    text += &format!("topic: {name} ({kind}), {count} messages{poses}\n");
                }
                continue;
            }
            Value::Array(list) => list.len().to_string(),
            other => in_words(other),
        };
        text += &format!("{}: {shown}\n", key.replace('_', " "));
    }
    text
}

/// A value with what is in it, in a line.
fn in_words(value: &Value) -> String {
    match value {
        Value::Null => "not stated".to_owned(),
        Value::String(text) => text.clone(),
        Value::Object(parts) => {
            let parts = parts.iter().map(|(name, part)| match part {
                Value::Object(_) => format!("{name} ({})", in_words(part)),
                part => format!("{name} {}", in_words(part)),
            });
            parts.collect::<Vec<_>>().join(", ")
        }
        other => other.to_string(),
    }
}

/// Runs the work on a thread of its own, with a progress bar on a terminal where it takes long, and a line now and then in a
/// file.
fn run_with_progress<T: Send + 'static>(
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

/// Writes to standard output. A reader that has gone away (`| head`) has what it wanted.
fn print(text: &str) -> ExitCode {
    let mut output = io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => fail(&format!(
            "standard output: it cannot be written ({error}); choose another place"
        )),
    }
}

fn fail(message: &str) -> ExitCode {
    say(&format!("error: {message}"));
    ExitCode::from(1)
}

/// A line on standard error. Where even that is closed, the exit status is all that is left.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Where the first word is neither a command nor a file that is there, what it could have meant:
/// clap takes it for a flight and stumbles over the second word.
fn unknown_command() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let text = word.to_string_lossy();
    let arguments = Arguments::command();
    let names: Vec<&str> = arguments.get_subcommands().map(|c| c.get_name()).collect();
    if text.starts_with('-') || names.contains(&text.as_ref()) || Path::new(&word).exists() {
        return None;
    }
    let likeness = |name: &&str| strsim::jaro_winkler(&text, name);
    let nearest = names
        .into_iter()
        .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
        .filter(|name| likeness(name) > 0.8);
    let tip = nearest.map_or_else(String::new, |name| format!(" (perhaps '{name}')"));
    Some(one_line(&format!(
        "'{text}' is neither a command{tip} nor a file or folder; see 'fragscale --help'"
    )))
}

/// Where the first word is a command and a file or folder of that name is there: how that is opened.
fn folder_called_like_a_command() -> Option<String> {
    let name = named_command()?;
    let kind = match std::fs::metadata(&name).ok()?.is_dir() {
        true => "folder",
        false => "file",
    };
    let is_alone = std::env::args_os().len() == 2;
    let there = Path::new(".").join(&name);
    (is_alone && cfg!(feature = "app")).then(|| {
        format!(
            "'{name}' is a command; to open the {kind} of that name type 'fragscale {}'",
            there.display()
        )
    })
}

/// What Rust says of a text that is no number, and what we do.
const NO_NUMBERS: [(&str, &str); 6] = [
    ("invalid float literal", "not a number"),
    ("cannot parse float from empty string", "no number"),
    (
        "invalid digit found in string",
        "not a whole number from 0 on",
    ),
    ("cannot parse integer from empty string", "no number"),
    ("number too large to fit in target type", "too large"),
    ("number too small to fit in target type", "too small"),
];

/// clap explains over several lines; here the first, with its tip, and where to read more.
fn usage_in_one_line(text: &str) -> String {
    let lines: Vec<&str> = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:"))
        // Said once, behind it.
        .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
        .collect();
    let mut what = lines.join(", ").replace(":, ", ": ");
    for (of_rust, plain) in NO_NUMBERS {
        if let Some(before) = what.strip_suffix(of_rust) {
            what = format!("{before}{plain}");
        }
    }
    let what = what.strip_prefix("error: ").unwrap_or(&what).to_owned();
    let name: OsString = std::env::args_os().next().unwrap_or_default();
    let name = Path::new(&name).file_name().map_or_else(
        || "fragscale".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    );
    let command = named_command().map_or_else(String::new, |command| format!(" {command}"));
    format!("{what}; see '{name}{command} --help'")
}

/// The command that the first word is.
fn named_command() -> Option<String> {
    let word = std::env::args_os().nth(1)?;
    let command = Arguments::command();
    let found = command.get_subcommands().find(|c| word == c.get_name());
    found.map(|command| command.get_name().to_owned())
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

    #[test]
    fn usage_errors_are_one_line() {
        let error = Arguments::try_parse_from(["fragscale", "scales", "a", "--unit", "km"]);
        let line = usage_in_one_line(&error.unwrap_err().to_string());
        assert!(!line.contains('\n'));
        assert!(line.contains("'km'"), "{line}");
        assert_eq!(line.matches("--help").count(), 1, "{line}");
        let refused = |option: [&str; 2]| {
            let words = ["fragscale", "sample", "a"].into_iter().chain(option);
            usage_in_one_line(&Arguments::try_parse_from(words).unwrap_err().to_string())
        };
        let line = refused(["--seed", "abc"]);
        assert!(
            line.starts_with(
                "invalid value 'abc' for '--seed <SEED>': not a whole number from 0 on; see"
            ),
            "{line}"
        );
        let line = refused(["--seed", "99999999999999999999"]);
        assert!(line.contains(": too large; see"), "{line}");
    }

    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
