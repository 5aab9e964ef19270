//! Tables, lists and paragraphs of a page; the only place where a report's words become markup.

use std::fmt::Write;

use crate::markup::escaped;

/// A cell that says nothing.
pub(crate) const NONE: &str = "\u{2013}";

/// A cell of a table.
pub(crate) enum Cell {
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
pub(crate) fn table(head: &[String], rows: Vec<Vec<Cell>>) -> String {
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

pub(crate) fn heading(level: u8, text: &str) -> String {
    format!("<h{level}>{}</h{level}>\n", escaped(text))
}

pub(crate) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// Notes that are to be seen; nothing without any.
pub(crate) fn notes<'a>(notes: impl IntoIterator<Item = &'a String>) -> String {
    let items = notes
        .into_iter()
        .map(|note| format!("<li>{}</li>\n", escaped(note)));
    let items: String = items.collect();
    match items.is_empty() {
        true => items,
        false => format!("<ul class=\"notes\">\n{items}</ul>\n"),
    }
}

/// Names and what is said of them, in two columns of the page.
pub(crate) fn pairs(pairs: &[(String, String)]) -> String {
    let rows = pairs.iter().map(|(name, said)| {
        let (name, said) = (escaped(name), escaped(said));
        format!("<div><dt>{name}</dt><dd>{said}</dd></div>\n")
    });
    format!("<dl class=\"pairs\">\n{}</dl>\n", rows.collect::<String>())
}

/// Sentences with a box before each, to tick on paper.
pub(crate) fn boxes(sentences: &[String]) -> String {
    let items = sentences
        .iter()
        .map(|sentence| format!("<li>{}</li>\n", escaped(sentence)));
    format!("<ul class=\"boxes\">\n{}</ul>\n", items.collect::<String>())
}

/// Names with a line behind each, to write on.
pub(crate) fn blanks(names: &[&str]) -> String {
    let blanks = names
        .iter()
        .map(|name| format!("<span>{}</span>", escaped(name)));
    format!("<p class=\"blanks\">{}</p>\n", blanks.collect::<String>())
}

/// Names for `table`.
pub(crate) fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// With a decimal; `NONE` where there is none.
pub(crate) fn percent(value: Option<f64>) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{value:.1}").replace('-', "\u{2212}"),
        _ => NONE.to_owned(),
    }
}

/// With its sign.
pub(crate) fn signed(value: Option<f64>) -> String {
    match value {
        // What rounds to nothing has no sign.
        Some(value) if value.abs() < 0.05 => "0.0".to_owned(),
        Some(value) if value.is_finite() => format!("{value:+.1}").replace('-', "\u{2212}"),
        _ => NONE.to_owned(),
    }
}

/// Whether something lies inside of its limits.
pub(crate) fn inside(inside: Option<bool>) -> Cell {
    match inside {
        Some(true) => Cell::Judged(true, "inside"),
        Some(false) => Cell::Judged(false, "outside"),
        None => NONE.into(),
    }
}
