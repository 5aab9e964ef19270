//! A table of text with a header line: what spreadsheets save and what people paste.
//!
//! - The separator is a tab, a semicolon or a comma: the first of these that both the header and the
//!   line behind it hold. Runs of blanks only where there is none. Fields may be quoted.
//! - The text is UTF-8, UTF-16, or Windows-1252 where it can be neither.
//! - A byte order mark, empty lines and lines that begin with # are passed over (but not "#4": a digit
//!   right behind it makes it a sieve's name; nor the line of names whose first column is called #).
//! - A line break inside of quotes is a blank.
//! - A line may end early: what is missing is empty. What stands beyond the header's columns is a
//!   fault, because a decimal comma may have shifted it there.
//! - Numbers may have a decimal comma where the table shows that it is one and not a thousands
//!   separator ([`Table::number`]). Thousands may stand apart, or be parted by points or commas where the
//!   table shows that the other sign is the decimal one, and so does their column or the number itself.

mod cell_number;
mod column_signs;
mod encoding;
mod number_repairs;
mod numbers;
mod records;

use std::path::Path;

use csv::StringRecord;

use self::column_signs::ColumnSigns;
use self::encoding::decoded;
use self::records::{blank_records, counted_lines, separated_records, separator};
use crate::fault::Fault;
use crate::files::{FileError, open_file};
use crate::text::fields::shown;

pub use self::cell_number::may_be_thousands;
pub(crate) use self::cell_number::{number_and_unit, split_number};
pub use self::number_repairs::NumberRepairs;

/// Larger files are no tables that people made or looked at.
const LARGEST: usize = 16 << 20;

/// More columns than anyone measures.
const MOST_COLUMNS: usize = 10_000;

/// The end of remedies where a line can be done without.
pub(crate) const OR_LEAVE_OUT: &str = ", or leave the line out";

/// A table in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    header: Vec<String>,
    header_line: u64,
    rows: Vec<Row>,
    /// Whether some number is written with a comma, and some with a point, that can only be decimal: not one of thousands, or behind
    /// thousands that the other sign parts.
    decimal_comma: bool,
    decimal_point: bool,
    /// Whether a point may as well stand behind thousands, in a column with hundreds: between semicolons, where no point of the
    /// table is surely decimal.
    points_may_part: bool,
    /// One for each column of the header.
    columns: Vec<ColumnSigns>,
}

/// A line of a table, behind its header.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Where it stands, from 1.
    pub line: u64,
    cells: StringRecord,
}

impl Row {
    /// What stands in a column, without blanks at its ends; empty where the line ends before it.
    pub fn cell(&self, column: usize) -> &str {
        self.cells.get(column).unwrap_or_default()
    }

    /// How many of the columns the line has, from the first on.
    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// Where there is no header or no line behind it, where quotes do not end, where a line has more
    /// fields than the header, and where it is larger than any measured table.
    pub fn read(text: &str) -> Result<Self, Fault> {
        let table = Self::read_even_empty(text)?;
        if table.rows.is_empty() {
            let what = format!("it has no line below {}", table.columns_in_words());
            let remedy = "give the numbers below the names of the columns";
            return Err(Fault::at(table.header_line, what, remedy));
        }
        Ok(table)
    }

