//! `fragscale plan`: where to fly, so that each photo has the wished scale on this surface.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use glam::DVec2;

use crate::camera::Camera;
use crate::cli::Answer;
use crate::cli::flight_arguments::{FlightArguments, MemoryArguments};
use crate::cli::of_photos::length::Length;
use crate::cli::on_surface::places::place;
use crate::cli::outputs::AnswerArguments;
use crate::cli::planning::flying::{FlyingArguments, percent, positive};
use crate::cli::planning::notes_of_files::notes_of_files;
use crate::cli::planning::pixel_scale::PixelScale;
use crate::cli::planning::sheet::SheetArguments;
use crate::cli::planning::survey::SurveyArguments;
use crate::exports::{self, FlightSheet, MissionFormat, PlanReport};
use crate::fault::{Fault, one_line};
use crate::files::Kind;
use crate::formats::{FileError, read_camera};
use crate::geodesy::Crs;
use crate::geometry::extent;
use crate::jobs::Progress;
use crate::opening::{Areas, Opened};
use crate::plan::{
    self, Drone, Pace, Pattern, Plan, Positioning, Purpose, Shadows, Size, Sun, Told, Way, Wish,
};
use crate::units::LengthUnit;

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("size").required(true))]
pub(in crate::cli) struct PlanArguments {
    #[command(flatten)]
    flight: FlightArguments,
    #[command(flatten)]
    memory: MemoryArguments,
    /// The scale that each photo is to have, as '20 px/cm'.
    #[arg(
        long,
        value_name = "N px/UNIT",
        group = "size",
        allow_hyphen_values = true
    )]
    scale: Option<PixelScale>,
    /// How far it may be off anywhere in a photo, as '2 px/cm'; else a tenth of it.
    #[arg(
        long,
        value_name = "N px/UNIT",
        requires = "scale",
        allow_hyphen_values = true
    )]
    within: Option<PixelScale>,
    /// Fly so high instead, as 30m: above the highest of the area, of the slope pattern from the ground.
    #[arg(
        long,
        value_name = "LENGTH",
        group = "size",
        allow_hyphen_values = true
    )]
    height: Option<Length>,
    /// How the photos lie.
    #[arg(long, value_enum, default_value_t)]
    pattern: PhotoPattern,
    /// How much a photo shares with the next, in percent of its width and height; else 0, of the pattern survey 70.
    #[arg(long, value_name = "PERCENT", value_parser = percent, allow_hyphen_values = true)]
    overlap: Option<f64>,
    #[command(flatten)]
    survey: SurveyArguments,
    /// Fill gaps between photos with photos more, which share more with others than --overlap says.
    #[arg(long)]
    fill_gaps: bool,
    /// The camera's axis below the horizon, of the patterns paper and paper-both, degrees; else 83.
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    tilt: Option<f64>,
    /// How far a photo's axis may lie off the normal of the ground, of the patterns slope and both, degrees; else 10: photos
    /// that are square in their strips share less with their neighbours.
    #[arg(long, value_name = "DEGREES", value_parser = positive, allow_hyphen_values = true)]
    off_normal: Option<f64>,
    /// The corners of what is to be photographed, in the world, or a file with one a line; or a polygon of a map, as
    /// GeoJSON or KML; without it the pile that stands out of its floor.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    area: Option<String>,
    /// The unit of the surface's coordinates, where nobody says it: m, ft, ...
    #[arg(long, value_name = "UNIT")]
    unit: Option<LengthUnit>,
    /// The coordinate system of the surface, for a mission, where the flight does not say it, or instead of what it says
    /// (then that is told): EPSG:n, WKT or a PROJ text.
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
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
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
    #[command(flatten)]
    flying: FlyingArguments,
    /// When it is flown, as 2026-06-01T10:00+02:00: where the sun stands then, and what lies in shadow.
    #[arg(long, value_name = "TIME")]
    sun: Option<String>,
    /// Write the mission to this file (needs --take-off, from where its heights count), for the ground station that its ending
    /// names: .kmz (DJI), .plan (QGroundControl), .waypoints (Mission Planner), .csv (Litchi), .kml or .geojson. May be
    /// given several times. More stops than one of them takes become several flights, NAME-1 and so on, each out from
    /// the take-off and home.
    #[arg(long, value_name = "FILE", requires = "take_off")]
    mission: Vec<PathBuf>,
    #[command(flatten)]
    sheet: SheetArguments,
    #[command(flatten)]
    answer: AnswerArguments,
}

impl PlanArguments {
    fn drone(&self) -> Option<Drone> {
        Drone::named(self.drone.as_deref()?)
    }

