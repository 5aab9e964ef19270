//! Which of the layouts a table has, told by the names of its columns.

mod by_names;
mod column_names;
mod percentiles;

use self::column_names::Names;
use super::DistributionColumns;
use super::names::{RetainedName, Role, role};
use super::size_text::SizeText;
use super::size_unit::SizeUnit;
use super::vocabulary::PASSING_NAMES;
use crate::fault::Fault;
use crate::tables::table::{Table, key};

/// A layout, with the columns that matter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Layout {
    /// One line a point.
    Long {
        size: usize,
        unit: Option<SizeUnit>,
        passing: usize,
    },
    /// One column a curve.
    Wide { size: usize, unit: Option<SizeUnit> },
    /// One line a sieve, with what stays on it of each sample.
    Retained {
        size: usize,
        unit: Option<SizeUnit>,
        /// A column of each sample.
        retained: Vec<usize>,
        what: RetainedName,
    },
    /// One line a curve, a column each size.
    SizesAsColumns {
        sizes: Vec<(usize, SizeText)>,
        /// Of sizes without one.
        unit: Option<SizeUnit>,
        /// The column that is called sizes, and names the curves.
        names: Option<usize>,
    },
    /// One line a curve, a column each percent.
    Percentiles {
        columns: Vec<PercentColumn>,
        /// Whether they are called by shares of 1.
        by_shares: bool,
    },
}

/// A column of sizes that `percent` pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PercentColumn {
    pub(super) column: usize,
    pub(super) percent: f64,
    /// Of sizes without one of their own.
    pub(super) unit: Option<SizeUnit>,
}

impl Layout {
    /// Whether the names of a table's columns say beyond doubt that it holds size distributions.
    pub(super) fn is_sure(table: &Table) -> bool {
        let places = [
            "x",
            "y",
            "z",
            "lon",
            "lat",
            "longitude",
            "latitude",
            "easting",
            "northing",
        ];
        let header = table.header().iter().map(|name| key(name));
        let coordinates = header
            .filter(|name| places.contains(&name.as_str()))
            .count();
        let with_unit =
            |(_, text): &(usize, SizeText)| text.number.is_some_and(|(_, unit)| unit.is_some());
        let numeric = |column: usize| {
            let mut rows = table.rows().iter();
            rows.all(|row| {
                let cell = row.cell(column);
                cell.is_empty() || cell.starts_with(|c: char| c.is_ascii_digit())
            })
        };
        match Self::of(table, &DistributionColumns::default()) {
            Ok(Self::Long { passing, .. }) => {
                let name = table
                    .header()
                    .get(passing)
                    .map(|name| key(name))
                    .unwrap_or_default();
                coordinates < 2 && PASSING_NAMES.iter().any(|word| name.contains(word))
            }
            Ok(Self::Wide { size, unit }) => {
                let sure = matches!(
                    table.header().get(size).map(|name| role(name)),
                    Some(Role::Size(_))
                );
                sure && size == 0
                    && unit.is_some()
                    && coordinates == 0
                    && (0..table.header().len()).all(numeric)
            }
            Ok(Self::Retained { .. }) => coordinates < 2,
            Ok(Self::SizesAsColumns { sizes, unit, .. }) => {
                unit.is_some() || sizes.iter().filter(|size| with_unit(size)).count() >= 2
            }
            Ok(Self::Percentiles { columns, .. }) => {
                columns.len() >= 3 && !has_all(table, &["x", "y", "z"])
            }
            Err(_) => false,
        }
    }

    /// The layout of a table.
    ///
    /// # Errors
    /// Where it has none of them, or more than one; the columns that there are are named.
    pub(super) fn of(table: &Table, columns: &DistributionColumns) -> Result<Self, Fault> {
        let found = Names::of(table);
        let named =
            |name: &Option<String>| name.as_deref().map(|name| table.column(name)).transpose();
        match (named(&columns.size)?, named(&columns.passing)?) {
            (size, Some(passing)) => {
                found.refuse_classes(&[passing])?;
                let size = match size {
                    Some(size) => size,
                    None => found.size(true)?.ok_or_else(|| found.no_sizes())?,
                };
                Ok(found.long(size, passing))
            }
            (Some(size), None) => found.with_sizes(size),
            (None, None) => found.by_names(),
        }
    }
}

/// Whether a table has columns of all these names.
fn has_all(table: &Table, names: &[&str]) -> bool {
    let has = |name: &&str| table.header().iter().any(|column| key(column) == **name);
    names.iter().all(has)
}
