//! Tables and lists of the report; the only place where its words become markup.

use std::fmt::Write;

use crate::markup::escaped;
use crate::size_distributions::text_table::{significant, trimmed};

/// A cell that says nothing.
pub(super) const NONE: &str = "\u{2013}";

/// A cell of a table.
pub(super) enum Cell {
    Text(String),
    /// Whether something holds, coloured.
    Judged(bool, &'static str),
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self::Text(text.into())
    }
}

/// A table: the first column to the left, numbers to the right.
pub(super) fn table(head: &[String], rows: Vec<Vec<Cell>>) -> String {
    let mut html = String::from("<div class=\"wide\"><table>\n<thead><tr>");
    // Writing to a String cannot fail.
    for name in head {
        let _ = write!(html, "<th scope=\"col\">{}</th>", escaped(name));
    }
    html += "</tr></thead>\n<tbody>\n";
    for row in rows {
        html += "<tr>";
        for cell in row {
            let _ = match cell {
                Cell::Text(text) => write!(html, "<td>{}</td>", escaped(&text)),
                Cell::Judged(good, word) => {
                    let class = if good { "yes" } else { "no" };
                    write!(html, "<td class=\"{class}\">{}</td>", escaped(word))
                }
            };
        }
        html += "</tr>\n";
    }
    html + "</tbody>\n</table></div>\n"
}

pub(super) fn heading(level: u8, text: &str) -> String {
    format!("<h{level}>{}</h{level}>\n", escaped(text))
}

pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// Notes that are to be seen; nothing without any.
pub(super) fn notes<'a>(notes: impl IntoIterator<Item = &'a String>) -> String {
    let items = notes
        .into_iter()
        .map(|note| format!("<li>{}</li>\n", escaped(note)));
    let items: String = items.collect();
    match items.is_empty() {
        true => items,
        false => format!("<ul class=\"notes\">\n{items}</ul>\n"),
    }
}

/// Names for `table`.
pub(super) fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// A size as it was measured, without the noise of its conversion.
pub(super) fn measured(size: f64) -> String {
    trimmed(size, 6)
}

/// With four significant digits.
pub(super) fn number(value: f64) -> String {
    match value.is_finite() {
        true => significant(value, 4).replace('-', "\u{2212}"),
        false => NONE.to_owned(),
    }
}

/// With a decimal; `NONE` where there is none.
pub(super) fn percent(value: Option<f64>) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{value:.1}").replace('-', "\u{2212}"),
        _ => NONE.to_owned(),
    }
}

/// With its sign.
pub(super) fn signed(value: Option<f64>) -> String {
    match value {
        // What rounds to nothing has no sign.
        Some(value) if value.abs() < 0.05 => "0.0".to_owned(),
        Some(value) if value.is_finite() => format!("{value:+.1}").replace('-', "\u{2212}"),
        _ => NONE.to_owned(),
    }
}

/// Whether something lies inside of its limits.
pub(super) fn inside(inside: Option<bool>) -> Cell {
    match inside {
        Some(true) => Cell::Judged(true, "inside"),
        Some(false) => Cell::Judged(false, "outside"),
        None => NONE.into(),
    }
}
