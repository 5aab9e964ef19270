//! `fragscale map`: the flight as a plan, for a report or for map programs.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::length::Length;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::exports::{Plan, PlanFormat, PlanGround, PlanRequest, taken_in_words};
use crate::fault::Fault;
use crate::files::Kind;
use crate::flight::{Limits, Review};
use crate::formats::FileError;
use crate::formats::photos::photo_metadata;
use crate::jobs::Progress;

#[derive(Debug, Args)]
pub(in crate::cli) struct MapArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The file to write: GeoTIFF where it ends in .tif, else a page of A4 with grid, scale bar and legend:
    /// .svg, .pdf or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// The scale bar is in this unit.
    #[arg(long, value_enum, default_value = "m")]
    unit: OutputUnit,
    /// The side of a pixel of the ground, as 5cm or 0.2ft; without it there are about 1300 along the longer
    /// side.
    #[arg(long, value_name = "LENGTH")]
    pixel: Option<Length>,
    /// What lies under it: the surface's relief, the flight's photos from above, the colours of the cloud's own
    /// points, or nothing.
    #[arg(long, value_enum, default_value = "relief")]
    ground: GroundName,
    #[command(flatten)]
    force: Force,
}

/// What `--ground` takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum GroundName {
    Relief,
    Photos,
    Colours,
    Plain,
}

impl From<GroundName> for PlanGround {
    fn from(name: GroundName) -> Self {
        match name {
            GroundName::Relief => Self::Relief,
            GroundName::Photos => Self::Photos,
            GroundName::Colours => Self::Colours,
            GroundName::Plain => Self::Plain,
        }
    }
}

pub(in crate::cli) fn map(arguments: &MapArguments, progress: &Progress) -> Result<Answer, String> {
    let output = &arguments.output;
    let at_output = |fault| FileError::new(output, fault).to_string();
    let format = PlanFormat::of(output).map_err(at_output)?;
    let outputs = Outputs::new(arguments.force, arguments.flight.files());
    let mut outputs = outputs.and(output, Kind::Result)?;
    let opened = arguments.flight.open(progress)?;
    outputs.read(&opened.read)?;
    let path = &arguments.flight.flight;
    let in_flight = |fault| FileError::new(path, fault).to_string();
    let parts = opened.flight.parts();
    if arguments.pixel.is_some() && !parts.unit_known {
        let what = "the model is in a frame of its own, whose unit nobody states";
        let remedy =
            "leave --pixel away, georeference it, or say the unit in a flight.toml ([world] unit)";
        return Err(in_flight(Fault::new(what, remedy)));
    }
    let (flight, looked_up) = (opened.flight.clone(), opened.looked_up.clone());
    let review = Review::of_scales(flight, looked_up, &Limits::default(), progress);
    let mut review = review.map_err(in_flight)?;
    review.take_decisions(&opened.settings.decisions);
    review.look(progress).map_err(in_flight)?;
    review.compute_fields(progress).map_err(in_flight)?;
    let paths = opened
        .photo_files
        .iter()
        .filter_map(|file| file.path.as_deref());
    let times = paths.filter_map(|path| photo_metadata::read_file(path).ok()?.time);
    let times: Vec<String> = times.collect();
    let taken = taken_in_words(times.iter().map(String::as_str));
    let request = PlanRequest {
        pixel: arguments.pixel.map(|pixel| pixel.in_units_of(parts.unit)),
        ground: arguments.ground.into(),
        crs: opened.crs.as_deref(),
        taken: taken.as_deref(),
    };
    let pixels = |photo: usize| {
        let pixels = opened.photo_files.get(photo)?.pixels()?;
        Some(pixels.map_err(|error| error.fault))
    };
    let plan = Plan::new(&review, request, &pixels, progress).map_err(in_flight)?;
    progress.stage("drawing the map");
    let bytes = format
        .bytes(&plan, arguments.unit.into())
        .map_err(at_output)?;
    outputs.write(output, &bytes, Kind::Result)?;
    let text = format!("{}: {}\n", output.display(), format.words(&plan));
    let mut warnings = opened.all_warnings();
    warnings.extend(plan.warnings);
    Ok(Answer::new(text, warnings))
}
