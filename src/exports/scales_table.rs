//! Scales as a table for people. Its columns are those of `photo_columns.rs`.

use std::fmt::Write;

use super::photo_columns::PHOTO_COLUMNS;
use super::scale_report::ScaleReport;
use crate::flight::Doubt;
use crate::scale::{ImageKind, ScalePair};

/// The report as aligned text: six significant digits, notes below.
pub fn scales_table(report: &ScaleReport<'_>) -> String {
    let image = match report.image() {
        ImageKind::Undistorted => "undistorted images",
        ImageKind::AsShot => "photos as shot",
    };
    let mut text = format!(
        "{}: scales of the {image} in pixels per {}\n",
        report.flight(),
        report.unit()
    );
    if !report.unit_known() {
        let _ = writeln!(
            text,
            "{} (the numbers are as if that unit were {})",
            Doubt::UnitUnknown,
            report.world_unit()
        );
    }
    text.push('\n');
    let columns = || PHOTO_COLUMNS.iter().filter(|column| column.table.is_some());
    let head = columns().filter_map(|column| column.table.map(str::to_owned));
    let mut rows: Vec<Vec<String>> = vec![head.collect()];
    for line in report.lines() {
        rows.push(columns().map(|column| column.table_value(&line)).collect());
    }
    let widths: Vec<usize> = (0..columns().count())
        .map(|column| {
            let cells = rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        })
        .collect();
    for row in &rows {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let gap = " ".repeat(width - cell.chars().count());
            // Names to the left, numbers to the right.
            if column == 0 || column + 1 == row.len() {
                line += &format!("{cell}{gap}  ");
            } else {
                line += &format!("{gap}{cell}  ");
            }
        }
        text += line.trim_end();
        text.push('\n');
    }
    if report.lines().any(|line| line.interval_percent().is_some()) {
        let what = match report.lines().next().map(|line| line.photo.pair) {
            Some(ScalePair::Corners) => "the corners' scales are that go",
            Some(ScalePair::Fitted) | None => "the line is that goes",
        };
        let _ = writeln!(
            text,
            "\n95 % ±: how sure {what} to Split-Desktop (the farther end of the interval); off line: how far single pixels are from it"
        );
        if let Some(shared) = report.shared() {
            let _ = writeln!(text, "{shared}");
        }
        if let Some(not_counted) = report.not_counted() {
            let _ = writeln!(
                text,
                "not counted in it, because nobody states how sure it is: {not_counted} ([uncertainty] in flight.toml, or the settings in the window)"
            );
        }
    } else if report.unit_known() && has_none(report) {
        text.push_str(
            "\nhow sure these scales are is not known: nobody states it, and the surface does not show it (a mesh whose faces are \
             not joined, or few points)\n",
        );
    }
    let below = report.reasons();
    if !below.is_empty() {
        text.push('\n');
    }
    for noted in below {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}: {}", noted.whose, noted.notes);
    }
    if let Some(advice) = report.advice() {
        let _ = write!(text, "\n{advice}\n");
    }
    text
}

/// Whether there are scales, and of none anything is known of how sure it is.
fn has_none(report: &ScaleReport<'_>) -> bool {
    let mut scales = report
        .lines()
        .filter(|line| line.pair().iter().any(Option::is_some))
        .peekable();
    scales.peek().is_some() && scales.all(|line| line.uncertainty().is_none())
}
