//! A plan of photos, going out: a table for people, CSV, JSON. Lengths are in the world's unit, scales in pixels per a
//! unit that the reader chose; both are said.
//!
//! ```text
//! warnings  what is to be said beside the numbers
//! ```

mod warnings;

pub use warnings::plan_warnings;

use glam::DVec2;
use serde_json::{Value, json};

use crate::measured::{csv_of, percent, rows_of_text};
use crate::numbers::{counted, significant_digits};
use crate::survey::Polygon;
use crate::units::LengthUnit;
use fragscale_core::plan::{
    Beyond, Pace, Plan, PlannedPhoto, Purpose, Refused, Shadows, Sun, Way, homes_over_keep_out,
};

/// A plan, and how it is to be said.
#[derive(Debug, Clone, Copy)]
pub struct PlanReport<'a> {
    /// The flight's name, of whose surface it is.
    pub flight: &'a str,
    /// The world's unit.
    pub world: LengthUnit,
    /// Scales are in pixels per this unit.
    pub scales: LengthUnit,
    /// The plan.
    pub plan: &'a Plan,
    /// The ways through its photos, one a battery or a file of its missions; empty where the take-off is not known.
    pub ways: &'a [Way],
    /// How fast they are flown.
    pub pace: Pace,
    /// Whether the camera is only known by its maker's field of view.
    pub is_nominal: bool,
    /// Where the sun stands then, and what lies in shadow, where the time is known.
    pub sun: Option<(&'a Sun, &'a Shadows)>,
}

impl PlanReport<'_> {
    /// Pixels per the reader's unit of pixels per world unit.
    pub(crate) fn scale(&self, pixels: f64) -> f64 {
        pixels * self.scales.in_units_of(self.world)
    }

    pub(crate) fn way_length(&self) -> f64 {
        self.ways.iter().map(|way| way.length).sum()
    }

    /// Seconds in the air.
    pub(crate) fn seconds(&self) -> f64 {
        self.ways.iter().map(|way| way.seconds(&self.pace)).sum()
    }

    /// What each of several ways is called: that of a battery, where somebody said how long one lasts, else a flight.
    pub(crate) fn way_name(&self) -> &'static str {
        match self.pace.battery {
            Some(_) => "Battery",
            None => "Flight",
        }
    }
}

/// What stands in a row of a photo; scales in pixels per the reader's unit, angles in degrees, shares 0 to 1.
pub(crate) struct Row {
    pub(crate) name: String,
    /// What it is taken for, in a word.
    purpose: &'static str,
    pub(crate) tilt: f64,
    pub(crate) pan: f64,
    /// Along the axis, to the surface.
    pub(crate) distance: Option<f64>,
    /// Least, greatest, top and bottom of the fitted line.
    pub(crate) scales: [Option<f64>; 4],
    pub(crate) off_line: Option<f64>,
    /// Half of the 95 % interval that the drone's errors give its scale, percent.
    pub(crate) interval: Option<f64>,
    shows: f64,
    pub(crate) shared: f64,
    /// Of what it shows, in shadow.
    pub(crate) shadow: Option<f64>,
    pub(crate) troubles: String,
}

fn row(report: &PlanReport<'_>, number: usize, photo: &PlannedPhoto) -> Row {
    let forecast = photo.forecast.as_ref();
    let fitted = forecast.and_then(|forecast| forecast.fitted);
    let scale = |pixels: Option<f64>| pixels.map(|pixels| report.scale(pixels));
    Row {
        name: photo.name.clone(),
        purpose: photo.purpose.as_str(),
        tilt: photo.tilt,
        pan: photo.pan,
        distance: forecast.and_then(|forecast| forecast.depth),
        scales: [
            scale(forecast.map(|forecast| forecast.least)),
            scale(forecast.map(|forecast| forecast.greatest)),
            scale(fitted.map(|fitted| fitted.top)),
            scale(fitted.map(|fitted| fitted.bottom)),
        ],
        off_line: fitted.map(|fitted| fitted.rms_percent),
        interval: photo.interval,
        shows: forecast.map_or(0.0, |forecast| forecast.covered),
        shared: (report.plan.cover.shared)
            .get(number)
            .copied()
            .unwrap_or(0.0),
        shadow: report
            .sun
            .and_then(|(_, shadows)| shadows.photos.get(number).copied()),
        troubles: report.plan.troubles(number).join("; "),
    }
}

