//! The numbers of a sheet: what is to be known before take-off.

use glam::DVec3;

use super::FlightSheet;
use crate::flight_plan::PlanReport;
use crate::geodesy::Crs;
use crate::measured::percent;
use crate::numbers::{four_digits, significant_digits};
use fragscale_core::plan::{Pattern, Size, Way};

/// Names and what is said of them, in the order of the page.
pub(super) fn numbers(sheet: &FlightSheet<'_>) -> Vec<(&'static str, String)> {
    let report = sheet.report;
    let (plan, unit) = (report.plan, report.world);
    let number = |number: f64| significant_digits(number, 3);
    let mut said = vec![("Photos", plan.photos.len().to_string())];
    if !plan.refused.is_empty() {
        said.push(("Not possible", format!("{} photos", plan.refused.len())));
    }
    said.push(("Pattern", plan.wish.pattern.as_str().to_owned()));
    said.push(("Wished", wished(report)));
    if plan.wish.overlap > 0.0 {
        said.push(("Overlap", percent(plan.wish.overlap)));
    }
    let camera = sheet.camera;
    let pixels = format!("{} x {} px", camera.width, camera.height);
    said.push((
        "Camera",
        match sheet.drone {
            Some(drone) => format!("{drone}, {pixels}"),
            None => pixels,
        },
    ));
    let tilts = plan.photos.iter().map(|photo| photo.tilt);
    let least = tilts.clone().fold(f64::MAX, f64::min);
    let greatest = tilts.fold(f64::MIN, f64::max);
    said.push((
        "Gimbal pitch",
        between(-greatest, -least, |pitch| format!("{pitch:.0}°")),
    ));
    said.push((
        "Area",
        format!(
            "{} {unit}², {} photographed",
            number(plan.area.area()),
            percent(plan.cover.covered)
        ),
    ));
    if plan.cover.widest_gap > 0.0 {
        said.push((
            "Widest gap",
            format!("{} {unit}", number(plan.cover.widest_gap)),
        ));
    }
    said.push((
        "Clearance",
        format!(
            "{} {unit} from the ground and walls",
            plain(plan.wish.clearance)
        ),
    ));
    let metres = report.pace.speed * unit.metres();
    let keep_out = plan.wish.keep_out.len();
    if keep_out > 0 {
        let words = format!("{keep_out} on the map, the clearance beside them at any height");
        said.push(("Keep out", words));
    }
    said.push((
        "Speed",
        format!(
            "{} m/s, waits {} s at a photo",
            plain(metres),
            plain(sheet.settle)
        ),
    ));
    if let Some(first) = report.ways.first() {
        said.extend(of_ways(report, first));
        said.push(("Take-off", place(sheet, first.take_off)));
    }
    said
}

/// What the ways say, where the take-off is known.
fn of_ways(report: &PlanReport<'_>, first: &Way) -> Vec<(&'static str, String)> {
    let unit = report.world;
    let number = |number: f64| significant_digits(number, 3);
    let minutes = |seconds: f64| significant_digits(seconds / 60.0, 2);
    let above = |z: f64| z - first.take_off.z;
    let heights = report
        .plan
        .photos
        .iter()
        .map(|photo| above(photo.pose.center.z));
    let lowest = heights.clone().fold(f64::MAX, f64::min);
    let highest = heights.fold(f64::MIN, f64::max);
    let safe = report.ways.iter().map(|way| way.safe_height);
    let safe = safe.fold(f64::MIN, f64::max);
    let mut said = vec![
        (
            "Way",
            format!(
                "{} {unit}, about {} min in the air",
                number(report.way_length()),
                minutes(report.seconds())
            ),
        ),
        (
            "Safe height",
            format!("{:.1} {unit} above take-off", safe - first.take_off.z),
        ),
        (
            "Return home",
            format!(
                "at least {} above take-off",
                return_height_in_words(report).unwrap_or_default()
            ),
        ),
        (
            "Photos from",
            format!(
                "{} {unit} above take-off",
                between(lowest, highest, |height| format!("{height:.1}"))
            ),
        ),
    ];
    if report.ways.len() > 1 {
        for (way, battery) in report.ways.iter().zip(1..) {
            let photos: Vec<usize> = way.points.iter().filter_map(|point| point.photo).collect();
            let name = |photo: Option<&usize>| {
                let photo = photo.and_then(|photo| report.plan.photos.get(*photo));
                photo.map_or("", |photo| photo.name.as_str())
            };
            let (from, to) = (name(photos.first()), name(photos.last()));
            let minutes = minutes(way.seconds(&report.pace));
            said.push((
                "Battery",
                format!("{battery}: {from} to {to}, about {minutes} min"),
            ));
        }
    }
    said
}

/// The height above the take-off from which the drone comes straight home from every photo, and keeps the clearance:
/// never below the safe height of the ways.
fn return_height(report: &PlanReport<'_>) -> Option<f64> {
    let (plan, take_off) = (report.plan, report.ways.first()?.take_off);
    let clearance = plan.wish.clearance;
    let over = plan.photos.iter().filter_map(|photo| {
        let from = photo.pose.center.truncate();
        let ground = plan
            .terrain
            .highest_along(from, take_off.truncate(), clearance);
        Some(ground? + clearance)
    });
    let safe = report.ways.iter().map(|way| way.safe_height);
    Some(over.chain(safe).fold(f64::MIN, f64::max) - take_off.z)
}

/// The same for people, rounded up to a whole metre, for it is set at the ground station.
pub(super) fn return_height_in_words(report: &PlanReport<'_>) -> Option<String> {
    let unit = report.world;
    // A rounding error above a whole metre is that metre.
    let whole = |height: f64| (height - 1e-6).ceil();
    let height = return_height(report)?;
    let (rounded, metres) = (whole(height), whole(height * unit.metres()));
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
            let from = match report.plan.wish.pattern {
                Pattern::Slope => "from the ground",
                _ => "above the highest of the area",
            };
            format!("{} {unit} {from}", plain(distance))
        }
    }
}

/// A place in the world, and on the Earth where its coordinate system is known.
fn place(sheet: &FlightSheet<'_>, place: DVec3) -> String {
    let crs = sheet.crs.and_then(|crs| Crs::understand(crs).ok());
    let mut words = format!(
        "x {:.2}, y {:.2}, z {:.2} {}",
        place.x, place.y, place.z, sheet.report.world
    );
    if let Some(on_earth) = crs.and_then(|crs| crs.to_geographic(place)) {
        words += &format!(
            "; latitude {:.7}, longitude {:.7}",
            on_earth.latitude, on_earth.longitude
        );
    }
    words
}

/// "a", or "a to b" where they differ for people.
fn between(low: f64, high: f64, words: impl Fn(f64) -> String) -> String {
    let (low, high) = (words(low), words(high));
    match low == high {
        true => low,
        false => format!("{low} to {high}"),
    }
}
