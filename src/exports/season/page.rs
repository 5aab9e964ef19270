//! A season as a page: the trend of its sizes, every flight, and what failed.

use super::row::{FlightFindings, SeasonReport};
use super::tables::{PERCENTS, shift, size_in_words};
use super::trend;
use crate::html_page::{self, Cell, NONE, heading, notes, paragraph, signed, table};

/// The page.
pub fn season_page(report: &SeasonReport<'_>) -> String {
    let failed = report.rows.iter().filter(|row| row.error.is_some());
    let photos = report.rows.iter().filter_map(|row| row.findings.as_ref());
    let photos: usize = photos.map(|findings| findings.photos).sum();
    let (count, bad) = (report.rows.len(), failed.clone().count());
    let unit = report.unit;
    let mut body = vec![paragraph(&format!(
        "{count} flights, {photos} photos; {} done, {bad} failed. Sizes are in {unit}, with their 95 % intervals.",
        count - bad
    ))];
    body.push(notes(&report.notes));
    if let Some(drawing) = trend::drawing(report) {
        body.push(heading(2, "Sizes over the blasts"));
        body.push(paragraph(
            "What half (P50) and four fifths (P80) of the outlined rock's mass pass, and their 95 % intervals, which \
             hold what is known of the scales, the fines and the choice of photos and fragments. Two blasts differ \
             very likely where their intervals do not touch; whether outlines are right, no interval says. \"May be much more\": too \
             many of the largest fragments are cut by the photos' edges for an upper end.",
        ));
        body.push(html_page::figure(&drawing));
    }
    body.push(heading(2, "Flights"));
    if (report.rows.iter()).any(|row| shift(row, 50.0).or(shift(row, 80.0)).is_some()) {
        body.push(paragraph(
            "Sizes, and how far they are off the reference (P50 off %, P80 off %), are as measured, of all photos together. Those in psd.csv \
             and psd.html of a flight are other ones: of the function that was fitted to the mean of its photos' curves.",
        ));
    }
    body.push(flights(report));
    if bad > 0 {
        body.push(heading(2, "Failed"));
        let rows = failed.map(|row| {
            let error = row.error.clone().unwrap_or_default();
            vec![row.blast.clone().into(), error.into()]
        });
        body.push(html_page_words(&["Blast", "Why"], rows.collect()));
    }
    let warned = report.rows.iter().filter_map(|row| {
        let warnings = &row.findings.as_ref()?.warnings;
        (!warnings.is_empty()).then_some((&row.blast, warnings))
    });
    let rows: Vec<Vec<Cell>> = warned
        .flat_map(|(blast, warnings)| {
            let said = warnings.iter();
            said.map(|warning| vec![blast.clone().into(), warning.clone().into()])
        })
        .collect();
    if !rows.is_empty() {
        body.push(heading(2, "Warnings"));
        body.push(html_page_words(&["Blast", "What"], rows));
    }
    html_page::page(report.name, report.name, &body.concat())
}

/// A table whose last column is sentences.
fn html_page_words(heads: &[&str], rows: Vec<Vec<Cell>>) -> String {
    let table = table(&html_page::names(heads), rows);
    format!("<div class=\"words-last\">\n{table}</div>\n")
}

fn flights(report: &SeasonReport<'_>) -> String {
    let symbol = report.unit.symbol();
    let has_sizes = report.rows.iter().any(|row| row.size(50.0).is_some());
    let has_shifts = report.rows.iter().any(|row| shift(row, 50.0).is_some());
    let mut heads = html_page::names(&[
        "Blast", "Date", "State", "Photos", "Trust", "Check", "No scale",
    ]);
    if has_sizes {
        heads.extend(PERCENTS.map(|percent| format!("P{percent} {symbol}")));
    }
    if has_shifts {
        heads.extend(["P50 off %", "P80 off %"].map(str::to_owned));
    }
    let rows = report.rows.iter().map(|row| {
        let findings = row.findings.as_ref();
        let count = |of: fn(&FlightFindings) -> usize| {
            let count = findings.map(|findings| of(findings).to_string());
            Cell::from(count.unwrap_or_else(|| NONE.to_owned()))
        };
        let date = row.date.map(|date| date.to_string());
        let mut cells = vec![
            Cell::from(row.blast.clone()),
            date.unwrap_or_else(|| NONE.to_owned()).into(),
            Cell::Judged(row.error.is_none(), row.state()),
            count(|of| of.photos),
            count(|of| of.verdicts.trust + of.verdicts.accepted),
            count(|of| of.verdicts.check),
            count(|of| of.verdicts.no_scale),
        ];
        if has_sizes {
            let size = |percent| size_in_words(row.size(percent));
            let sizes = PERCENTS.map(|percent| size(percent).unwrap_or_else(|| NONE.to_owned()));
            cells.extend(sizes.map(Cell::from));
        }
        if has_shifts {
            cells.extend([50.0, 80.0].map(|percent| signed(shift(row, percent)).into()));
        }
        cells
    });
    table(&heads, rows.collect())
}
