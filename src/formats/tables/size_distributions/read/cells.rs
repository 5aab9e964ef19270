//! What a cell says: a size, a percent, or that it is not known.

use super::Reader;
use crate::fault::Fault;
use crate::tables::size_distributions::retained::{is_no_sieve, is_pan, is_result, is_total};
use crate::tables::size_distributions::size_text::{
    SizeText, fraction_of_inches, fraction_of_unit, sieve_mm,
};
use crate::tables::size_distributions::size_unit::SizeUnit;
use crate::tables::table::{OR_LEAVE_OUT, Row};
use crate::text::fields::shown;
use crate::units::LengthUnit;

/// A cell of sizes; where it is empty, the cell beside it that says why: "Pan" and "Total" stand under the names of sieves, in ASTM
/// C136's sheet.
pub(super) fn size_cell(row: &Row, column: usize) -> &str {
    let cell = row.cell(column);
    if !is_missing(cell) {
        return cell;
    }
    let cells = (0..row.len()).map(|column| row.cell(column));
    cells
        .into_iter()
        .find(|cell| is_no_sieve(cell))
        .unwrap_or(cell)
}

/// What stands where a number is not known.
pub(super) fn is_missing(cell: &str) -> bool {
    let cell = cell.to_lowercase();
    matches!(cell.as_str(), "" | "na" | "n/a" | "nan" | "-" | "–" | "—")
}

impl Reader<'_> {
    /// A size in a cell; `None` for a sieve's pan and a line of sums.
    pub(super) fn size(&mut self, row: &Row, column: usize) -> Result<Option<SizeText>, Fault> {
        let cell = size_cell(row, column);
        if is_pan(cell) {
            self.repairs.pan(row.line);
            return Ok(None);
        }
        if is_total(cell) {
            self.repairs.total(row.line);
            return Ok(None);
        }
        if is_result(cell) {
            self.repairs.result(row.line);
            return Ok(None);
        }
        if is_missing(cell) {
            let what = format!("column {} has no size", self.table.name(column));
            return Err(Fault::at(
                row.line,
                what,
                format!("fill it in{OR_LEAVE_OUT}"),
            ));
        }
        match fraction_of_unit(cell) {
            Some((number, unit @ Some(_))) => return Ok(Some(SizeText::of_number(number, unit))),
            Some((number, None)) if self.is_of_its_unit(column) => {
                self.repairs.fraction(row.line);
                return Ok(Some(SizeText::of_number(number, None)));
            }
            _ => {}
        }
        let sieve_mm = match self.holds_astm_numbers.get(column) {
            Some(true) if cell.starts_with(|c: char| c.is_ascii_digit()) => {
                sieve_mm(&format!("No. {cell}"))
            }
            _ => sieve_mm(cell),
        };
        if let (None, Some(inches)) = (sieve_mm, fraction_of_inches(cell)) {
            let number = Some((inches, Some(SizeUnit::plain(LengthUnit::Inch))));
            return Ok(Some(SizeText { number, sieve_mm }));
        }
        let number = self
            .table
            .number_and_rest(row, column, &mut self.repairs.numbers);
        let number = match number {
            // A name that is no number alone.
            Err(_) if sieve_mm.is_some() => None,
            Ok(Some((_, rest))) if sieve_mm.is_some() && SizeUnit::of(rest).is_none() => None,
            found => found?,
        };
        let number = match number {
            Some((_, ""))
                if sieve_mm.is_none() && self.holds_sieve_numbers.get(column) == Some(&true) =>
            {
                let what = format!("'{}' is the number of a sieve, no size", shown(cell));
                let remedy = format!(
                    "write 'No. {cell}' where it is one of ASTM E11, else its opening with a unit"
                );
                return Err(Fault::at(row.line, what, remedy));
            }
            Some((number, "")) => Some((number, None)),
            Some((number, rest)) => match SizeUnit::of(rest) {
                Some(unit) => Some((number, Some(unit))),
                None => return Err(self.table.no_number(row, column)),
            },
            None => None,
        };
        Ok(Some(SizeText { number, sieve_mm }))
    }

    pub(super) fn is_of_its_unit(&self, column: usize) -> bool {
        self.fractions_are_of_its_unit.get(column) == Some(&true)
    }

    /// A percent in a cell, with whether a percent sign stands behind it; `None` where it is not known.
    pub(super) fn percent(
        &mut self,
        row: &Row,
        column: usize,
    ) -> Result<Option<(f64, bool)>, Fault> {
        if is_missing(row.cell(column)) {
            return Ok(None);
        }
        let found = self
            .table
            .number_and_rest(row, column, &mut self.repairs.numbers)?;
        match found {
            None => Ok(None),
            Some((percent, "")) => Ok(Some((percent, false))),
            Some((percent, "%")) => Ok(Some((percent, true))),
            Some(_) => Err(self.table.no_number(row, column)),
        }
    }
}