pub(crate) fn rows<'a>(report: &'a PlanReport<'a>) -> impl Iterator<Item = Row> + 'a {
    let photos = report.plan.photos.iter().enumerate();
    photos.map(|(number, photo)| row(report, number, photo))
}

/// A direction to a tenth of a degree: what rounds to 360, or to -0, is 0.
pub(crate) fn pan_in_words(pan: f64) -> String {
    format!("{:.1}°", (pan * 10.0).round() / 10.0 % 360.0 + 0.0)
}

/// A place of the surface to a hundredth, for a laboratory's pile is a metre wide; what rounds to -0 is 0.
fn place_in_words(place: DVec2) -> String {
    let [x, y] = place
        .to_array()
        .map(|number| (number * 100.0).round() / 100.0 + 0.0);
    format!("({x:.2}, {y:.2})")
}

/// The photos and what is to be said of all of them, as text.
pub fn plan_table(report: &PlanReport<'_>) -> String {
    let PlanReport {
        flight,
        world,
        scales,
        plan,
        ..
    } = report;
    let number = |number: f64| significant_digits(number, 4);
    let maybe = |scale: Option<f64>| scale.map_or("-".to_owned(), number);
    let mut text = format!(
        "{flight}: plan of {} photos; scales in px/{scales}, lengths in {world}\n\n{:<6} {:>6} {:>6} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7} {:>7}  troubles\n",
        plan.photos.len(),
        "photo",
        "tilt",
        "pan",
        "distance",
        "least",
        "top",
        "bottom",
        "greatest",
        "off line",
        "95 %",
        "shared"
    );
    for row in rows(report) {
        let [least, greatest, top, bottom] = row.scales.map(maybe);
        let off_line = row
            .off_line
            .map_or("-".to_owned(), |off| format!("{off:.1} %"));
        let interval = row
            .interval
            .map_or("-".to_owned(), |interval| format!("±{interval:.1} %"));
        text += &format!(
            "{:<6} {:>5.1}° {:>6} {:>9} {least:>8} {top:>8} {bottom:>8} {greatest:>8} {off_line:>8} {interval:>7} {:>5.0} %  {}\n",
            row.name,
            row.tilt,
            pan_in_words(row.pan),
            maybe(row.distance),
            row.shared * 100.0,
            row.troubles
        );
    }
    let gap = plan.cover.widest_gap;
    let mut said = vec![("area", format!("{} {world}²", number(plan.area.area())))];
    if let Some(kinds) = kinds_in_words(plan) {
        said.push(("photos", kinds));
    }
    said.extend([
        ("photographed", percent(plan.cover.covered)),
        (
            "widest gap",
            match gap > 0.0 {
                true => format!("{} {world} across", number(gap)),
                false => "none".to_owned(),
            },
        ),
    ]);
    if let Some(share) = plan.cover.surveyed {
        said.push(("in 3 of the survey", percent(share)));
    }
    if let Some(words) = overlap_in_words(plan) {
        said.push(("survey's overlap", words));
    }
    if !report.ways.is_empty() {
        let length = format!("{} {world}", number(report.way_length()));
        let minutes = significant_digits(report.seconds() / 60.0, 2);
        let mut way = format!("{length}, about {minutes} min in the air");
        let count = report.ways.len();
        if count > 1 {
            way += &match report.pace.battery {
                Some(_) => format!(" with {count} batteries"),
                None => format!(" in {count} flights"),
            };
        }
        said.push(("way", way));
    }
    if let Some(words) = sun_in_words(report) {
        said.push(("sun", words));
    }
    text + "\n" + &rows_of_text(&said)
}

/// How many photos are taken for what; `None` where all are for one.
pub fn kinds_in_words(plan: &Plan) -> Option<String> {
    let count = |purpose: Purpose| {
        let own = plan.photos.iter();
        own.filter(|photo| photo.purpose == purpose).count()
    };
    let [scales, survey] = [Purpose::Scale, Purpose::Survey].map(count);
    (scales > 0 && survey > 0)
        .then(|| format!("{scales} for scales (P), {survey} of the survey (S)"))
}

/// How much photos of the survey share with the next, in the mean and where the ground of the area comes nearest to them;
/// `None` where no photo of a survey looks straight down.
pub(crate) fn overlap_in_words(plan: &Plan) -> Option<String> {
    let (mean, least) = (plan.wish.survey.overlap, plan.cover.least_overlap?);
    Some(format!(
        "{} in the mean, {} over the highest of the area",
        percent(mean),
        percent(least.max(0.0))
    ))
}

