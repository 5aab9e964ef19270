//! The sizes in the names of columns.

use super::Reader;
use crate::tables::size_distributions::size_text::{SizeText, fraction_of_unit};
use crate::tables::size_distributions::size_unit::SizeUnit;
use crate::tables::table::number_and_unit;
use crate::units::LengthUnit;

impl Reader<'_> {
    /// The sizes in the names of columns. A fraction without a unit is of the one that is stated, else of the one that all others have.
    pub(super) fn sizes_in_names(&mut self, sizes: &[(usize, SizeText)]) -> Vec<(usize, SizeText)> {
        let table = self.table;
        let name = |column: usize| table.header().get(column).map_or("", String::as_str);
        let fraction = |column: usize| match fraction_of_unit(name(column)) {
            Some((number, None)) => Some(number),
            _ => None,
        };
        let mut others = (sizes.iter())
            .filter(|(column, _)| fraction(*column).is_none())
            .map(|(_, size)| size.number.and_then(|(_, unit)| unit));
        let first = others.next().flatten();
        let is_of_all = |first: &SizeUnit| others.all(|unit| unit == Some(*first));
        let of_all = first
            .filter(|first| first.unit != LengthUnit::Inch)
            .filter(is_of_all);
        let line = table.header_line();
        let mut found = Vec::with_capacity(sizes.len());
        for &(column, size) in sizes {
            let unit = match self.is_of_its_unit(column) {
                true => Some(None),
                false => of_all.map(Some),
            };
            if let (Some(unit), Some(number)) = (unit, fraction(column)) {
                self.repairs.fraction(line);
                found.push((column, SizeText::of_number(number, unit)));
                continue;
            }
            if let (Some(_), Some((number, true, _))) = (size.number, number_and_unit(name(column)))
            {
                let numbers = &mut self.repairs.numbers;
                numbers.thousands_apart(line, name(column), number);
            }
            found.push((column, size));
        }
        found
    }
}
