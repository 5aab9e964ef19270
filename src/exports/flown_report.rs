//! Planned against flown, going out: a table for people, CSV, JSON. Lengths are in the world's unit.

use fragscale_core::plan::{Flown, PlannedPose, Residual};
use serde_json::{Value, json};

use crate::measured::{csv_of, rows_of_text};
use crate::numbers::significant_digits;
use crate::units::LengthUnit;

/// A mission and the flight that came of it.
#[derive(Debug, Clone, Copy)]
pub struct FlownReport<'a> {
    /// The flight's name.
    pub flight: &'a str,
    /// The world's unit.
    pub unit: LengthUnit,
    /// As planned.
    pub planned: &'a [PlannedPose],
    /// The names of the photos that were taken.
    pub photos: &'a [String],
    /// How far they are from each other.
    pub flown: &'a Flown,
}

impl FlownReport<'_> {
    /// Each planned photo with the name of its photo, and how far that is from the plan.
    pub(crate) fn rows(&self) -> impl Iterator<Item = (&PlannedPose, Option<(&str, &Residual)>)> {
        let residuals = self.flown.residuals.iter().map(|residual| {
            let residual = residual.as_ref()?;
            Some((self.photos.get(residual.photo)?.as_str(), residual))
        });
        self.planned.iter().zip(residuals)
    }
}

/// A photo that is turned by more was not meant to be this one, degrees.
const ELSEWHERE: f64 = 30.0;

/// The photos and the whole as text.
pub fn flown_table(report: &FlownReport<'_>) -> String {
    let FlownReport { flight, unit, .. } = report;
    let mut text = format!(
        "{flight}: flown less planned, lengths in {unit}\n\n{:<8} {:<24} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7}\n",
        "planned", "photo", "x", "y", "z", "tilt", "pan", "shared"
    );
    for (plan, found) in report.rows() {
        let Some((photo, residual)) = found else {
            text += &format!("{:<8} not taken\n", plan.name);
            continue;
        };
        let [x, y, z] = residual.offset.to_array();
        let shared = residual
            .shared
            .map_or("-".to_owned(), |shared| format!("{:.0} %", shared * 100.0));
        text += &format!(
            "{:<8} {photo:<24} {x:>9.3} {y:>9.3} {z:>9.3} {:>6.2}° {:>6.2}° {shared:>7}\n",
            plan.name, residual.tilt, residual.pan
        );
    }
    text + "\n" + &rows_of_text(&flown_summary(report))
}

/// What is to be said of the whole: names and numbers.
pub fn flown_summary(report: &FlownReport<'_>) -> Vec<(&'static str, String)> {
    let unit = report.unit;
    let found: Vec<&Residual> = report.flown.residuals.iter().flatten().collect();
    let rms = |of: &dyn Fn(&Residual) -> f64| {
        let sum: f64 = found.iter().map(|residual| of(residual).powi(2)).sum();
        significant_digits((sum / found.len().max(1) as f64).sqrt(), 3)
    };
    let mut said = vec![(
        "taken",
        format!("{} of {} planned", found.len(), report.planned.len()),
    )];
    if !found.is_empty() {
        said.extend([
            (
                "level, rms",
                format!("{} {unit}", rms(&|r| r.offset.truncate().length())),
            ),
            ("height, rms", format!("{} {unit}", rms(&|r| r.offset.z))),
            ("tilt, rms", format!("{}°", rms(&|r| r.tilt))),
            ("turn, rms", format!("{}°", rms(&|r| r.turn))),
        ]);
    }
    said
}

/// What is to be said beside the numbers, one sentence each.
pub fn flown_warnings(report: &FlownReport<'_>) -> Vec<String> {
    let mut said = Vec::new();
    let missing: Vec<String> = report
        .rows()
        .filter(|(_, found)| found.is_none())
        .map(|(plan, _)| plan.name.clone())
        .collect();
    if !missing.is_empty() {
        let names = crate::fault::first_names(&missing);
        said.push(format!(
            "{} planned photos were not taken ({names})",
            missing.len()
        ));
    }
    if 2 * missing.len() > report.planned.len() {
        said.push(
            "most planned photos were not taken: look whether this flight is of that mission"
                .to_owned(),
        );
    }
    let turned = report.rows().filter_map(|(_, found)| found);
    let turned = turned.filter(|(_, residual)| residual.turn > ELSEWHERE);
    let (turned, taken) = (turned.count(), report.planned.len() - missing.len());
    if 2 * turned > taken {
        said.push(format!(
            "{turned} of {taken} photos look more than {ELSEWHERE}° away from where they were to look: \
             look whether this flight is of that mission"
        ));
    }
    let unplanned = report.flown.unplanned.iter();
    let unplanned: Vec<String> = unplanned
        .filter_map(|photo| report.photos.get(*photo).cloned())
        .collect();
    if !unplanned.is_empty() {
        let names = crate::fault::first_names(&unplanned);
        said.push(format!(
            "{} photos were not planned ({names})",
            unplanned.len()
        ));
    }
    said
}

/// A line a planned photo. Numbers read back to the same f64; those of photos that were not taken are empty.
///
/// # Errors
/// Where memory runs out.
pub fn flown_csv(report: &FlownReport<'_>) -> Result<String, csv::Error> {
    let unit = report.unit;
    let head = [
        "planned".to_owned(),
        "photo".to_owned(),
        format!("x_{unit}"),
        format!("y_{unit}"),
        format!("z_{unit}"),
        "tilt_degrees".to_owned(),
        "pan_degrees".to_owned(),
        "turn_degrees".to_owned(),
        "shared_percent".to_owned(),
    ];
    let lines = report.rows().map(|(plan, found)| {
        let mut line = vec![plan.name.clone()];
        match found {
            None => line.resize(head.len(), String::new()),
            Some((photo, residual)) => {
                let [x, y, z] = residual.offset.to_array();
                line.push(photo.to_owned());
                let numbers = [x, y, z, residual.tilt, residual.pan, residual.turn];
                line.extend(numbers.map(|number| number.to_string()));
                line.push(
                    residual
                        .shared
                        .map_or(String::new(), |shared| (100.0 * shared).to_string()),
                );
            }
        }
        line
    });
    let lines: Vec<Vec<String>> = lines.collect();
    csv_of(std::iter::once(head.to_vec()).chain(lines))
}

/// All of it as JSON.
///
/// # Errors
/// Where memory runs out.
pub fn flown_json(report: &FlownReport<'_>) -> Result<String, serde_json::Error> {
    let photos = report.rows().map(|(plan, found)| {
        let residual = found.map(|(photo, residual)| {
            json!({
                "photo": photo,
                "offset": residual.offset.to_array(),
                "tilt": residual.tilt,
                "pan": residual.pan,
                "turn": residual.turn,
                "shared": residual.shared,
            })
        });
        json!({"planned": plan.name, "center": plan.pose.center.to_array(), "flown": residual})
    });
    let photos: Vec<Value> = photos.collect();
    let unplanned = report.flown.unplanned.iter();
    let unplanned: Vec<&str> = unplanned
        .filter_map(|photo| report.photos.get(*photo).map(String::as_str))
        .collect();
    let value = json!({
        "flight": report.flight,
        "unit": report.unit.symbol(),
        "photos": photos,
        "unplanned": unplanned,
    });
    serde_json::to_string_pretty(&value).map(|text| text + "\n")
}
