//! Scales as a table for people.

use std::fmt::Write;

use super::scale_report::ScaleReport;
use crate::scale::ImageKind;

/// The report as aligned text: six significant digits, notes below.
pub fn scales_table(report: &ScaleReport) -> String {
    let image = match report.image {
        ImageKind::Undistorted => "undistorted images",
        ImageKind::AsShot => "photos as shot",
    };
    let mut text = format!(
        "{}: scales of the {image} in pixels per {}\n\n",
        report.flight, report.unit
    );
    let head = [
        "photo", "size", "top", "bottom", "left", "right", "corners", "",
    ];
    let mut rows = vec![head.map(str::to_owned)];
    for line in &report.lines {
        let number = |scale: Option<f64>| scale.map_or_else(|| "-".to_owned(), six_digits);
        rows.push([
            line.photo.clone(),
            format!("{} x {}", line.width, line.height),
            number(line.scale.top),
            number(line.scale.bottom),
            number(line.scale.left),
            number(line.scale.right),
            format!("{} of 4", line.corners_on_surface),
            if line.notes.is_empty() {
                ""
            } else {
                "see below"
            }
            .to_owned(),
        ]);
    }
    let widths: Vec<usize> = (0..head.len())
        .map(|column| {
            let cells = rows.iter().map(|row| row[column].chars().count());
            cells.max().unwrap_or(0)
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
    let noted: Vec<_> = report
        .lines
        .iter()
        .filter(|line| !line.notes.is_empty())
        .collect();
    if !noted.is_empty() {
        text.push('\n');
    }
    for line in noted {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}: {}", line.photo, line.notes.join("; "));
    }
    text
}

/// A positive number with six significant digits.
fn six_digits(number: f64) -> String {
    let before = number.abs().log10().floor() as i32 + 1;
    if !(-3..=6).contains(&before) {
        return format!("{number:.5e}");
    }
    format!("{number:.*}", usize::try_from(6 - before).unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        assert_eq!(six_digits(25.612_345_6), "25.6123");
        assert_eq!(six_digits(0.001_234_567_8), "0.00123457");
        assert_eq!(six_digits(123_456.7), "123457");
        assert_eq!(six_digits(1.0), "1.00000");
        assert_eq!(six_digits(1e9), "1.00000e9");
    }
}