/// Where the sun stands and how much lies in shadow; `None` where the time is not known.
pub(crate) fn sun_in_words(report: &PlanReport<'_>) -> Option<String> {
    let (sun, shadows) = report.sun?;
    if sun.elevation <= 0.0 {
        return Some("below the horizon: it is night".to_owned());
    }
    Some(format!(
        "{:.1}° high, from {:.0}° (north 0°, east 90°); {} of the area in shadow",
        sun.elevation,
        sun.azimuth,
        percent(shadows.area)
    ))
}

/// Photos that cannot be taken, a sentence for each cause: the first of them, and how many more there are.
pub(crate) fn refusals(all: &[Refused]) -> Vec<String> {
    let mut first: Vec<(&Refused, usize)> = Vec::new();
    for refused in all {
        let known = first
            .iter_mut()
            .find(|(known, _)| known.cause() == refused.cause());
        match known {
            Some((_, more)) => *more += 1,
            None => first.push((refused, 0)),
        }
    }
    let sentences = first.iter().map(|(refused, more)| {
        let place = place_in_words(refused.place);
        let others = match more {
            0 => String::new(),
            more => format!(" and at {}", counted(*more, "other place")),
        };
        format!("no photo at {place}{others}: {}", refused.why)
    });
    sentences.collect()
}

/// How much of the flight leads beyond the surface, and how far; `None` where nothing does.
pub(crate) fn beyond_in_words(report: &PlanReport<'_>) -> Option<String> {
    let beyond = Beyond::of(report.plan, report.ways);
    if beyond.is_none() {
        return None;
    }
    let farthest = significant_digits(beyond.farthest, 2);
    let out = format!("beyond the surface, up to {farthest} {} out", report.world);
    let (stops, of_stops) = (beyond.stops, beyond.of_stops);
    Some(match beyond.of_legs {
        0 => format!("{stops} of {of_stops} photos are taken from {out}"),
        of_legs => format!(
            "{stops} of {of_stops} stops and {} of {of_legs} legs lie {out}",
            beyond.legs
        ),
    })
}

/// A line a photo. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn plan_csv(report: &PlanReport<'_>) -> Result<String, csv::Error> {
    let (world, scales) = (report.world, report.scales);
    let head = [
        "photo".to_owned(),
        format!("x_{world}"),
        format!("y_{world}"),
        format!("z_{world}"),
        "tilt_degrees".to_owned(),
        "pan_degrees".to_owned(),
        format!("distance_{world}"),
        format!("least_px_per_{scales}"),
        format!("greatest_px_per_{scales}"),
        format!("top_px_per_{scales}"),
        format!("bottom_px_per_{scales}"),
        "off_line_percent".to_owned(),
        "interval_95_percent".to_owned(),
        "shows_percent".to_owned(),
        "shared_percent".to_owned(),
        "off_normal_degrees".to_owned(),
        "shadow_percent".to_owned(),
        "purpose".to_owned(),
        "troubles".to_owned(),
    ];
    let maybe = |number: Option<f64>| number.map_or(String::new(), |number| number.to_string());
    let lines = rows(report).zip(&report.plan.photos).map(|(row, photo)| {
        let [x, y, z] = photo.pose.center.to_array().map(|place| place.to_string());
        let angles = [row.tilt, row.pan].map(|number| number.to_string());
        let mut line = vec![row.name, x, y, z];
        line.extend(angles);
        line.push(maybe(row.distance));
        line.extend(row.scales.map(maybe));
        line.extend([row.off_line, row.interval].map(maybe));
        line.extend(
            [100.0 * row.shows, 100.0 * row.shared, photo.off_normal]
                .map(|number| number.to_string()),
        );
        line.push(maybe(row.shadow.map(|share| 100.0 * share)));
        line.push(row.purpose.to_owned());
        line.push(row.troubles);
        line
    });
    csv_of(std::iter::once(head.to_vec()).chain(lines))
}

