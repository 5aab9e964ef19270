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
mod encoding;
mod records;

use std::borrow::Cow;
use std::path::Path;

use csv::StringRecord;

use self::cell_number::{last_digit, number_text, other_sign, without_separators};
use self::encoding::decoded;
use self::records::{blank_records, counted_lines, separated_records, separator};
use crate::fault::Fault;
use crate::files::{FileError, open_file};
use crate::text::fields::shown;

pub use self::cell_number::may_be_thousands;
pub(crate) use self::cell_number::{number_and_unit, split_number};

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

/// What the numbers of a column show of its points and commas.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct ColumnSigns {
    /// As of the table, of this column alone.
    decimal_comma: bool,
    decimal_point: bool,
    /// Whether there are whole numbers of 100 or more.
    hundreds: bool,
}

impl ColumnSigns {
    /// Looks for a comma or point that can only be decimal, and for hundreds.
    fn look_at(&mut self, cell: &str) {
        let (number, _) = number_text(cell);
        self.hundreds |= number.parse::<u32>().is_ok_and(|number| number >= 100);
        let signs = [',', '.'].map(|sign| number.matches(sign).count());
        if signs[0] + signs[1] == 1 && !may_be_thousands(&number) {
            self.decimal_comma |= signs[0] == 1;
            self.decimal_point |= signs[1] == 1;
        }
        // Behind thousands: "1.250,0".
        if signs[0] > 0
            && signs[1] > 0
            && let Some((separator, _)) = without_separators(&number)
        {
            let decimal = other_sign(separator);
            self.decimal_comma |= decimal == ',';
            self.decimal_point |= decimal == '.';
        }
    }

    /// Whether its own numbers say that this sign parts thousands: another column may be written otherwise.
    fn are_parted_by(self, separator: char) -> bool {
        let is_other_decimal = match separator {
            '.' => self.decimal_comma,
            _ => self.decimal_point,
        };
        is_other_decimal || self.hundreds
    }
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

/// What was mended in numbers, to be said.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NumberRepairs {
    decimal_commas: usize,
    first_line: u64,
    /// How many had thousands that stand apart; of the first the line, and as what it was read.
    apart: usize,
    first_apart: (u64, String),
    /// The same of those whose thousands were parted by points or commas.
    parted: usize,
    first_parted: (u64, String),
}

impl NumberRepairs {
    /// One sentence for each kind of repair.
    pub fn warnings(&self) -> Vec<String> {
        let numbers = |count: usize| if count == 1 { "number" } else { "numbers" };
        let commas = (self.decimal_commas > 0).then(|| {
            format!(
                "decimal commas are read as decimal points ({} {}, first on line {})",
                self.decimal_commas,
                numbers(self.decimal_commas),
                self.first_line
            )
        });
        let apart = (self.apart > 0).then(|| {
            let (line, how) = &self.first_apart;
            format!(
                "thousands that stand apart are read as one number: {how} ({} {}, first on line {line})",
                self.apart,
                numbers(self.apart)
            )
        });
        let parted = (self.parted > 0).then(|| {
            let (line, how) = &self.first_parted;
            format!(
                "points or commas between thousands are left out, for the table's decimal sign is the other one: {how} ({} {}, \
                 first on line {line})",
                self.parted,
                numbers(self.parted)
            )
        });
        commas.into_iter().chain(apart).chain(parted).collect()
    }

    /// Whether some number had a decimal comma.
    pub(crate) fn has_decimal_commas(&self) -> bool {
        self.decimal_commas > 0
    }

    /// Notes a decimal comma on this line.
    pub(crate) fn decimal_comma(&mut self, line: u64) {
        if self.decimal_commas == 0 {
            self.first_line = line;
        }
        self.decimal_commas += 1;
    }

    /// Notes a cell, or the name of a column, on this line whose thousands stand apart, and what was read.
    pub(crate) fn thousands_apart(&mut self, line: u64, cell: &str, number: f64) {
        if self.apart == 0 {
            self.first_apart = (line, format!("'{}' as {number}", shown(cell)));
        }
        self.apart += 1;
    }

