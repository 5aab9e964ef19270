//! `fragscale map`: the flight as a plan, for a report or for map programs.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec2;

use super::length::Length;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::{Answer, OutputUnit};
use crate::exports::{MeasuredOutline, Plan, PlanFormat, PlanGround, PlanRequest, taken_in_words};
use crate::fault::Fault;
use crate::files::Kind;
use crate::flight::{Limits, Review};
use crate::formats::FileError;
use crate::formats::photos::photo_metadata;
use crate::jobs::Progress;
use crate::opening::places;
use crate::survey::{Polygon, SurveyError};

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
    /// A line that was measured, drawn on it: its places in the world, or a file with one a line, as 'profile'
    /// takes and writes them. Can be given several times.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    line: Vec<String>,
    /// The same of a polygon, as 'volume' takes them.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    polygon: Vec<String>,
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
    let (measured, mended) = measured(arguments)?;
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
    let mut plan = Plan::new(&review, request, &pixels, progress).map_err(in_flight)?;
    for outline in &measured {
        on_map(outline, &plan)?;
    }
    plan.measured = measured;
    progress.stage("drawing the map");
    let bytes = format
        .bytes(&plan, arguments.unit.into())
        .map_err(at_output)?;
    outputs.write(output, &bytes, Kind::Result)?;
    let text = format!("{}: {}\n", output.display(), format.words(&plan));
    let mut warnings = mended;
    warnings.extend(opened.all_warnings());
    warnings.extend(plan.warnings);
    Ok(Answer::new(text, warnings))
}

/// The lines and polygons that are asked for, with what was mended of their files.
fn measured(arguments: &MapArguments) -> Result<(Vec<MeasuredOutline>, Vec<String>), String> {
    let (mut outlines, mut warnings) = (Vec::new(), Vec::new());
    for (all, is_polygon) in [(&arguments.line, false), (&arguments.polygon, true)] {
        for text in all {
            let (points, mended) = places(text)?;
            let outline = MeasuredOutline { points, is_polygon };
            check(&outline).map_err(|error| format!("{}: {error}", option(&outline)))?;
            outlines.push(outline);
            warnings.extend(mended);
        }
    }
    Ok((outlines, warnings))
}

/// What could not be measured is not drawn as measured either.
fn check(outline: &MeasuredOutline) -> Result<(), SurveyError> {
    let places = &outline.points;
    if outline.is_polygon {
        return Polygon::new(places).map(|_| ());
    }
    match places.iter().any(|place| *place != places[0]) {
        true => Ok(()),
        false => Err(SurveyError::NoLength),
    }
}

/// A line in other coordinates than the flight's would be on no page, and nobody would know.
fn on_map(outline: &MeasuredOutline, plan: &Plan) -> Result<(), String> {
    let low = outline.points.iter().copied().reduce(DVec2::min);
    let high = outline.points.iter().copied().reduce(DVec2::max);
    let [west_south, east_north] = plan.extent;
    let meets =
        |(low, high): (DVec2, DVec2)| low.cmple(east_north).all() && high.cmpge(west_south).all();
    match low.zip(high).is_some_and(meets) {
        true => Ok(()),
        false => Err(format!(
            "{}: it lies beside the map, which goes from x {:.1}, y {:.1} to x {:.1}, y {:.1}; give places in \
             the flight's coordinates",
            option(outline),
            west_south.x,
            west_south.y,
            east_north.x,
            east_north.y
        )),
    }
}

fn option(outline: &MeasuredOutline) -> &'static str {
    match outline.is_polygon {
        true => "--polygon",
        false => "--line",
    }
}