/// All of it as JSON.
///
/// # Errors
/// Where memory runs out.
pub fn plan_json(report: &PlanReport<'_>) -> Result<String, serde_json::Error> {
    let plan = report.plan;
    let beyond = Beyond::of(plan, report.ways);
    let photos = rows(report).zip(&plan.photos).enumerate();
    let photos: Vec<Value> = photos
        .map(|(number, (row, photo))| {
            let [least, greatest, top, bottom] = row.scales;
            json!({
                "photo": row.name,
                "purpose": row.purpose,
                "center": photo.pose.center.to_array(),
                "tilt": row.tilt,
                "pan": row.pan,
                "target": photo.target.to_array(),
                "distance": row.distance,
                "least": least,
                "greatest": greatest,
                "top": top,
                "bottom": bottom,
                "off_line_percent": row.off_line,
                "interval_95_percent": row.interval,
                "shows": row.shows,
                "shared": row.shared,
                "off_normal": photo.off_normal,
                "shadow": row.shadow,
                "troubles": plan.troubles(number),
            })
        })
        .collect();
    let refused: Vec<Value> = (plan.refused.iter())
        .map(|refused| json!({"place": refused.place.to_array(), "why": refused.why}))
        .collect();
    let corners = |area: &Polygon| -> Vec<[f64; 2]> {
        area.corners()
            .iter()
            .map(|corner| corner.to_array())
            .collect()
    };
    let sun = report.sun.map(|(sun, shadows)| {
        json!({
            "elevation": sun.elevation,
            "azimuth": sun.azimuth,
            "shadow": shadows.area,
        })
    });
    let value = json!({
        "sun": sun,
        "flight": report.flight,
        "unit": report.world.symbol(),
        "scale_unit": report.scales.symbol(),
        "overlap": plan.wish.overlap_of(plan.wish.pattern.main()),
        "survey": plan.wish.pattern.has(Purpose::Survey).then(|| json!({
            "overlap": plan.wish.survey.overlap,
            "cross": plan.wish.survey.cross,
            "ring": plan.wish.survey.ring,
        })),
        "steepest": report.pace.steepest,
        "clearance": plan.wish.clearance,
        "keep_out": plan.wish.keep_out.iter().map(corners).collect::<Vec<_>>(),
        "drone_errors": {
            "level": plan.wish.errors.level,
            "upright": plan.wish.errors.upright,
            "pitch_degrees": plan.wish.errors.pitch,
            "heading_degrees": plan.wish.errors.heading,
        },
        "take_off": plan.wish.take_off.map(|place| place.to_array()),
        "pattern": plan.wish.pattern.as_str(),
        "area": corners(&plan.area),
        "photographed": plan.cover.covered,
        "surveyed": plan.cover.surveyed,
        "least_survey_overlap": plan.cover.least_overlap,
        "homes_over_keep_out": (!report.ways.is_empty())
            .then(|| homes_over_keep_out(plan, report.ways)),
        "beyond_surface": {
            "stops": beyond.stops,
            "legs": beyond.legs,
            "farthest": beyond.farthest,
        },
        "widest_gap": plan.cover.widest_gap,
        "ways": report.ways.iter().map(|way| json!({
            "length": way.length,
            "seconds": way.seconds(&report.pace),
            "photos": way.points.iter().filter_map(|point| plan.photos.get(point.photo?))
                .map(|photo| photo.name.as_str()).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
        "photos": photos,
        "refused": refused,
    });
    serde_json::to_string_pretty(&value).map(|text| text + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What photos have in common is told once, with the first place and the number of the others.
    #[test]
    fn refused_photos_are_told_by_cause() {
        let refused = |x: f64, why: &str| Refused {
            place: DVec2::new(x, 2.0),
            why: why.to_owned(),
        };
        let near = "the drone would come nearer to the ground than the clearance";
        let all = [
            refused(1.0, near),
            refused(2.0, "the gimbal does not reach so far: to -37 degrees"),
            refused(3.0, near),
            refused(4.0, "the gimbal does not reach so far: to -41 degrees"),
            refused(5.0, near),
            refused(6.0, "it lies in a hole"),
        ];
        let said = [
            format!("no photo at (1.00, 2.00) and at 2 other places: {near}"),
            "no photo at (2.00, 2.00) and at 1 other place: the gimbal does not reach so far: to -37 degrees"
                .to_owned(),
            "no photo at (6.00, 2.00): it lies in a hole".to_owned(),
        ];
        assert_eq!(refusals(&all), said);
    }

    #[test]
    fn directions_are_below_360() {
        let said = [0.0, 0.04, 90.25, 359.94, 359.96, -0.04].map(pan_in_words);
        assert_eq!(said, ["0.0°", "0.0°", "90.3°", "359.9°", "0.0°", "0.0°"]);
    }

    #[test]
    fn places_have_no_negative_zero() {
        let said = [DVec2::new(-0.004, 500_035.126), DVec2::new(-0.71, 0.0)].map(place_in_words);
        assert_eq!(said, ["(0.00, 500035.13)", "(-0.71, 0.00)"]);
    }
}
