//! `fragscale plan`: where to fly, so that each photo has the wished scale on this surface.

use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use glam::DVec2;

use crate::camera::Camera;
use crate::cli::Answer;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::of_photos::length::Length;
use crate::cli::on_surface::places::place;
use crate::cli::outputs::NamedAnswerArguments;
use crate::cli::planning::areas::Areas;
use crate::cli::planning::sheet::SheetArguments;
use crate::exports::{self, FlightSheet, MissionFormat, PlanReport};
use crate::fault::{Fault, one_line};
use crate::files::Kind;
use crate::formats::{FileError, read_camera};
use crate::geodesy::Crs;
use crate::geometry::extent;
use crate::jobs::Progress;
use crate::opening::Opened;
use crate::plan::{self, Drone, Pace, Pattern, Plan, Positioning, Size, Told, Way, Wish};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
pub(in crate::cli) struct PlanArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The scale that each photo is to have, as '20 px/cm'.
    #[arg(
        long,
        value_name = "N px/UNIT",
        required_unless_present = "height",
        allow_hyphen_values = true
    )]
    scale: Option<PixelScale>,
    /// How far it may be off anywhere in a photo, as '2 px/cm'; else a tenth of it.
    #[arg(long, value_name = "N px/UNIT", requires = "scale")]
    within: Option<PixelScale>,
    /// Fly so high instead, as 30m: above the highest of the area, of the slope pattern from the ground.
    #[arg(long, value_name = "LENGTH", conflicts_with = "scale")]
    height: Option<Length>,
    /// How the photos lie.
    #[arg(long, value_enum, default_value_t)]
    pattern: PhotoPattern,
    /// How much a photo shares with the next, in percent of its width and height; else 0, of a survey 70.
    #[arg(long, value_name = "PERCENT")]
    overlap: Option<f64>,
    /// Fill gaps between photos with photos more, which share more with others than --overlap says.
    #[arg(long)]
    fill_gaps: bool,
    /// The camera's axis below the horizon, of the paper's pattern, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = plan::USUAL_TILT)]
    tilt: f64,
    /// How far a photo's axis may lie off the normal of the ground, of the slope pattern, degrees: photos that are
    /// square in their strips share less with their neighbours.
    #[arg(long, value_name = "DEGREES", value_parser = positive, default_value_t = plan::USUAL_OFF_NORMAL)]
    off_normal: f64,
    /// The corners of what is to be photographed, in the world, or a file with one a line; or a polygon of a map, as
    /// GeoJSON or KML; without it the pile that stands out of its floor.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    area: Option<String>,
    /// The unit of the surface's coordinates, where nobody says it: m, ft, ...
    #[arg(long, value_name = "UNIT")]
    unit: Option<LengthUnit>,
    /// The coordinate system of the surface, where nobody says it, for a mission: EPSG:n, WKT or a PROJ text.
    #[arg(long, value_name = "CRS", allow_hyphen_values = true)]
    crs: Option<String>,
    /// The drone that is to fly: its camera, its gimbal, and DJI's numbers for its mission.
    #[arg(long, value_name = "NAME", value_parser = drone_values())]
    drone: Option<String>,
    /// The calibration of the camera that is to fly; without it the drone's nominal one, or the first of the flight.
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// The gimbal's lowest and highest pitch in degrees, -90 straight down; else the drone's, or -90 to 0.
    #[arg(long, value_name = "LOW,HIGH", value_parser = place, allow_hyphen_values = true)]
    gimbal: Option<DVec2>,
    /// The drone stays so far from the surface; else 5 m.
    #[arg(long, value_name = "LENGTH")]
    clearance: Option<Length>,
    /// The corners of ground that the drone does not fly over, at any height (misfires, people), or a file with one a
    /// line; or the polygons of a map, as GeoJSON or KML. May be given several times.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    keep_out: Vec<String>,
    /// By what the drone knows its place: how far a photo's scale may be off by that.
    #[arg(long, value_enum, default_value_t)]
    positioning: DronePositioning,
    /// Where the drone takes off and lands, in the world: on the surface, and heights of a mission count from there.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    take_off: Option<DVec2>,
    /// Metres a second between photos.
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true, default_value_t = plan::USUAL_SPEED)]
    speed: f64,
    /// Seconds that the drone waits at a photo, for the gimbal to settle.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true, default_value_t = plan::USUAL_SETTLE)]
    settle: f64,
    /// Minutes in the air that a battery lasts: a longer way becomes several missions, NAME-battery-1 and so on.
    #[arg(long, value_name = "MINUTES", value_parser = positive, allow_hyphen_values = true, requires = "take_off")]
    battery: Option<f64>,
    /// When it is flown, as 2026-06-01T10:00+02:00: where the sun stands then, and what lies in shadow.
    #[arg(long, value_name = "TIME")]
    sun: Option<String>,
    /// Write the mission to this file, for the ground station that its ending names: .kmz (DJI), .plan
    /// (QGroundControl), .waypoints (Mission Planner), .csv (Litchi), .kml or .geojson. May be given several times.
    #[arg(long, value_name = "FILE", requires = "take_off")]
    mission: Vec<PathBuf>,
    #[command(flatten)]
    sheet: SheetArguments,
    #[command(flatten)]
    answer: NamedAnswerArguments,
}

