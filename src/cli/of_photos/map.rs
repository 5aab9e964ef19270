//! `fragscale map`: the flight as a plan, for a report or for map programs.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use glam::DVec2;

use super::length::Length;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::on_surface::places::ON_EARTH_REMEDY;
use crate::cli::outputs::{Force, Outputs};
use crate::cli::scales::review_of_scales;
use crate::cli::{Answer, OutputUnit};
use crate::exports::{MeasuredOutline, Plan, PlanFormat, PlanGround, PlanRequest, taken_in_words};
use crate::fault::Fault;
use crate::files::Kind;
use crate::formats::FileError;
use crate::formats::photos::photo_metadata;
use crate::jobs::Progress;
use crate::opening::{Areas, places};
use crate::survey::SurveyError;

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
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pixel: Option<Length>,
    /// What lies under it: the surface's relief, the flight's photos from above, the colours of the cloud's own
    /// points, or nothing.
    #[arg(long, value_enum, default_value = "relief")]
    ground: GroundName,
    /// A line that was measured, drawn on it: its places in the world, or a file with one a line, as 'profile'
    /// takes and writes them. Can be given several times.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    line: Vec<String>,
    /// The same of a polygon, as 'volume' takes them; of a file of a map all that it holds, with holes.
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
    let (mut measured, mut warnings) = lines(arguments)?;
    let polygons = arguments
        .polygon
        .iter()
        .map(|text| Areas::read_to_draw(text));
    let polygons: Vec<Areas> = polygons.collect::<Result<_, String>>()?;
    // Of what is typed there is no file.
    let drawn = arguments.line.iter().chain(&arguments.polygon);
    let drawn: Vec<PathBuf> = drawn.map(PathBuf::from).collect();
    let outputs = Outputs::new(arguments.force, arguments.flight.files().chain(&drawn));
    let mut outputs = outputs.and(output, Kind::Result)?;
    let opened = arguments.flight.open_to_measure(progress)?;
    outputs.read(&opened.read)?;
    for areas in polygons {
        let crs = || arguments.flight.crs_of(None, &opened, ON_EARTH_REMEDY);
        let (rings, mended) = areas.rings_in_world("--polygon", crs)?;
        measured.extend(rings.into_iter().map(|points| MeasuredOutline {
            points,
            is_polygon: true,
        }));
        warnings.extend(mended);
    }
    let in_flight = |fault| arguments.flight.wrong(fault);
    let parts = opened.flight.parts();
    if arguments.pixel.is_some() && !parts.unit_known {
        let what = "the model is in a frame of its own, whose unit nobody states";
        let remedy =
            "leave --pixel away, georeference it, or say the unit in a flight.toml ([world] unit)";
        return Err(in_flight(Fault::new(what, remedy)));
    }
    let review = review_of_scales(&arguments.flight, &opened, progress)?;
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
    warnings.extend(opened.all_warnings());
    warnings.extend(plan.warnings);
    Ok(Answer::new(text, warnings))
}

/// The lines that are asked for, with what was mended of their files.
fn lines(arguments: &MapArguments) -> Result<(Vec<MeasuredOutline>, Vec<String>), String> {
    let (mut lines, mut warnings) = (Vec::new(), Vec::new());
    for text in &arguments.line {
        let (points, mended) = places(text)?;
        // What could not be measured is not drawn as measured either.
        if points.iter().all(|place| *place == points[0]) {
            return Err(format!("--line: {}", SurveyError::NoLength));
        }
        warnings.extend(mended);
        lines.push(MeasuredOutline {
            points,
            is_polygon: false,
        });
    }
    Ok((lines, warnings))
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
