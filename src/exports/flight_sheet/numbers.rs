//! The numbers of a sheet: what is to be known before take-off.

use glam::DVec3;

use super::FlightSheet;
use crate::flight_plan::{
    PlanReport, beyond_in_words, kinds_in_words, overlap_in_words, sun_in_words,
};
use crate::geodesy::Crs;
use crate::measured::percent;
use crate::numbers::{four_digits, significant_digits};
use fragscale_core::plan::{Size, Way, lost_signal, return_height, set_height};

/// Names and what is said of them, in the order of the page.
#[derive(Default)]
struct Said(Vec<(String, String)>);

impl Said {
    fn say(&mut self, name: impl Into<String>, words: impl Into<String>) {
        self.0.push((name.into(), words.into()));
    }
}

/// All of them.
pub(super) fn numbers(sheet: &FlightSheet<'_>) -> Vec<(String, String)> {
    let report = sheet.report;
    let (plan, unit) = (report.plan, report.world);
    let number = |number: f64| significant_digits(number, 3);
    let mut said = Said::default();
    let kinds = kinds_in_words(plan).map(|kinds| format!(": {kinds}"));
    said.say(
        "Photos",
        format!("{}{}", plan.photos.len(), kinds.unwrap_or_default()),
    );
    if !plan.refused.is_empty() {
        said.say("Not possible", format!("{} photos", plan.refused.len()));
    }
    said.say("Pattern", plan.wish.pattern.as_str());
    said.say("Wished", wished(report));
    for purpose in plan.wish.pattern.purposes() {
        let overlap = plan.wish.overlap_of(*purpose);
        let name = match plan.wish.pattern.main() == *purpose {
            true => "Overlap",
            false => "Survey's overlap",
        };
        if overlap > 0.0 {
            said.say(name, percent(overlap));
        }
    }
    let camera = &plan.camera;
    let pixels = format!("{} x {} px", camera.width, camera.height);
    let camera = match sheet.drone {
        Some(drone) => format!("{drone}, {pixels}"),
        None => pixels,
    };
    said.say("Camera", camera);
    let pitches = plan.photos.iter().map(|photo| -photo.tilt);
    said.say(
        "Gimbal pitch",
        range(pitches, |pitch| format!("{pitch:.0}°")),
    );
    let (area, photographed) = (number(plan.area.area()), percent(plan.cover.covered));
    said.say(
        "Area",
        format!("{area} {unit}², {photographed} photographed"),
    );
    if plan.cover.widest_gap > 0.0 {
        let gap = number(plan.cover.widest_gap);
        said.say("Widest gap", format!("{gap} {unit}"));
    }
    if let Some(share) = plan.cover.surveyed {
        said.say(
            "Survey",
            format!("{} of the area in 3 photos or more", percent(share)),
        );
    }
    if let Some(words) = overlap_in_words(plan) {
        said.say("Shared by the survey", words);
    }
    if let Some(words) = sun_in_words(report) {
        said.say("Sun", words);
    }
    let clearance = plain(plan.wish.clearance);
    said.say(
        "Clearance",
        match beyond_in_words(report) {
            None => format!("{clearance} {unit} from the ground and walls"),
            Some(beyond) => format!(
                "{clearance} {unit} from the ground and walls as far as the surface reaches; {beyond}, where nobody knows what stands"
            ),
        },
    );
    let keep_out = plan.wish.keep_out.len();
    if keep_out > 0 {
        said.say("Keep out", format!("{keep_out} on the map, at any height"));
    }
    let speed = plain(report.pace.speed * unit.metres());
    let settle = plain(sheet.settle);
    said.say("Speed", format!("{speed} m/s, waits {settle} s at a photo"));
    if let Some(steepest) = report.pace.steepest {
        let words = format!(
            "slanted legs climb and fall by at most {}°",
            plain(steepest)
        );
        said.say("Steepest", words);
    }
    if let Some(first) = report.ways.first() {
        say_ways(report, first, &mut said);
        say_place(sheet, first.take_off, &mut said);
    }
    said.0
}

