//! A plan of photos as a sheet for whoever flies it: one HTML page that prints on A4, with a map at a round scale, the
//! numbers, what the plan warns of, a checklist and the table of photos.
//!
//! It is HTML alone: a plan has as many rows as it has photos, and a browser breaks them over pages with their
//! heads, in the letters of any language, and saves the same as PDF; our own PDF has one page and the letters of western
//! Europe. Who wants the map alone as a drawing has it inside, as SVG. Nobody here has a clock: the day and the names of
//! the crew are lines to write on.
//!
//! ```text
//! map      the map: ground, footprints, way, take-off, scale bar
//! legend   what its signs mean
//! numbers  what is to be known before take-off
//! words    checklist, photos, what was not planned
//! ```

mod legend;
mod map;
mod numbers;
mod signs;
#[cfg(test)]
mod tests;
mod words;

use crate::fault::Fault;
use crate::flight_plan::{PlanReport, refusals};
use crate::html_page::{self, blanks, heading, notes, paragraph};

/// A plan with what its sheet says besides.
#[derive(Clone, Copy)]
pub struct FlightSheet<'a> {
    /// The plan and how it is to be said.
    pub report: &'a PlanReport<'a>,
    /// The drone, as its maker writes it, where it is known.
    pub drone: Option<&'a str>,
    /// Seconds that the drone waits at a photo for its gimbal.
    pub settle: f64,
    /// The coordinate system of the surface, where it is known.
    pub crs: Option<&'a str>,
    /// What is to be said beside the plan, one sentence each.
    pub warnings: &'a [String],
}

/// The sheet as HTML.
///
/// # Errors
/// Only where the map cannot be encoded.
pub fn flight_sheet(sheet: &FlightSheet<'_>) -> Result<String, Fault> {
    let map = map::map(sheet)?;
    let title = format!("Flight plan: {}", sheet.report.flight);
    let mut body = vec![
        blanks(&["Date", "Pilot", "Observer", "Drone", "Wind"]),
        html_page::figure_to_scale(&map),
    ];
    body.push(html_page::pairs(&numbers::numbers(sheet)));
    // Refused photos have a table of their own.
    let refused = refusals(&sheet.report.plan.refused);
    let others = sheet.warnings.iter();
    body.push(notes(others.filter(|warning| !refused.contains(warning))));
    body.push(heading(2, "Before take-off"));
    body.push(html_page::boxes(&words::checklist(sheet)));
    body.push(heading(2, "Photos, in the order of the flight"));
    body.push(paragraph(&words::columns_in_words(sheet.report)));
    body.push(words::photos(sheet.report));
    if !sheet.report.plan.refused.is_empty() {
        body.push(heading(2, "Not planned"));
        body.push(words::refused(sheet.report));
    }
    Ok(html_page::page(&title, &title, &body.concat()))
}
