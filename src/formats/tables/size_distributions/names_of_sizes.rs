//! What is wrong with the names of the columns that hold sizes.

use super::layout::Layout;
use super::names::{size_trouble, unit_of_size};
use super::size_unit::{no_length, unknown_unit};
use super::vocabulary::words;
use crate::fault::Fault;
use crate::tables::table::Table;
use crate::text::fields::shown;

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
