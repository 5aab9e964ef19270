//! The numbers in the cells of a table, by the signs that all of them show.

use std::borrow::Cow;

use super::cell_number::{last_digit, may_be_thousands, number_text, without_separators};
use super::column_signs::ColumnSigns;
use super::{NumberRepairs, OR_LEAVE_OUT, Row, Table};
use crate::fault::Fault;
use crate::text::fields::shown;

impl Table {
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

    /// Looks for numbers whose comma or point can only be decimal.
    pub(super) fn look_for_decimal_signs(&mut self) {
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
