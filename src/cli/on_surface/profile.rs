//! `fragscale profile`: the surface over a line.

use std::path::PathBuf;

use clap::Args;
use glam::DVec2;

use super::places::place;
use crate::cli::Answer;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::AnswerArguments;
use crate::exports::{self, MeasuredUnit, ProfileReport};
use crate::fault::Fault;
use crate::formats::FileError;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::opening::places;
use crate::survey::Profile;

#[derive(Debug, Args)]
pub(in crate::cli) struct ProfileArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// Where the line begins, in the world.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true, requires = "to", required_unless_present = "line")]
    from: Option<DVec2>,
    /// Where it ends.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true, requires = "from")]
    to: Option<DVec2>,
    /// A line with bends instead: its places, or a file with one a line.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true, conflicts_with_all = ["from", "to"])]
    line: Option<String>,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(in crate::cli) fn profile(
    arguments: &ProfileArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    // Of a line that is typed there is no file.
    let line_file = arguments.line.as_ref().map(PathBuf::from);
    let mut outputs = arguments
        .answer
        .outputs(arguments.flight.files().chain(&line_file))?;
    let (line, mut warnings) = match (&arguments.line, arguments.from, arguments.to) {
        (Some(line), ..) => places(line)?,
        (None, from, to) => (from.into_iter().chain(to).collect(), Vec::new()),
    };
    let opened = arguments.flight.open_to_measure(progress)?;
    outputs.read(&opened.read)?;
    let parts = opened.flight.parts();
    progress.stage("meeting the surface");
    let in_flight = |what: String, remedy: &str| {
        FileError::new(&arguments.flight.flight, Fault::new(what, remedy)).to_string()
    };
    let profile = Profile::along(&parts.surface, &line).map_err(|error| error.to_string())?;
    if profile.runs.is_empty() {
        let what = "the line does not meet the surface".to_owned();
        let world = opened.crs.as_deref().map(Crs::understand);
        let remedy = match world {
            Some(Ok(crs)) => format!("give places in the world's coordinates ({})", crs.name()),
            Some(Err(_)) | None => {
                "give places in its coordinates; 'fragscale info' shows its bounds".to_owned()
            }
        };
        return Err(in_flight(what, &remedy));
    }
    let report = ProfileReport {
        flight: &parts.name,
        unit: MeasuredUnit::of(parts),
        profile: &profile,
    };
    let text = arguments.answer.deliver(
        &outputs,
        &report,
        exports::profile_table,
        exports::profile_csv,
        exports::profile_json,
    )?;
    warnings.extend(exports::profile_warnings(&profile));
    warnings.extend(opened.all_warnings());
    Ok(Answer::new(text, warnings))
}