impl PlanArguments {
    fn drone(&self) -> Option<Drone> {
        Drone::named(self.drone.as_deref()?)
    }
}

/// A number above zero.
fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    let number = number.filter(|number| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number above zero".to_owned())
}

/// Metres a second that a drone flies.
fn speed(text: &str) -> Result<f64, String> {
    let number = positive(text)?;
    let flies = number <= plan::MOST_SPEED;
    flies
        .then_some(number)
        .ok_or_else(|| format!("give at most {} m/s", plan::MOST_SPEED))
}

pub(super) fn drone_values() -> PossibleValuesParser {
    let values = Drone::ALL.map(|drone| PossibleValue::new(drone.name).help(drone.title));
    PossibleValuesParser::new(values)
}

/// A pattern as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct PhotoPattern(Pattern);

impl ValueEnum for PhotoPattern {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [PhotoPattern; 3] = [
            PhotoPattern(Pattern::Slope),
            PhotoPattern(Pattern::Paper),
            PhotoPattern(Pattern::Survey),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

/// By what a drone knows its place, as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct DronePositioning(Positioning);

impl ValueEnum for DronePositioning {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [DronePositioning; 2] = [
            DronePositioning(Positioning::Gnss),
            DronePositioning(Positioning::Rtk),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

/// Pixels per a unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
struct PixelScale {
    pixels: f64,
    unit: LengthUnit,
}

impl FromStr for PixelScale {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "give pixels per a unit, as '20 px/cm'".to_owned();
        let (number, unit) = text.split_once('/').ok_or_else(wrong)?;
        let number = number.trim().trim_end_matches("px").trim();
        let pixels: f64 = number.parse().map_err(|_| wrong())?;
        let unit = unit.trim().parse().map_err(|_| wrong())?;
        let is_scale = pixels > 0.0 && pixels.is_finite();
        is_scale.then_some(Self { pixels, unit }).ok_or_else(wrong)
    }
}

impl PixelScale {
    /// Pixels per this unit.
    fn per(self, unit: LengthUnit) -> f64 {
        self.pixels * unit.in_units_of(self.unit)
    }
}

pub(in crate::cli) fn plan(
    arguments: &PlanArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    // Of areas that are typed there is no file.
    let areas = arguments.area.iter().chain(&arguments.keep_out);
    let areas = areas.map(PathBuf::from).collect::<Vec<_>>();
    let inputs = arguments.flight.files().chain(&arguments.camera);
    let mut outputs = arguments.answer.output.outputs(inputs.chain(&areas))?;
    for path in &arguments.mission {
        MissionFormat::of(path).map_err(|fault| FileError::new(path, fault).to_string())?;
        outputs = outputs.and(path, Kind::Result)?;
    }
    outputs = arguments.sheet.among(outputs)?;
    let area = arguments.area.as_deref().map(Areas::read).transpose()?;
    let keep_out = arguments.keep_out.iter().map(|text| Areas::read(text));
    let keep_out: Vec<_> = keep_out.collect::<Result<_, String>>()?;
    let opened = arguments.flight.open_to_measure(progress)?;
    outputs.read(&opened.read)?;
    let in_flight = |fault: Fault| FileError::new(&arguments.flight.flight, fault).to_string();
    let parts = opened.flight.parts();
    if let Some(gimbal) = arguments.gimbal.filter(|gimbal| gimbal.x > gimbal.y) {
        return Err(format!(
            "gimbal: {} is above {}; give the lowest pitch first",
            gimbal.x, gimbal.y
        ));
    }
    let unit = arguments.unit.or(parts.unit_known.then_some(parts.unit));
    let Some(unit) = unit else {
        let what = "nobody says in which unit its coordinates are";
        let remedy = "say it: --unit m; or world.unit in flight.toml";
        return Err(in_flight(Fault::new(what, remedy)));
    };
    let stated_crs = arguments.crs.as_deref().or(opened.crs.as_deref());
    let crs = || {
        let stated = stated_crs.ok_or_else(|| {
            let what = "nobody says in which coordinate system its places are";
            let remedy = "say it: --crs EPSG:n; or world.crs in flight.toml";
            in_flight(Fault::new(what, remedy))
        });
        Crs::understand(stated?).map_err(in_flight)
    };
    let camera = camera(arguments, &opened)?;
    let mut warnings = Vec::new();
    if let (Some(said), Some(own)) = (&arguments.crs, &opened.crs)
        && said != own
    {
        let own = one_line(own);
        warnings.push(format!(
            "--crs {said} is taken; the flight itself says {own}"
        ));
    }
    let area = match area {
        Some(area) => {
            let (area, said) = area.one_in_world("area", crs)?;
            warnings.extend(said);
            area
        }
        None => {
            progress.stage("looking for the pile");
            let pile = plan::pile(&parts.surface, progress).map_err(in_flight)?;
            let [min, max] = extent(pile.corners());
            let (size, middle) = (max - min, (min + max) / 2.0);
            warnings.push(format!(
                "the area is the pile that was found, {:.1} x {:.1} {} around ({:.1}, {:.1}); --area takes another",
                size.x, size.y, unit, middle.x, middle.y
            ));
            pile
        }
    };
    let mut wish = wish(arguments, unit);
    for areas in keep_out {
        let (areas, said) = areas.in_world("keep-out", crs)?;
        warnings.extend(said);
        wish.keep_out.extend(areas);
    }
    let mut plan = Plan::new(&parts.surface, &camera, area, wish, progress).map_err(in_flight)?;
    if arguments.fill_gaps {
        let filled = plan.with_gaps_filled(&parts.surface, progress);
        plan = filled.map_err(in_flight)?;
    }
    let pace = Pace::of(
        arguments.speed,
        arguments.settle,
        arguments.battery,
        unit.metres(),
    );
    let ways = match arguments.take_off {
        None => Vec::new(),
        Some(place) => {
            progress.stage("the way through the photos");
            Way::through(&plan, &parts.surface, place, &pace).map_err(in_flight)?
        }
    };
    let sun = match &arguments.sun {
        None => None,
        Some(when) => {
            progress.stage("where the sun stands");
            let sun = plan.sun_at(when, &crs()?);
            Some(sun.map_err(|fault| format!("sun: {fault}"))?)
        }
    };
    let report = PlanReport {
        flight: &parts.name,
        world: unit,
        scales: arguments.scale.map_or(unit, |scale| scale.unit),
        plan: &plan,
        ways: &ways,
        pace,
        is_nominal: arguments.camera.is_none() && arguments.drone.is_some(),
        sun: sun.as_ref().map(|(sun, shadows)| (sun, shadows)),
    };
    let text = arguments.answer.deliver(
        &outputs,
        &report,
        exports::plan_table,
        exports::plan_csv,
        exports::plan_json,
    )?;
    warnings.extend(exports::plan_warnings(&report));
    if !arguments.mission.is_empty() && !ways.is_empty() {
        let crs = crs()?;
        let told = Told {
            name: parts.name.clone(),
            drone: arguments.drone().and_then(|drone| drone.codes),
            unit,
            speed: arguments.speed,
            settle: arguments.settle,
        };
        let missions = plan::missions(&plan, &ways, &crs, &told).map_err(in_flight)?;
        for path in &arguments.mission {
            for note in outputs.write_missions(&missions, path)? {
                if !warnings.contains(&note) {
                    warnings.push(note);
                }
            }
        }
    }
    let sheet = FlightSheet {
        report: &report,
        drone: arguments.drone().map(|drone| drone.title),
        settle: arguments.settle,
        crs: stated_crs,
        warnings: &warnings,
    };
    arguments.sheet.write(&outputs, &sheet)?;
    warnings.extend(opened.all_warnings());
    Ok(Answer::new(text, warnings))
}

/// The camera that is to fly, without what its lens bends: plans are for undistorted images.
fn camera(arguments: &PlanArguments, opened: &Opened) -> Result<Camera, String> {
    if let Some(path) = &arguments.camera {
        return read_camera(path).map_err(|error| error.to_string());
    }
    if let Some(drone) = arguments.drone() {
        return Ok(drone.camera());
    }
    opened
        .flight
        .parts()
        .cameras
        .first()
        .cloned()
        .ok_or_else(|| {
            let fault = Fault::new(
                "it has no camera",
                "say which is to fly: --drone NAME or --camera FILE",
            );
            FileError::new(&arguments.flight.flight, fault).to_string()
        })
}

fn wish(arguments: &PlanArguments, unit: LengthUnit) -> Wish {
    let size = match (arguments.scale, arguments.height) {
        (Some(scale), _) => match arguments.within {
            None => Size::scale(scale.per(unit)),
            Some(within) => Size::Scale {
                pixels: scale.per(unit),
                within: Some(within.per(unit)),
            },
        },
        // One of the two is there.
        (None, height) => {
            Size::Distance(height.map_or(f64::NAN, |height| height.in_units_of(unit)))
        }
    };
    let metres = unit.metres();
    let usual = Wish::usual(arguments.pattern.0, size, arguments.drone(), metres);
    let clearance = arguments.clearance.map(|length| length.in_units_of(unit));
    Wish {
        overlap: arguments
            .overlap
            .map_or(usual.overlap, |percent| percent / 100.0),
        tilt: arguments.tilt,
        off_normal: arguments.off_normal,
        gimbal: arguments
            .gimbal
            .map_or(usual.gimbal, |gimbal| gimbal.to_array()),
        clearance: clearance.unwrap_or(usual.clearance),
        errors: arguments.positioning.0.errors(metres),
        take_off: arguments.take_off,
        ..usual
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_a_unit() {
        let scale = |text: &str| {
            text.parse::<PixelScale>()
                .map(|scale| scale.per(LengthUnit::Metre))
        };
        assert_eq!(scale("20 px/cm"), Ok(2000.0));
        assert_eq!(scale("0.5px/mm"), Ok(500.0));
        assert_eq!(scale("30/m"), Ok(30.0));
        for wrong in ["20", "px/cm", "-1 px/cm", "20 px/km", "inf/m", ""] {
            assert!(scale(wrong).is_err(), "{wrong}");
        }
    }
}
