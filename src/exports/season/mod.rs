//! A season of flights: a row of each, as CSV, JSON lines, a table for people, and a page with the trend of the
//! fragments' sizes over the blasts.
//!
//! ```text
//! row     what is known of a flight
//! tables  CSV, JSON lines, text
//! page    HTML
//! trend   P50 and P80 over the blasts, drawn
//! ```

mod page;
mod row;
mod tables;
#[cfg(test)]
mod tests;
mod trend;

pub use page::season_page;
pub use row::{FlightFindings, FoundSize, SeasonReport, SeasonRow, SizeShift, VerdictCounts};
pub(crate) use tables::size_between;
pub use tables::{
    season_csv, season_json_line, season_json_lines, season_table, size_in_words as size_text,
};
