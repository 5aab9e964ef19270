//! Reports as one HTML file without scripts, for a screen (light or dark) or A4 paper.
//!
//! ```text
//! table     tables, lists and paragraphs
//! page.css  what they look like
//! ```

mod table;

pub(crate) use self::table::{
    Cell, NONE, blanks, boxes, heading, inside, names, notes, pairs, paragraph, percent, signed,
    table,
};

use crate::files::HTML_MARK;
use crate::markup::escaped;

const STYLE: &str = include_str!("page.css");

/// A page under a heading; `window` is its title in a browser's tab, `body` is markup.
pub(crate) fn page(title: &str, window: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         {HTML_MARK}<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{}</h1>\n{body}\
         <p class=\"small\">fragscale {}</p>\n</body>\n</html>\n",
        escaped(window),
        escaped(title),
        env!("CARGO_PKG_VERSION"),
    )
}

/// A drawing in a page; `svg` is markup.
pub(crate) fn figure(svg: &str) -> String {
    format!("<figure>\n{svg}</figure>\n")
}

/// A drawing that is as large on paper as it says; `svg` is markup.
pub(crate) fn figure_to_scale(svg: &str) -> String {
    format!("<figure class=\"to-scale\">\n{svg}</figure>\n")
}
