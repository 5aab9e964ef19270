//! Size distributions as a table: what Split-Desktop's results, a sieve's protocol or a spreadsheet
//! give. There is no standard; this is what is read.
//!
//! Layouts, told by the names of the columns (case, blanks and underscores do not matter):
//!
//! ```text
//! size_mm,percent_passing                one line a point; columns method, trial, photo and
//! 20,35.5                                weight (area, mass) are optional
//!
//! Size (mm);sieve;point cloud/1/a.jpg    one column a curve, called method/trial/photo;
//! 20;35,5;                               a cell may be empty; beside sizes the bare word for a
//!                                        sieve is a method ("Siebgröße (mm)" and "Sieb")
//!
//! photo,10 mm,20 mm,40 mm                one line a curve, a column each size
//! a.jpg,12,35.5,100                      (or "Sieve (mm),10,20,40" over "sieve A,12,35.5,100")
//!
//! label,D10,D50,D90                      one line a curve, a column each percent passing: D, P, x, F
//! a.jpg,9,26,38                          or k; columns of one set end alike (D50_old is another
//!                                        set), and those that end in psi or phi are logarithms;
//!                                        d(0.1) is of shares, "10 % passing (cm)" is one, too
//! ```
//!
//! - Percent passing is cumulative; percents of classes are refused. In the place of the percent passing may stand what
//!   stays on the sieves, a laboratory's protocol (`retained`). Where no
//!   percent of the table is above 1 and the largest is above 0.5, they are shares of 1.
//! - The unit of sizes stands in the name of their column or below it, or behind each size or in a column of its own; else the
//!   user states it; else a line above the names does; else it is mm. What may be a unit and is not known, or not said to be theirs,
//!   is asked about. Micrometres are read into mm. Sizes may be called by ASTM E11's names of
//!   sieves ("No. 4", "3/8 in."); where one is, "2 in." is the sieve of 50 mm too. A fraction without a unit ("3/8") is such a name,
//!   but where another unit is stated (`names_of_sizes` says where): there it is of that.
//! - Mended, and said: decimal commas; thousands that stand apart; passing up to 100.05 % and falls of up to 0.05 %, which rounding
//!   explains; lines of a title above the names; a line twice; a size of 0 that nothing passes; the pan under the sieves.
//! - For the text itself see [`Table`].

mod curves;
mod label_columns;
mod layout;
mod names;
mod names_of_sizes;
mod percentile_column;
mod point_weights;
mod raw;
mod read;
mod retained;
mod size_text;
mod size_unit;
#[cfg(test)]
mod tests;
mod unit_above;
mod units_beside;
mod vocabulary;

use std::path::Path;

use layout::Layout;

pub use curves::SizesRead;
pub use point_weights::{PointWeights, read_point_weights};

use crate::fault::Fault;
use crate::files::FileError;
use crate::fragmentation::{DistributionSet, Weighting};
use crate::tables::table::{Table, read_bounded};
use crate::units::LengthUnit;

/// How many lines may stand above the names of the columns.
const MOST_TITLES: usize = 20;

/// Within how many bytes the names are looked for.
const START: usize = 16 << 10;

/// Which columns hold what. What is not named is found by its name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DistributionColumns {
    /// Sizes. Named with `passing` the table has one line a point.
    pub size: Option<String>,
    /// Cumulative percent passing.
    pub passing: Option<String>,
    /// How it was measured.
    pub method: Option<String>,
    /// Which repetition.
    pub trial: Option<String>,
    /// Which photo.
    pub photo: Option<String>,
    /// Area or mass that the distribution stands for.
    pub weight: Option<String>,
    /// The unit of sizes, where the table does not state it.
    pub unit: Option<LengthUnit>,
    /// What curves are to be merged by: of columns of areas and of masses that one is the weight.
    pub merging: Weighting,
    /// What each point of a curve counts by, which is read elsewhere ([`read_point_weights`]).
    pub point_weight: Option<String>,
}

/// Whether a text, or the beginning of one, is such a table without a doubt. What may as well be a list
/// of points or of places is not, nor is a table whose columns only the user can tell.
pub(crate) fn is_table(start: &str, whole: bool) -> bool {
    let complete = match whole {
        true => Some(start),
        false => start.rfind('\n').and_then(|end| start.get(..end)),
    };
    complete.is_some_and(|text| {
        matches!(table_of(text), Ok(table) if Layout::is_sure(&table))
            || below_titles(text, &DistributionColumns::default()).is_some()
    })
}

