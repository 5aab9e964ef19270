//! A season's flights as CSV, JSON lines and a table for people.

use serde::Serialize;

use super::row::{FoundSize, SeasonReport, SeasonRow, SizeShift, VerdictCounts};
use crate::measured::csv_of;
use crate::numbers::{significant_digits, within_interval};
use crate::units::LengthUnit;

/// The sizes that tables have.
pub(super) const PERCENTS: [f64; 3] = [20.0, 50.0, 80.0];

/// What of sizes stands against a reference.
const SHIFTS: [f64; 2] = [50.0, 80.0];

/// What its sizes are: beside them lie those of a flight's psd.csv, which are of fitted functions.
const AS_MEASURED: &str = "as measured, of all photos together";

/// A line a flight. Numbers read back to the same f64; empty where there is none.
///
/// # Errors
/// Where memory runs out.
pub fn season_csv(report: &SeasonReport<'_>) -> Result<String, csv::Error> {
    let unit = report.unit.symbol();
    let mut heads: Vec<String> = ["blast", "date", "state", "photos"]
        .map(str::to_owned)
        .into();
    let none = VerdictCounts::default();
    let verdicts = none.counts().map(|(verdict, _)| verdict);
    heads.extend(verdicts.map(|verdict| verdict.as_str().replace(' ', "_")));
    for percent in PERCENTS {
        for part in ["", "_low", "_high"] {
            heads.push(format!("p{percent}{part}_{unit}"));
        }
    }
    heads.extend(SHIFTS.map(|percent| format!("p{percent}_off_reference_percent")));
    heads.extend(["sizes_are", "warnings", "error", "flight", "results"].map(str::to_owned));
    let mut records = vec![heads];
    for row in &report.rows {
        let findings = row.findings.as_ref();
        let number = |number: Option<f64>| number.map_or_else(String::new, |n| n.to_string());
        let date = row.date.map_or_else(String::new, |date| date.to_string());
        let photos = findings.map_or_else(String::new, |of| of.photos.to_string());
        let mut record = vec![row.blast.clone(), date, row.state().to_owned(), photos];
        match findings {
            Some(of) => record.extend(of.verdicts.counts().map(|(_, count)| count.to_string())),
            None => record.extend(none.counts().map(|_| String::new())),
        }
        for percent in PERCENTS {
            let size = row.size(percent);
            let parts = size.map_or([None; 3], |size| [size.size, size.low, size.high]);
            record.extend(parts.map(number));
        }
        record.extend(SHIFTS.map(|percent| number(shift(row, percent))));
        let warnings = findings.map_or_else(String::new, |of| of.warnings.len().to_string());
        let error = row.error.clone().unwrap_or_default();
        let mut sizes = PERCENTS.iter().map(|percent| row.size(*percent));
        let sizes_are = match sizes.any(|size| size.is_some()) {
            true => AS_MEASURED.to_owned(),
            false => String::new(),
        };
        let (flight, results) = (row.flight.clone(), row.results.clone());
        record.extend([sizes_are, warnings, error, flight, results]);
        records.push(record);
    }
    csv_of(records)
}

pub(super) fn shift(row: &SeasonRow, percent: f64) -> Option<f64> {
    let shifts = row.findings.iter().flat_map(|findings| &findings.shifts);
    let mut shifts = shifts.filter(|shift| shift.percent == percent);
    shifts.next().map(|shift| shift.off_percent)
}

/// A flight as an object for machines.
#[derive(Serialize)]
struct Line<'a> {
    blast: &'a str,
    date: Option<String>,
    state: &'static str,
    unit: &'static str,
    photos: Option<usize>,
    verdicts: Option<VerdictCounts>,
    sizes: &'a [FoundSize],
    off_reference: &'a [SizeShift],
    warnings: &'a [String],
    error: Option<&'a str>,
    flight: &'a str,
    results: &'a str,
}

/// A flight as one line of JSON, with its end.
///
/// # Errors
/// Where memory runs out.
pub fn season_json_line(row: &SeasonRow, unit: LengthUnit) -> serde_json::Result<String> {
    let findings = row.findings.as_ref();
    let line = Line {
        blast: &row.blast,
        date: row.date.map(|date| date.to_string()),
        state: row.state(),
        unit: unit.symbol(),
        photos: findings.map(|of| of.photos),
        verdicts: findings.map(|of| of.verdicts),
        sizes: findings.map_or(&[], |of| &of.sizes),
        off_reference: findings.map_or(&[], |of| &of.shifts),
        warnings: findings.map_or(&[], |of| &of.warnings),
        error: row.error.as_deref(),
        flight: &row.flight,
        results: &row.results,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}

/// A line a flight: see [`season_json_line`].
///
/// # Errors
/// Where memory runs out.
pub fn season_json_lines(report: &SeasonReport<'_>) -> serde_json::Result<String> {
    let lines = report.rows.iter();
    lines
        .map(|row| season_json_line(row, report.unit))
        .collect()
}

/// A size as people read it; `None` where there is none.
pub fn size_in_words(size: Option<FoundSize>) -> Option<String> {
    let FoundSize {
        size, low, high, ..
    } = size?;
    Some(size_between(size?, [low, high], ""))
}

/// A size with the ends of its interval, where they lie within what was measured, and the unit behind them.
pub(crate) fn size_between(size: f64, [low, high]: [Option<f64>; 2], unit: &str) -> String {
    let alone = || significant_digits(size, 2);
    match (low, high) {
        (Some(low), Some(high)) => format!("{}{unit}", within_interval(size, low, high)),
        (None, Some(_)) => format!("{}{unit}, may be less", alone()),
        // Too much of what is coarse is cut by the photos' edges.
        (Some(_), None) => format!("{}{unit}, may be much more", alone()),
        (None, None) => format!("{}{unit}, may be less or much more", alone()),
    }
}

/// A line a flight, for people.
pub fn season_table(report: &SeasonReport<'_>) -> String {
    let unit = report.unit.symbol();
    let heads = ["blast", "date", "state", "photos", "verdicts", "P50", "P80"];
    let mut table: Vec<[String; 7]> = vec![heads.map(|head| match head.starts_with('P') {
        true => format!("{head} {unit}"),
        false => head.to_owned(),
    })];
    for row in &report.rows {
        let dash = || "-".to_owned();
        let findings = row.findings.as_ref();
        let size = |percent| size_in_words(row.size(percent)).unwrap_or_else(dash);
        table.push([
            row.blast.clone(),
            row.date.map_or_else(dash, |date| date.to_string()),
            row.state().to_owned(),
            findings.map_or_else(dash, |of| of.photos.to_string()),
            findings.map_or_else(dash, |of| of.verdicts.in_words()),
            size(50.0),
            size(80.0),
        ]);
    }
    let width = |column: usize| {
        let texts = table.iter().map(|row| row[column].chars().count());
        texts.max().unwrap_or(0)
    };
    let widths: [usize; 7] = std::array::from_fn(width);
    let mut text = String::new();
    for row in &table {
        let cells = row.iter().zip(widths);
        let line: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        text += line.join("  ").trim_end();
        text.push('\n');
    }
    text
}
