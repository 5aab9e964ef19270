//! The words of a sheet: what to check before take-off, the photos in a table, and those that were refused.

use super::FlightSheet;
use super::numbers::return_height_in_words;
use crate::flight_plan::{PlanReport, pan_in_words, rows};
use crate::html_page::{Cell, NONE, names, table};
use crate::numbers::significant_digits;
use fragscale_core::plan::homes_over_keep_out;

/// What the pilot looks at, in the order in which it is done.
pub(super) fn checklist(sheet: &FlightSheet<'_>) -> Vec<String> {
    let report = sheet.report;
    let said = |words: &str| words.to_owned();
    let mut list = vec![
        said(
            "No misfires; people and machines are clear of the area and of the way; the blaster has released it",
        ),
        said("Permission, airspace and the mine's own rules are checked; radios are on"),
        said("Wind, rain, dust and light are within what the drone and the photos allow"),
        said(
            "Cranes, cables, masts and whatever stands there since the surface was measured: the plan knows none of them",
        ),
    ];
    match return_height_in_words(report) {
        Some(height) => {
            list.push(said("The drone stands at the take-off of the map: all heights count from there, a metre higher here is one everywhere"));
            list.push(format!("Return-to-home height is at least {height} above take-off; the home point is set"));
        }
        None => list.push(said("The take-off is chosen and the plan made again with --take-off: without it there is no way, no safe height and no mission")),
    }
    if !report.plan.wish.keep_out.is_empty() {
        let is_clear =
            !report.ways.is_empty() && homes_over_keep_out(report.plan, report.ways) == 0;
        list.push(said(match is_clear {
            true => "Return-to-home flies straight: from every stop that keeps out of the areas to keep out of, from elsewhere it may not",
            false => "Return-to-home flies straight, over the areas to keep out of, too, also with a low battery: in need, bring the drone back by hand, and before the battery is low; where the radio is lost it is to hover, which is set at the drone, too",
        }));
    }
    list.push(match (report.ways.len(), report.pace.battery) {
        (0 | 1, _) => {
            said("Battery is full and warm; the way and a reserve are within what it lasts")
        }
        (batteries, Some(_)) => format!(
            "{batteries} batteries are full and warm; each mission is flown with a fresh one"
        ),
        (flights, None) => format!(
            "Battery is full and warm before each of the {flights} flights; its way and a reserve are within what it lasts"
        ),
    });
    list.extend([
        said("Geofence and the zones to keep out of are loaded; the mission is looked at in the ground station"),
        said("Camera: photo size and lens as planned, no zoom, mechanical shutter, short exposure, focus set and locked, memory card empty"),
        said("Gimbal moves freely over the pitches above; no cover, lens clean"),
        said("The first photo is looked at before the rest is flown: sharp, well lit, and it shows what the map says"),
    ]);
    list
}

/// What the columns of the table are in.
pub(super) fn columns_in_words(report: &PlanReport<'_>) -> String {
    format!(
        "Tilt is below the horizon, 90 straight down; pan clockwise from north (y). Distance in {unit} along the axis. \
         Top and bottom: the scale at the edges of the photo in px/{scales}, of the line that fits best; off line: how \
         far its scales lie off that, rms; 95 %: how far the drone's errors may move them. Shared: what other photos \
         show, too.",
        unit = report.world,
        scales = report.scales,
    )
}

/// The photos, a row each.
pub(super) fn photos(report: &PlanReport<'_>) -> String {
    let head = names(&[
        "Photo", "Tilt", "Pan", "Distance", "Top", "Bottom", "Off line", "95 %", "Shared",
        "Troubles",
    ]);
    let digits = |number: f64| significant_digits(number, 4);
    let maybe = |number: Option<f64>| number.map_or(NONE.to_owned(), digits);
    let rows = rows(report).map(|row| {
        let [_, _, top, bottom] = row.scales;
        let interval = row
            .interval
            .map_or(NONE.to_owned(), |interval| format!("±{interval:.1} %"));
        let off_line = row
            .off_line
            .map_or(NONE.to_owned(), |off| format!("{off:.1} %"));
        vec![
            Cell::from(row.name),
            format!("{:.1}°", row.tilt).into(),
            pan_in_words(row.pan).into(),
            maybe(row.distance).into(),
            maybe(top).into(),
            maybe(bottom).into(),
            off_line.into(),
            interval.into(),
            format!("{:.0} %", row.shared * 100.0).into(),
            row.troubles.into(),
        ]
    });
    last_to_the_left(&table(&head, rows.collect()))
}

/// How the map and the table call a refused photo, by its number from 1.
pub(super) fn refused_name(number: usize) -> String {
    format!("R{number}")
}

/// The refused photos, a row each.
pub(super) fn refused(report: &PlanReport<'_>) -> String {
    let head = names(&["Place", "x", "y", "Why"]);
    let rows = report
        .plan
        .refused
        .iter()
        .zip(1..)
        .map(|(refused, number)| {
            vec![
                Cell::from(refused_name(number)),
                format!("{:.1}", refused.place.x).into(),
                format!("{:.1}", refused.place.y).into(),
                refused.why.as_str().into(),
            ]
        });
    last_to_the_left(&table(&head, rows.collect()))
}

/// The last column is words.
fn last_to_the_left(table: &str) -> String {
    format!("<div class=\"words-last\">\n{table}</div>\n")
}