    /// Notes a cell on this line whose thousands were parted by points or commas, and what was read.
    fn thousands_parted(&mut self, line: u64, cell: &str, number: f64) {
        if self.parted == 0 {
            self.first_parted = (line, format!("'{}' as {number}", shown(cell)));
        }
        self.parted += 1;
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

    /// The finite number in a column; `None` where the cell is empty. A decimal comma is read as a
    /// point, and noted in `repairs`.
    ///
    /// # Errors
    /// With line, column and value, where it is no number, or one whose comma or point may as well
    /// separate thousands.
    pub fn number(
        &self,
        row: &Row,
        column: usize,
        repairs: &mut NumberRepairs,
    ) -> Result<Option<f64>, Fault> {
        match self.number_and_rest(row, column, repairs)? {
            Some((_, rest)) if !rest.is_empty() => Err(self.no_number(row, column)),
            found => Ok(found.map(|(number, _)| number)),
        }
    }

    /// As [`Table::number`], with what follows the number in its cell: a unit or a percent sign.
    ///
    /// # Errors
    /// As [`Table::number`].
    pub fn number_and_rest<'a>(
        &self,
        row: &'a Row,
        column: usize,
        repairs: &mut NumberRepairs,
    ) -> Result<Option<(f64, &'a str)>, Fault> {
        let cell = row.cell(column);
        if cell.is_empty() {
            return Ok(None);
        }
        let (number, rest) = number_text(cell);
        let stands_apart = matches!(number, Cow::Owned(_));
        let number = &*number;
        let fault = |what: &str, remedy: &str| {
            let name = self.name(column);
            let what = format!("column {name}: '{}' {what}", shown(cell));
            Err(Fault::at(row.line, what, remedy))
        };
        if let Some(whole) = self.without_thousands(number, column) {
            let parsed = whole.replace(',', ".").parse::<f64>().ok();
            let Some(parsed) = parsed.filter(|number| number.is_finite()) else {
                return Err(self.no_number(row, column));
            };
            if whole.contains(',') {
                repairs.decimal_comma(row.line);
            }
            repairs.thousands_parted(row.line, cell, parsed);
            return Ok(Some((parsed, rest.trim_start())));
        }
        let has_hundreds = (self.columns.get(column)).is_some_and(|signs| signs.hundreds);
        let plain = "write decimals with a point, and nothing between thousands";
        let ambiguous = "may have a decimal sign or a separator of thousands";
        let parsed = match (number.matches(',').count(), number.matches('.').count()) {
            (0, 1)
                if may_be_thousands(number)
                    && (self.decimal_comma || self.points_may_part && has_hundreds) =>
            {
                return fault(ambiguous, plain);
            }
            (0, 0 | 1) => number.parse::<f64>(),
            (1, 0) if may_be_thousands(number) && (self.decimal_point || !self.decimal_comma) => {
                return fault(ambiguous, plain);
            }
            (1, 0) => {
                repairs.decimal_comma(row.line);
                number.replace(',', ".").parse::<f64>()
            }
            _ => return fault("has separators of thousands", plain),
        };
        match parsed {
            Ok(number) if number.is_finite() => {
                if stands_apart {
                    repairs.thousands_apart(row.line, cell, number);
                }
                Ok(Some((number, rest.trim_start())))
            }
            Ok(_) => fault("is not finite", "correct it"),
            Err(_) => Err(self.no_number(row, column)),
        }
    }

    /// A number without what parts its thousands, where the table says that the other sign is the decimal one, and this one never is,
    /// and the number itself or its column says so, too: metres with points may stand beside percents with commas.
    fn without_thousands(&self, number: &str, column: usize) -> Option<String> {
        let (separator, whole) = without_separators(number)?;
        let says_so = || {
            let signs = self.columns.get(column);
            signs.is_some_and(|signs| signs.are_parted_by(separator))
        };
        let is_parted = self.is_not_decimal(separator) && (!may_be_thousands(number) || says_so());
        is_parted.then_some(whole)
    }

    /// Whether the cells show that the other sign is the decimal one, and this one never is.
    fn is_not_decimal(&self, sign: char) -> bool {
        match sign {
            '.' => self.decimal_comma && !self.decimal_point,
            _ => self.decimal_point && !self.decimal_comma,
        }
    }

    /// Refuses numbers in the names of these columns that all may have thousands, parted by the sign that in the cells is not the
    /// decimal one: read as decimals they were a thousandth.
    ///
    /// # Errors
    /// With the first of them.
    pub(crate) fn check_numbers_in_names(&self, columns: &[usize]) -> Result<(), Fault> {
        let others = ['.', ','].into_iter();
        for sign in others.filter(|sign| self.is_not_decimal(*sign)) {
            let names = columns.iter().filter_map(|column| self.header.get(*column));
            let mut with = names.filter(|name| number_text(name.trim()).0.contains(sign));
            let Some(first) = with.next() else { continue };
            let is_doubtful = |name: &String| may_be_thousands(&number_text(name.trim()).0);
            if is_doubtful(first) && with.all(is_doubtful) {
                return Err(Fault::at(
                    self.header_line,
                    format!(
                        "column '{}' may have a decimal sign or a separator of thousands",
                        shown(first)
                    ),
                    "write nothing between thousands, and decimals as the cells do",
                ));
            }
        }
        Ok(())
    }

    /// What one of the last digit shown of a cell's number is: 0.1 of "12.3", 1 of "58". `None` where it is no plain number.
    pub(crate) fn last_digit(&self, row: &Row, column: usize) -> Option<f64> {
        let cell = row.cell(column);
        let (number, _) = number_text(cell);
        match self.without_thousands(&number, column) {
            Some(whole) => last_digit(&whole),
            None => last_digit(cell),
        }
    }

    /// The fault of a cell that is no number.
    pub fn no_number(&self, row: &Row, column: usize) -> Fault {
        let cell = shown(row.cell(column));
        let what = format!("column {}: '{cell}' is not a number", self.name(column));
        Fault::at(row.line, what, format!("correct it{OR_LEAVE_OUT}"))
    }

    /// What a column is called in messages.
    pub fn name(&self, column: usize) -> String {
        match self.header.get(column) {
            Some(name) if !name.is_empty() => shown(name),
            _ => format!("number {}", column + 1),
        }
    }

    /// Looks for numbers whose comma or point can only be decimal.
    fn look_for_decimal_signs(&mut self) {
        self.columns = vec![ColumnSigns::default(); self.header.len()];
        for row in &self.rows {
            for (signs, cell) in self.columns.iter_mut().zip(&row.cells) {
                signs.look_at(cell);
            }
        }
        self.decimal_comma = self.columns.iter().any(|signs| signs.decimal_comma);
        self.decimal_point = self.columns.iter().any(|signs| signs.decimal_point);
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