    /// An error where something was typed that the pattern knows nothing of: who types it believes that it counts.
    fn check_pattern(&self) -> Result<(), String> {
        let PhotoPattern(pattern) = self.pattern;
        if pattern == Pattern::Survey && self.overlap.is_some() && self.survey.has_overlap() {
            return Err(
                "--overlap and --survey-overlap: of the pattern survey they are the same; give one"
                    .to_owned(),
            );
        }
        let survey = self.survey.typed();
        let tilt = self.tilt.map(|_| "--tilt");
        let off_normal = self.off_normal.map(|_| "--off-normal");
        let has_survey = pattern.has(Purpose::Survey);
        let wrong = [
            (survey, has_survey, "survey, both and paper-both"),
            (tilt, pattern.is_level(), "paper and paper-both"),
            (off_normal, pattern.is_square(), "slope and both"),
        ];
        for (option, is_known, of) in wrong {
            if let (Some(option), false) = (option, is_known) {
                let own = pattern.as_str();
                return Err(format!(
                    "{option}: the pattern {own} knows nothing of it; leave it out, or take a pattern that does ({of})"
                ));
            }
        }
        Ok(())
    }
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
        const ALL: [PhotoPattern; Pattern::ALL.len()] = {
            let mut all = [PhotoPattern(Pattern::Slope); Pattern::ALL.len()];
            let mut at = 0;
            while at < all.len() {
                all[at] = PhotoPattern(Pattern::ALL[at]);
                at += 1;
            }
            all
        };
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

pub(in crate::cli) fn plan(
    arguments: &PlanArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    arguments.check_pattern()?;
    // Of areas that are typed there is no file.
    let areas = arguments.area.iter().chain(&arguments.keep_out);
    let areas = areas.map(PathBuf::from).collect::<Vec<_>>();
    let inputs = arguments.flight.files().chain(&arguments.camera);
    let mut outputs = arguments.answer.outputs(inputs.chain(&areas))?;
    for path in &arguments.mission {
        // Known before the work: nothing is written where one of them cannot be.
        MissionFormat::of(path)
            .and_then(|format| format.check_drone(arguments.drone().as_ref()))
            .map_err(|fault| FileError::new(path, fault).to_string())?;
        outputs = outputs.and(path, Kind::Result)?;
    }
    outputs = arguments.sheet.among(outputs)?;
    let area = arguments.area.as_deref().map(Areas::read).transpose()?;
    let keep_out = arguments.keep_out.iter().map(|text| Areas::read(text));
    let keep_out: Vec<_> = keep_out.collect::<Result<_, String>>()?;
    let (flight, memory) = (&arguments.flight, &arguments.memory);
    let (opened, planned) = memory.with_flight(flight, true, progress, |opened| {
        outputs.read(&opened.read)?;
        planned(
            arguments,
            opened,
            (area.clone(), keep_out.clone()),
            progress,
        )
    })?;
    let Planned {
        unit,
        plan,
        ways,
        pace,
        sun,
        mut warnings,
    } = planned;
    let parts = opened.flight.parts();
    let in_flight = |fault: Fault| arguments.flight.wrong(fault);
    let flying = arguments.flying.flying();
    let told = Told {
        name: parts.name.clone(),
        drone: arguments.drone().and_then(|drone| drone.codes),
        unit,
        speed: flying.speed,
        settle: flying.settle,
        by_battery: flying.battery.is_some(),
    };
    // All missions are parted alike, so that page and table are those of every file.
    let targets = (arguments.mission.iter()).map(|path| MissionFormat::of(path));
    let targets = targets.collect::<Result<Vec<_>, Fault>>();
    let targets = targets.map_err(|fault| fault.to_string())?;
    let flights = exports::flights_for(&targets, (&plan, &ways), &pace, &told);
    let (ways, parted) = flights.map_err(in_flight)?;
    let missions = match arguments.mission.is_empty() || ways.is_empty() {
        true => Vec::new(),
        false => {
            let crs = crs_of(arguments, &opened)?;
            plan::missions(&plan, &ways, &crs, &told).map_err(in_flight)?
        }
    };
    let stated_crs = arguments.crs.as_deref().or(opened.crs.as_deref());
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
    warnings.extend(parted);
    if !missions.is_empty() {
        let mut notes = Vec::new();
        for path in &arguments.mission {
            let mut of_file = outputs.write_missions(&missions, path)?;
            // What is said of the plan is said.
            of_file.retain(|note| !warnings.contains(note));
            notes.push((path.as_path(), of_file));
        }
        warnings.extend(notes_of_files(notes));
    }
    let sheet = FlightSheet {
        report: &report,
        drone: arguments.drone().map(|drone| drone.title),
        settle: flying.settle,
        crs: stated_crs,
        warnings: &warnings,
    };
    arguments.sheet.write(&outputs, &sheet)?;
    // What was looked up of the flight's own photos says nothing of those that are planned.
    warnings.extend(opened.warnings.iter().cloned());
    Ok(Answer::new(text, warnings))
}

/// What is planned on the surface of an opened flight.
struct Planned {
    unit: LengthUnit,
    plan: Plan,
    ways: Vec<Way>,
    pace: Pace,
    sun: Option<(Sun, Shadows)>,
    warnings: Vec<String>,
}

fn planned(
    arguments: &PlanArguments,
    opened: &Opened,
    (area, keep_out): (Option<Areas>, Vec<Areas>),
    progress: &Progress,
) -> Result<Planned, String> {
    let in_flight = |fault: Fault| arguments.flight.wrong(fault);
    let parts = opened.flight.parts();
    if let Some(gimbal) = arguments.gimbal.filter(|gimbal| gimbal.x > gimbal.y) {
        return Err(format!(
            "gimbal: {} is above {}; give the lowest pitch first",
            gimbal.x, gimbal.y
        ));
    }
    let crs = || crs_of(arguments, opened);
    let known = parts.unit_known.then_some(parts.unit);
    // Nobody says a unit of a cloud alone but its system.
    let of_crs = || crs().ok().and_then(|crs| crs.unit());
    let Some(unit) = arguments.unit.or(known).or_else(of_crs) else {
        let what = "nobody says in which unit its coordinates are";
        let remedy = "say it: --unit m; or world.unit in flight.toml";
        return Err(in_flight(Fault::new(what, remedy)));
    };
    // Of a system that is none is told where it is needed.
    if let Ok(crs) = crs() {
        plan::is_over_ground(unit, &crs).map_err(in_flight)?;
    }
    let camera = camera(arguments, opened)?;
    let mut warnings: Vec<String> = plan::lying(&parts.surface).into_iter().collect();
    // Of the flight's own system that was looked at when it was opened.
    let bounds = parts.surface.bounds();
    if let Some(said) = &arguments.crs
        && opened.crs.as_ref() != Some(said)
        && let Ok(crs) = crs()
        && let Some(place) = crs.to_geographic(bounds.min.midpoint(bounds.max))
    {
        let doubt = crs.check_lengths(place).map_err(in_flight)?;
        warnings.extend(doubt.map(|doubt| format!("--crs: {doubt}")));
    }
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
            let heights = plan::heights_in_and_about(&parts.surface, &pile);
            let heights = heights.map(|heights| plan::heights_in_words(heights, &unit.to_string()));
            let heights = heights.map_or_else(String::new, |heights| format!(", {heights}"));
            warnings.push(format!(
                "the area is the pile that was found, {:.1} x {:.1} {} around ({:.1}, {:.1}){heights}; --area takes another",
                size.x, size.y, unit, middle.x, middle.y
            ));
            pile
        }
    };
    let mut wish = wish(arguments, unit);
    for areas in keep_out {
        let (areas, said) = areas.to_keep_out_of(crs)?;
        warnings.extend(said);
        wish.keep_out.extend(areas);
    }
    let mut plan = Plan::new(&parts.surface, &camera, area, wish, progress).map_err(in_flight)?;
    if arguments.fill_gaps {
        let filled = plan.with_gaps_filled(&parts.surface, progress);
        plan = filled.map_err(in_flight)?;
    }
    let flying = arguments.flying.flying();
    let pace = Pace::of(&flying, unit.metres());
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
    Ok(Planned {
        unit,
        plan,
        ways,
        pace,
        sun,
        warnings,
    })
}

