//! `fragscale flown`: a mission against the flight that came of it.

use std::path::PathBuf;

use clap::Args;
use glam::{DVec2, DVec3};

use crate::cli::Answer;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::on_surface::places::place;
use crate::cli::outputs::NamedAnswerArguments;
use crate::exports::{self, DrawingFormat, FlownFigure, FlownReport};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::{FileError, read_mission};
use crate::geodesy::{Crs, CrsKind};
use crate::jobs::Progress;
use crate::plan::{Flown, Taken, ground_at, planned_poses};

#[derive(Debug, Args)]
pub(in crate::cli) struct FlownArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The mission as it was planned: a file of any ground station that 'fragscale mission' reads.
    #[arg(long, value_name = "FILE")]
    mission: PathBuf,
    /// Where the drone took off, in the world and on the surface, if that is not where the mission says.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    take_off: Option<DVec2>,
    /// Draw what was planned and flown into this file, .svg, .pdf or .png; may be given more than once.
    #[arg(long, value_name = "FILE")]
    figure: Vec<PathBuf>,
    #[command(flatten)]
    answer: NamedAnswerArguments,
}

pub(in crate::cli) fn flown(
    arguments: &FlownArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let inputs = arguments.flight.files().chain([&arguments.mission]);
    let mut outputs = arguments.answer.output.outputs(inputs)?;
    let mut formats = Vec::new();
    for path in &arguments.figure {
        let format = DrawingFormat::of(path);
        let format = format.map_err(|fault| FileError::new(path, fault).to_string())?;
        formats.push((path, format));
        outputs = outputs.and(path, Kind::Result)?;
    }
    let mission = read_mission(&arguments.mission).map_err(|error| error.to_string())?;
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    let in_flight = |fault: Fault| FileError::new(&arguments.flight.flight, fault).to_string();
    let in_mission = |fault: Fault| FileError::new(&arguments.mission, fault).to_string();
    let parts = opened.flight.parts();
    let crs = opened.crs.as_deref().ok_or_else(|| {
        let what = "nobody says in which coordinate system its places are";
        in_flight(Fault::new(what, "say it in flight.toml (world.crs)"))
    })?;
    let crs = Crs::understand(crs).map_err(in_flight)?;
    let ground = |place| ground_at(&parts.surface, place);
    let planned = planned_poses(&mission.mission, &crs, arguments.take_off, ground);
    let planned = planned.map_err(in_mission)?;
    if planned.is_empty() {
        let what = "it has no photos to compare with";
        return Err(in_mission(Fault::new(
            what,
            "give the mission of this flight",
        )));
    }
    let taken: Vec<Taken<'_>> = (parts.photos.iter())
        .map(|photo| Taken {
            name: &photo.name,
            pose: &photo.pose,
            camera: opened.flight.camera(photo),
        })
        .collect();
    progress.stage("planned against flown");
    let flown = Flown::compare(&planned, &taken, &parts.surface, progress);
    let flown = flown.map_err(in_flight)?;
    let photos: Vec<&str> = taken.iter().map(|taken| taken.name).collect();
    let report = FlownReport {
        flight: &parts.name,
        unit: parts.unit,
        planned: &planned,
        photos: &photos,
        flown: &flown,
    };
    let text = arguments.answer.deliver(
        &outputs,
        &report,
        exports::flown_table,
        exports::flown_csv,
        exports::flown_json,
    )?;
    let places: Vec<DVec3> = taken.iter().map(|taken| taken.pose.center).collect();
    let figure = FlownFigure {
        report: &report,
        places: &places,
        is_on_map: crs.kind() == CrsKind::Projected,
    };
    for (path, format) in formats {
        let bytes = figure.bytes(format);
        let bytes = bytes.map_err(|fault| FileError::new(path, fault).to_string())?;
        outputs.write(path, &bytes, Kind::Result)?;
    }
    let mut warnings = exports::flown_warnings(&report);
    warnings.extend(mission.notes);
    warnings.extend(opened.all_warnings());
    Ok(Answer::new(text, warnings))
}
