//! The command line (contract, sections 5 and 6): understands the arguments, starts the work as a
//! job, shows its progress, writes what it returns, and turns errors into one line and an exit
//! status.
//!
//! 0: done. 1: the input could not be used. 2: the command line could not be understood. 130: the
//! user interrupted it.
//!
//! With the environment variable FRAGSCALE_BACKTRACE set, a panic prints its place as usual.

mod batch;
mod check;
mod export;
mod flight_arguments;
mod info;
mod interrupt;
mod models;
mod named_photos;
mod of_photos;
mod of_tables;
mod on_surface;
mod outputs;
mod planning;
mod progress_shown;
#[cfg(feature = "render")]
mod render;
mod sample;
mod scales;
mod usage;
mod written_beside;

use std::io::{self, Write};
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};

use models::{georeference, reconstruct};
use of_photos::{delineate, map, rectify, scale_map};
use of_tables::{anova, effort, psd};
use on_surface::{profile, volume};
use planning::{flown, mission, plan};

use crate::batch::FLIGHT_COMMAND;
use crate::fault::one_line;
use crate::jobs::Progress;
use crate::units::LengthUnit;

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
    flight: Vec<std::path::PathBuf>,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the scale of every photo of a flight.
    Scales(scales::ScalesArguments),
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
    Info(info::InfoArguments),
    /// Reconstruct a flight from its photos alone: poses, lenses, a cloud.
    Reconstruct(Box<reconstruct::ReconstructArguments>),
    /// Make a simulated flight whose every answer is known.
    Sample(sample::SampleArguments),
    /// Draw a picture of a flight: the surface, cameras, corner rays and footprints.
    #[cfg(feature = "render")]
    Render(render::RenderArguments),
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
        Err(error) if !error.use_stderr() => {
            // The help of all commands is no answer to one that is not there.
            return match usage::unknown_word() {
                Some(what) => not_understood(&what),
                None => print(&error.to_string()),
            };
        }
        Err(error) => {
            let mut what =
                usage::unknown_command().unwrap_or_else(|| usage::in_one_line(&error.to_string()));
            if let Some(tip) = usage::folder_called_like_a_command() {
                what = format!("{tip}; as a command: {what}");
            }
            return not_understood(&what);
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
        Command::Scales(arguments) => {
            Box::new(move |progress| scales::scales(&arguments, progress))
        }
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
        Command::Info(arguments) => Box::new(move |progress| info::info(&arguments, progress)),
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
    let answer = match progress_shown::run(work) {
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
fn window(flight: Vec<std::path::PathBuf>) -> ExitCode {
    if let Some(what) = usage::unknown_command() {
        return not_understood(&what);
    }
    let ran = crate::app::run(flight);
    // What was being written when the window closed is not finished.
    crate::files::remove_unfinished();
    match ran {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(&message),
    }
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

/// The command line could not be understood.
fn not_understood(what: &str) -> ExitCode {
    say(&format!("error: {what}"));
    ExitCode::from(2)
}

/// A line on standard error. Where even that is closed, the exit status is all that is left.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
