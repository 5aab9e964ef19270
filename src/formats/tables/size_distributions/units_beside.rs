//! Units that stand beside the names of the columns: in a line of their own below them, or in a column of their own.
//!
//! ```text
//! Sieve,Retained,Passing        size,unit,passing
//! (mm),(g),(%)                  20,mm,35
//! 20,110,35                     2,in,80
//! ```

use super::names::{Role, is_unit_of_amounts, role};
use super::percentile_column::PercentileColumn;
use super::size_unit::SizeUnit;
use crate::tables::table::{Table, key};

/// The table with its units where the layouts look for them: at the end of the names, or behind the sizes.
pub(super) fn in_their_places(mut table: Table) -> Table {
    if let Some(names) = names_with_units(&table) {
        table = table.with_names_of_two_lines(names);
    }
    if let Some(units) = column_of_units(&table) {
        table = with_units_behind(table, units);
    }
    table
}

/// What stands in brackets, or the text itself.
fn without_brackets(cell: &str) -> &str {
    let inner = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    inner('(', ')')
        .or_else(|| inner('[', ']'))
        .unwrap_or(cell)
        .trim()
}

/// The names with the units of the line below them; `None` where that line is no line of units.
fn names_with_units(table: &Table) -> Option<Vec<String>> {
    let [first, _, ..] = table.rows() else {
        return None;
    };
    let units: Vec<&str> = (0..table.header().len())
        .map(|column| without_brackets(first.cell(column)))
        .collect();
    let says_nothing = |unit: &str| matches!(unit, "" | "-" | "–" | "—");
    let is_unit = |unit: &str| SizeUnit::of(unit).is_some() || is_unit_of_amounts(unit);
    let all = units.iter().all(|unit| says_nothing(unit) || is_unit(unit));
    if !all || units.iter().all(|unit| says_nothing(unit)) {
        return None;
    }
    let names = table.header().iter().zip(units);
    let named = names.map(|(name, unit)| match says_nothing(unit) {
        true => name.clone(),
        false => format!("{name} ({unit})"),
    });
    Some(named.collect())
}

/// The column that is called unit and holds nothing but units of lengths.
fn column_of_units(table: &Table) -> Option<usize> {
    let is_called = |name: &String| {
        matches!(
            key(name).as_str(),
            "unit" | "units" | "sizeunit" | "sizeunits" | "unitofsize" | "unitsofsize"
        )
    };
    let column = table.header().iter().position(is_called)?;
    let mut cells = table.rows().iter().map(|row| row.cell(column));
    let is_length = |cell: &str| cell.is_empty() || SizeUnit::of(without_brackets(cell)).is_some();
    cells.all(is_length).then_some(column)
}

/// The table without its column of `units`, which stand behind the sizes then. Where a name of sizes states a unit, or where there are
/// no sizes, it stays as it is: then nobody uses the column, which is said.
fn with_units_behind(table: Table, units: usize) -> Table {
    let mut sizes = Vec::new();
    for (column, name) in table.header().iter().enumerate() {
        match (role(name), PercentileColumn::of(name)) {
            (Role::Size(None) | Role::PerhapsSize(None), _) => sizes.push(column),
            (_, Some(percentile)) if percentile.unit.is_none() => sizes.push(column),
            (Role::Size(Some(_)) | Role::PerhapsSize(Some(_)), _) | (_, Some(_)) => return table,
            _ => {}
        }
    }
    if sizes.is_empty() {
        return table;
    }
    table
        .with_cells(|row, column| {
            let cell = row.cell(column);
            let unit = without_brackets(row.cell(units));
            let is_bare = cell.ends_with(|c: char| c.is_ascii_digit());
            match sizes.contains(&column) && is_bare && !unit.is_empty() {
                true => format!("{cell} {unit}"),
                false => cell.to_owned(),
            }
        })
        .without_column(units)
}