/// The coordinate system of the places.
fn crs_of(arguments: &PlanArguments, opened: &Opened) -> Result<Crs, String> {
    let remedy = "say it: --crs EPSG:n; or world.crs in flight.toml";
    let crs = (arguments.flight).crs_of(arguments.crs.as_deref(), opened, remedy)?;
    // What the surface's own file states of its heights is kept when it is read.
    match crs.heights_apart().filter(|_| opened.crs.is_none()) {
        None => Ok(crs),
        Some(apart) => {
            let what = format!("{apart}, and all lengths of the surface are taken in one unit");
            let remedy = "bring its heights to the unit of x and y, and name the system without heights; or give a file that states its system";
            Err(arguments.flight.wrong(Fault::new(what, remedy)))
        }
    }
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
            arguments.flight.wrong(fault)
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
    let mut wish = Wish {
        survey: arguments.survey.wish(unit),
        tilt: arguments.tilt.unwrap_or(usual.tilt),
        off_normal: arguments.off_normal.unwrap_or(usual.off_normal),
        gimbal: arguments
            .gimbal
            .map_or(usual.gimbal, |gimbal| gimbal.to_array()),
        clearance: clearance.unwrap_or(usual.clearance),
        errors: arguments.positioning.0.errors(metres),
        take_off: arguments.take_off,
        ..usual
    };
    if let Some(percent) = arguments.overlap {
        wish.set_overlap(percent / 100.0);
    }
    wish
}
