//! What the names of the columns that hold sizes say of fractions in them, and what is wrong with those names.

use super::layout::Layout;
use super::names::{size_trouble, unit_of_size};
use super::size_text::{fraction_of_unit, sieve_mm};
use super::size_unit::{SizeUnit, no_length, unknown_unit};
use super::unit_above::Above;
use super::vocabulary::words;
use crate::fault::Fault;
use crate::tables::table::Table;
use crate::text::fields::shown;
use crate::units::LengthUnit;

/// The columns that hold sizes; of sizes in the names of columns that which may state their unit.
fn columns_of_sizes(layout: &Layout) -> Vec<usize> {
    match layout {
        Layout::Long { size, .. } | Layout::Wide { size, .. } | Layout::Retained { size, .. } => {
            vec![*size]
        }
        Layout::SizesAsColumns { names, .. } => names.iter().copied().collect(),
        Layout::Percentiles { columns, .. } => columns.iter().map(|of| of.column).collect(),
    }
}

/// Of each column, whether a fraction without a unit is of the unit that is stated of sizes: by the column, by the user (`given`), or in
/// a line above. Of inches, and beside names of sieves, it is the name of a sieve; so it is in a column of sieves whose name says
/// millimetres, of which nobody writes fractions there. Percentiles have no names of sieves.
pub(super) fn fractions_of_stated_unit(
    table: &Table,
    layout: &Layout,
    given: Option<LengthUnit>,
    above: &Above,
) -> Vec<bool> {
    let above = match above {
        Above::Stated(unit, ..) => Some(unit.unit),
        Above::Nothing | Above::Unclear(_) => None,
    };
    let by_column = |own: Option<SizeUnit>| own.map(|own| own.unit).or(given);
    let is_no_inch = |unit: LengthUnit| unit != LengthUnit::Inch;
    let names_sieve = |cell: &str| sieve_mm(cell).is_some() && fraction_of_unit(cell).is_none();
    let mut found = vec![false; table.header().len()];
    match layout {
        Layout::Percentiles { columns, .. } => {
            for of in columns {
                if let Some(found) = found.get_mut(of.column) {
                    *found = by_column(of.unit).or(above).is_some();
                }
            }
        }
        Layout::SizesAsColumns { unit, .. } => {
            let is_it = by_column(*unit).or(above).is_some_and(is_no_inch)
                && !table.header().iter().any(|name| names_sieve(name));
            found.fill(is_it);
        }
        Layout::Long { size, unit, .. }
        | Layout::Wide { size, unit }
        | Layout::Retained { size, unit, .. } => {
            let is_it = match by_column(*unit) {
                Some(unit) => is_no_inch(unit) && unit != LengthUnit::Millimetre,
                None => {
                    let mut cells = table.rows().iter().map(|row| row.cell(*size));
                    above.is_some_and(is_no_inch) && !cells.any(names_sieve)
                }
            };
            found.fill(is_it);
        }
    }
    found
}

/// Refuses columns whose names say that they hold no sizes, or sizes of two units.
pub(super) fn refuse_names_of_sizes(table: &Table, layout: &Layout) -> Result<(), Fault> {
    for column in columns_of_sizes(layout) {
        let name = table.name(column);
        let trouble = match layout {
            // Their numbers are percents.
            Layout::Percentiles { .. } | Layout::SizesAsColumns { .. } => no_length(&words(&name)),
            _ => size_trouble(&name),
        };
        if let Some(what) = trouble {
            let what = format!("column '{name}' {what}");
            let remedy = "give sizes in one unit, and name it alone: 'size (mm)'";
            return Err(Fault::at(table.header_line(), what, remedy));
        }
    }
    Ok(())
}

/// The fault of a name of sizes whose unit, perhaps, is not known.
pub(super) fn unknown(table: &Table, layout: &Layout) -> Option<Fault> {
    let of_column = |column: usize| {
        let name = table.name(column);
        let unit = unknown_unit(&name).filter(|_| unit_of_size(&name).is_none())?;
        let what = format!(
            "column '{name}': '{}' is no known unit of sizes",
            shown(&unit)
        );
        let remedy = "state the unit of sizes (--size-unit), write it as mm, cm, m, in or ft, or name another column (--size)";
        Some(Fault::at(table.header_line(), what, remedy))
    };
    columns_of_sizes(layout).into_iter().find_map(of_column)
}