/// What the ways say, where the take-off is known.
fn say_ways(report: &PlanReport<'_>, first: &Way, said: &mut Said) {
    let unit = report.world;
    let minutes = |seconds: f64| significant_digits(seconds / 60.0, 2);
    let above = |z: f64| z - first.take_off.z;
    let length = significant_digits(report.way_length(), 3);
    let in_air = minutes(report.seconds());
    said.say(
        "Way",
        format!("{length} {unit}, about {in_air} min in the air"),
    );
    let photos = report.plan.photos.iter();
    let heights = photos.map(|photo| above(photo.pose.center.z));
    let heights = range(heights, |height| format!("{height:.1}"));
    said.say("Photos from", format!("{heights} {unit} above take-off"));
    let safe = report.ways.iter().map(|way| above(way.safe_height));
    let safe = safe.fold(f64::MIN, f64::max);
    said.say("Safe height", format!("{safe:.1} {unit} above take-off"));
    if let Some(height) = return_height_in_words(report) {
        said.say("Return home", format!("at least {height} above take-off"));
    }
    let lost = lost_signal(report.plan, report.ways).in_words();
    said.say("Radio lost", format!("the drone {lost}, by its mission"));
    if report.ways.len() == 1 {
        return;
    }
    for (way, number) in report.ways.iter().zip(1..) {
        let mut photos = way.points.iter().filter_map(|point| {
            let photo = report.plan.photos.get(point.photo?)?;
            Some(photo.name.as_str())
        });
        let first = photos.next().unwrap_or_default();
        let last = photos.next_back().unwrap_or(first);
        let length = significant_digits(way.length, 3);
        let in_air = minutes(way.seconds(&report.pace));
        let words = format!("{first} to {last}, {length} {unit}, about {in_air} min");
        said.say(format!("{} {number}", report.way_name()), words);
    }
}

/// The height above the take-off to return home at, for people: rounded up to a whole metre, for it is set at the ground station.
pub(super) fn return_height_in_words(report: &PlanReport<'_>) -> Option<String> {
    let unit = report.world;
    let take_off = report.ways.first()?.take_off;
    let height = return_height(report.plan, report.ways)? - take_off.z;
    let (rounded, metres) = (set_height(height), set_height(height * unit.metres()));
    Some(match unit.metres() == 1.0 {
        true => format!("{rounded} m"),
        false => format!("{rounded} {unit} ({metres} m)"),
    })
}

/// A number that somebody gave, without the noise of its units.
fn plain(number: f64) -> String {
    four_digits(number).to_string()
}

/// The scale or the height that was asked for.
fn wished(report: &PlanReport<'_>) -> String {
    let (scales, unit) = (report.scales, report.world);
    match report.plan.wish.size {
        Size::Scale { pixels, within } => {
            let within = within.map(|within| format!(" ± {}", plain(report.scale(within))));
            let pixels = plain(report.scale(pixels));
            format!("{pixels}{} px/{scales}", within.unwrap_or_default())
        }
        Size::Distance(distance) => {
            let from = match report.plan.wish.pattern.is_square() {
                true => "from the ground",
                false => "above the highest of the area",
            };
            format!("{} {unit} {from}", plain(distance))
        }
    }
}

/// Where the take-off is in the world, and on the Earth where its coordinate system is known.
fn say_place(sheet: &FlightSheet<'_>, place: DVec3, said: &mut Said) {
    let unit = sheet.report.world;
    said.say(
        "Take-off",
        format!("x {:.2}, y {:.2} {unit}", place.x, place.y),
    );
    let crs = sheet.crs.and_then(|crs| Crs::understand(crs).ok());
    if let Some(on_earth) = crs.and_then(|crs| crs.to_geographic(place)) {
        let degrees = |degrees: f64, [positive, negative]: [char; 2]| {
            let side = if degrees < 0.0 { negative } else { positive };
            format!("{side} {:.7}°", degrees.abs())
        };
        let latitude = degrees(on_earth.latitude, ['N', 'S']);
        let longitude = degrees(on_earth.longitude, ['E', 'W']);
        said.say("Take-off, GPS", format!("{latitude}, {longitude}"));
    }
}

/// The least and the greatest number; once where they are alike for people.
fn range(numbers: impl Iterator<Item = f64> + Clone, words: impl Fn(f64) -> String) -> String {
    let low = words(numbers.clone().fold(f64::MAX, f64::min));
    let high = words(numbers.fold(f64::MIN, f64::max));
    match low == high {
        true => low,
        false => format!("{low} to {high}"),
    }
}
