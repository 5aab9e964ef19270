//! A flight against its plan as a page for its report: the figure, what is to be said of the whole, and every planned
//! photo with its residuals.

use super::FlownFigure;
use crate::drawing::DrawingFormat;
use crate::fault::Fault;
use crate::flown_report::flown_summary;
use crate::html_page::{self, Cell, NONE, heading, names, notes, pairs, paragraph, table};

pub(super) fn page(figure: &FlownFigure<'_>, warnings: &[String]) -> Result<String, Fault> {
    let report = figure.report;
    let drawn = figure.bytes(DrawingFormat::Svg)?;
    let drawn = String::from_utf8_lossy(&drawn);
    // What an XML document begins with has no place inside a page.
    let svg = drawn.find("<svg").map_or("", |at| &drawn[at..]);
    let said = flown_summary(report).into_iter();
    let said: Vec<(String, String)> = said.map(|(name, words)| (name.to_owned(), words)).collect();
    let title = format!("Planned and flown: {}", report.flight);
    let body = [
        html_page::figure(svg),
        pairs(&said),
        notes(warnings),
        heading(2, "Photos, in the order of the plan"),
        paragraph(&format!(
            "Flown less planned: x, y and z in {}, tilt below the horizon and pan clockwise in degrees. Shared: how much of \
             what the photo was to show it shows.",
            report.unit
        )),
        rows(figure),
        unplanned(figure),
    ];
    Ok(html_page::page(&title, &title, &body.concat()))
}

/// Every planned photo.
fn rows(figure: &FlownFigure<'_>) -> String {
    let head = names(&["Planned", "Photo", "x", "y", "z", "Tilt", "Pan", "Shared"]);
    let rows = figure.report.rows().map(|(plan, found)| -> Vec<Cell> {
        let name = Cell::from(plan.name.as_str());
        let Some((photo, residual)) = found else {
            let missing = std::iter::repeat_with(|| Cell::from(NONE)).take(6);
            return [name, "not taken".into()]
                .into_iter()
                .chain(missing)
                .collect();
        };
        let lengths = residual.offset.to_array();
        let lengths = lengths.map(|length| Cell::from(format!("{length:+.3}")));
        let angles = [residual.tilt, residual.pan];
        let angles = angles.map(|angle| Cell::from(format!("{angle:+.2}°")));
        let shared = residual
            .shared
            .map_or(NONE.to_owned(), |shared| format!("{:.0} %", shared * 100.0));
        [name, Cell::from(photo)]
            .into_iter()
            .chain(lengths)
            .chain(angles)
            .chain([shared.into()])
            .collect()
    });
    table(&head, rows.collect())
}

/// Photos that nobody planned; nothing where there are none.
fn unplanned(figure: &FlownFigure<'_>) -> String {
    let report = figure.report;
    let photos = report.flown.unplanned.iter();
    let rows: Vec<Vec<Cell>> = photos
        .filter_map(|photo| -> Option<Vec<Cell>> {
            let place = figure.places.get(*photo)?.to_array();
            let name = Cell::from(report.photos.get(*photo)?.as_str());
            let place = place.map(|number| Cell::from(format!("{number:.3}")));
            Some([name].into_iter().chain(place).collect())
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let head = names(&["Photo", "x", "y", "z"]);
    heading(2, "Photos that nobody planned") + &table(&head, rows)
}