/// Whether a table holds sizes with what passes or stays, beyond doubt. Columns that are called by sizes or percentiles ("20 m",
/// "F1") may as well be flights.
pub(crate) fn holds_passing(table: &Table) -> bool {
    let layout = Layout::of(table, &DistributionColumns::default());
    let is_by_size = matches!(
        layout,
        Ok(Layout::Long { .. } | Layout::Retained { .. } | Layout::Wide { .. })
    );
    is_by_size && Layout::is_sure(table)
}

/// The table of a text, with its units in the names of its columns or behind its sizes.
fn table_of(text: &str) -> Result<Table, Fault> {
    Table::read(text).map(units_beside::in_their_places)
}

/// The fault of such a table where a flight is needed.
pub fn no_flight_but_sizes() -> Fault {
    Fault::new(
        "it holds size distributions, not a flight",
        "open it among the size distributions, or give it to 'fragscale psd'",
    )
}

/// What is said of a table where nobody can name its columns or units by an option of the command: without those.
pub fn without_options(said: &str) -> String {
    let said = said.replace(", or by --size-unit", "");
    let mut text = said.as_str();
    let mut kept = String::new();
    while let Some(open) = text.find(" (") {
        let (before, rest) = text.split_at(open);
        let close = rest.find(')').map_or(rest.len(), |close| close + 1);
        kept.push_str(before);
        let (inside, after) = rest.split_at(close);
        if !inside.contains("--") {
            kept.push_str(inside);
        }
        text = after;
    }
    kept + text
}

/// Reads size distributions from the text of a table, with what was mended or passed over.
///
/// # Errors
/// With the line and the remedy.
pub fn size_distributions(
    text: &str,
    columns: &DistributionColumns,
) -> Result<(DistributionSet, Vec<String>), Fault> {
    sizes_of(text, columns).map(|read| (read.set, read.said))
}

fn sizes_of(text: &str, columns: &DistributionColumns) -> Result<SizesRead, Fault> {
    let whole = table_of(text);
    let read = match &whole {
        Ok(table) => read::read(table, text, columns),
        Err(fault) => Err(fault.clone()),
    };
    // What is wrong with such a table, or where none is below, is said of the whole.
    if read.is_ok() || whole.is_ok_and(|table| Layout::is_sure(&table)) {
        return read;
    }
    let Some((table, lines)) = below_titles(text, columns) else {
        return read;
    };
    let mut found = read::read(&table, text, columns)?;
    let plural = if lines == 1 { "line" } else { "lines" };
    let titles = format!("{lines} {plural} above the names of the columns are passed over");
    found.said.insert(0, titles);
    Ok(found)
}

/// The table below the title, the date, the name of the laboratory: from the first line on whose names say beyond doubt what the
/// columns are, with how many lines are above it. `None` where there is none below the first [`MOST_TITLES`] lines.
fn below_titles(text: &str, columns: &DistributionColumns) -> Option<(Table, usize)> {
    // What the names mean is seen from the first lines below them.
    let most = text.floor_char_boundary(START);
    let start = match text.get(..most).filter(|_| most < text.len()) {
        Some(start) => start.rfind('\n').and_then(|end| start.get(..end))?,
        None => text,
    };
    let found = |text: &str| {
        let table = table_of(text).ok()?;
        let is_named = || columns.size.is_some() && Layout::of(&table, columns).is_ok();
        (Layout::is_sure(&table) || is_named()).then_some(table)
    };
    let titles = (1..=MOST_TITLES).find(|&lines| found(&without_first(start, lines)).is_some())?;
    let above = text.lines().take(titles);
    let above = above.filter(|line| !line.trim().is_empty()).count();
    Some((found(&without_first(text, titles))?, above))
}

/// A text whose first lines are empty: those behind them keep their numbers.
fn without_first(text: &str, lines: usize) -> String {
    let ends = text.match_indices('\n').nth(lines.saturating_sub(1));
    let rest = ends.and_then(|(at, _)| text.get(at + 1..));
    "\n".repeat(lines) + rest.unwrap_or_default()
}

/// Reads size distributions from a file; see [`size_distributions`].
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_size_distributions(
    path: &Path,
    columns: &DistributionColumns,
) -> Result<(DistributionSet, Vec<String>), FileError> {
    read_sizes(path, columns).map(|read| (read.set, read.said))
}

/// The same, with what one of the table's lengths is in the set's unit.
///
/// # Errors
/// With the file, the line and the remedy.
pub fn read_sizes(path: &Path, columns: &DistributionColumns) -> Result<SizesRead, FileError> {
    let (text, how) = read_bounded(path)?;
    let mut read = sizes_of(&text, columns).map_err(|fault| FileError::new(path, fault))?;
    read.said.extend(how.map(str::to_owned));
    Ok(read)
}