    /// As [`Table::read`], where it may have no line behind its header.
    pub(crate) fn read_even_empty(text: &str) -> Result<Self, Fault> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.len() > LARGEST {
            return Err(too_large());
        }
        if let Some(at) = text.find('\0') {
            let line = 1 + text.get(..at).unwrap_or_default().matches('\n').count() as u64;
            let what = "there is a byte 0: it is no text, or text in UTF-16";
            return Err(Fault::at(line, what, "save it as CSV in UTF-8"));
        }
        let text = counted_lines(text);
        let found = separator(&text);
        let semicolons = found == Some(';');
        let mut records = match found {
            Some(separator) => separated_records(&text, separator)?,
            None => blank_records(&text)?,
        }
        .into_iter();
        let Some(header) = records.next() else {
            let remedy = "give a line that names the columns, and the numbers below it";
            return Err(Fault::new("it is empty", remedy));
        };
        if header.cells.len() > MOST_COLUMNS {
            let what = format!("it has over {MOST_COLUMNS} columns");
            return Err(Fault::at(header.line, what, "check that it is a table"));
        }
        let rows: Vec<Row> = records.collect();
        for row in &rows {
            let mut extra = row.cells.iter().skip(header.cells.len());
            if let Some(extra) = extra.find(|cell| !cell.is_empty()) {
                let what = format!(
                    "it has {} fields for {} columns ('{}' is too many)",
                    row.cells.len(),
                    header.cells.len(),
                    shown(extra)
                );
                let remedy = "write decimal points, and quote what holds the separator";
                return Err(Fault::at(row.line, what, remedy));
            }
        }
        let mut table = Self {
            header: header.cells.iter().map(str::to_owned).collect(),
            header_line: header.line,
            rows,
            decimal_comma: false,
            decimal_point: false,
            points_may_part: false,
            columns: Vec::new(),
        };
        table.look_for_decimal_signs();
        table.points_may_part = semicolons && !table.decimal_point;
        Ok(table)
    }

    /// Reads a table from a file.
    ///
    /// # Errors
    /// As [`Table::read`], and where the file cannot be read or is no text.
    pub fn read_file(path: &Path) -> Result<Self, FileError> {
        let (text, _) = read_bounded(path)?;
        Self::read(&text).map_err(|fault| FileError::new(path, fault))
    }

    /// The names of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Where the header stands, from 1.
    pub fn header_line(&self) -> u64 {
        self.header_line
    }

    /// The lines behind the header, at least one.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The table whose names stand in two lines: its first line of numbers is the second of them.
    pub(crate) fn with_names_of_two_lines(mut self, names: Vec<String>) -> Self {
        self.header = names;
        self.rows.remove(0);
        self
    }

    /// The table with what `cell` makes of each of its cells.
    pub(crate) fn with_cells(mut self, cell: impl Fn(&Row, usize) -> String) -> Self {
        for row in &mut self.rows {
            let cells: StringRecord = (0..row.len()).map(|column| cell(row, column)).collect();
            row.cells = cells;
        }
        self
    }

    /// The table without one of its columns.
    pub(crate) fn without_column(mut self, column: usize) -> Self {
        self.header.remove(column);
        self.columns.remove(column);
        for row in &mut self.rows {
            let cells = row.cells.iter().enumerate();
            let kept = cells.filter(|(place, _)| *place != column);
            row.cells = kept.map(|(_, cell)| cell).collect();
        }
        self
    }

    /// The column that the user named: the name itself, else one that differs in case, blanks and
    /// punctuation only, else one that has brackets behind it.
    ///
    /// # Errors
    /// Where there is none or several; the columns that there are are named.
    pub fn column(&self, name: &str) -> Result<usize, Fault> {
        let exact = |column: &String| column.trim() == name.trim();
        let alike = |column: &String| !key(name).is_empty() && key(column) == key(name);
        let places = |is: &dyn Fn(&String) -> bool| -> Vec<usize> {
            let columns = self.header.iter().enumerate();
            columns.filter(|(_, c)| is(c)).map(|(i, _)| i).collect()
        };
        // "Sieve" for "Sieve (mm)", whose unit may stand in a line of its own.
        let without_unit = |column: &String| {
            let before = column.split_once(" (").map(|(before, _)| before);
            !key(name).is_empty() && before.is_some_and(|before| key(before) == key(name))
        };
        let mut found = places(&exact);
        if found.is_empty() {
            found = places(&alike);
        }
        if found.is_empty() {
            found = places(&without_unit);
        }
        match found[..] {
            [column] => Ok(column),
            [] => Err(Fault::at(
                self.header_line,
                format!("there is no column '{}'", shown(name)),
                format!("name one of {}", self.columns_in_words()),
            )),
            _ => Err(Fault::at(
                self.header_line,
                format!("{} columns are called '{}'", found.len(), shown(name)),
                "give each column a name of its own",
            )),
        }
    }

    /// The names of the columns in one phrase, cut where there are many.
    pub fn columns_in_words(&self) -> String {
        let mut names: Vec<String> = (self.header.iter())
            .take(12)
            .map(|name| format!("'{}'", shown(name)))
            .collect();
        match self.header.len().saturating_sub(names.len()) {
            0 => {}
            more => names.push(format!("{more} others")),
        }
        names.join(", ")
    }

    /// What a column is called in messages.
    pub fn name(&self, column: usize) -> String {
        match self.header.get(column) {
            Some(name) if !name.is_empty() => shown(name),
            _ => format!("number {}", column + 1),
        }
    }
}

/// A name in small letters and digits, without blanks and punctuation.
pub(crate) fn key(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

/// The whole text of a table's file, which is of a size that people measure, and what is said of how it was read.
///
/// # Errors
/// Where it cannot be read, is too large, or is no text.
pub(crate) fn read_bounded(path: &Path) -> Result<(String, Option<&'static str>), FileError> {
    use std::io::Read;
    let at = |fault| FileError::new(path, fault);
    let mut bytes = Vec::new();
    open_file(path)?
        .take(LARGEST as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(|e| {
            let what = format!("it cannot be read to its end ({e})");
            at(Fault::new(what, "check the disk"))
        })?;
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xd0\xcf\x11\xe0") {
        let what = "it is a spreadsheet's own format or an archive, not text";
        return Err(at(Fault::new(what, "save the sheet as CSV")));
    }
    if bytes.len() > LARGEST {
        return Err(at(too_large()));
    }
    decoded(&bytes).map_err(at)
}

fn too_large() -> Fault {
    let what = format!("it is larger than {} MB", LARGEST >> 20);
    Fault::new(what, "give the table alone")
}

#[cfg(test)]
mod tests;
