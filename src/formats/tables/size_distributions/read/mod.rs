//! The points of a table in each layout.

mod cells;
mod column_a_curve;
mod line_a_curve;
mod line_a_point;
mod sizes_in_names;

use self::cells::{is_missing, size_cell};
use super::DistributionColumns;
use super::curves::{Repairs, SizeReading, SizesRead, finish, refuse_classes_by_sum};
use super::label_columns::LabelColumns;
use super::layout::Layout;
use super::names::{
    Role, counts_fragments, holds_astm_numbers, holds_sieve_numbers, names_percent, role,
    weight_factor,
};
use super::names_of_sizes::{fractions_of_stated_unit, refuse_names_of_sizes, unknown};
use super::raw::OnSieves;
use super::retained::names_pan;
use super::unit_above::Above;
use crate::fault::Fault;
use crate::fragmentation::Labels;
use crate::tables::table::{Row, Table};
use crate::text::fields::shown;

/// Reads the curves of a table, which is that of a text.
pub(super) fn read(
    table: &Table,
    text: &str,
    columns: &DistributionColumns,
) -> Result<SizesRead, Fault> {
    let mut reader = Reader {
        table,
        columns,
        holds_sieve_numbers: (table.header().iter())
            .map(|name| holds_sieve_numbers(name))
            .collect(),
        holds_astm_numbers: (table.header().iter())
            .map(|name| holds_sieve_numbers(name) && holds_astm_numbers(name))
            .collect(),
        fractions_are_of_its_unit: Vec::new(),
        repairs: Repairs::default(),
    };
    let layout = Layout::of(table, columns)?;
    refuse_names_of_sizes(table, &layout)?;
    let above = Above::of(text, table.header_line());
    reader.fractions_are_of_its_unit =
        fractions_of_stated_unit(table, &layout, columns.unit, &above);
    let mut reading = SizeReading {
        header: None,
        given: columns.unit,
        above,
        unknown: unknown(table, &layout),
        says_percent: None,
        percentiles: false,
    };
    let curves = match layout {
        Layout::Long {
            size,
            unit,
            passing,
        } => {
            reading.header = unit;
            let name = table.name(passing);
            if counts_fragments(&name) {
                let what = format!(
                    "column '{name}' is of numbers of fragments: a sieve and every percent here is of mass, which lies at coarser sizes"
                );
                reader.repairs.said.push(what);
            }
            reading.says_percent = names_percent(&name).then_some(name);
            reader.long(size, &[passing], None)?
        }
        Layout::Retained {
            size,
            unit,
            retained,
            what,
        } => {
            reading.header = unit;
            let names: Vec<String> = retained.iter().map(|&column| table.name(column)).collect();
            reader.repairs.said.push(format!(
                "what passes is computed from what stays on the sieves, {} {}",
                if names.len() == 1 {
                    "column"
                } else {
                    "columns"
                },
                names.join(", ")
            ));
            reader.long(size, &retained, Some(OnSieves::new(what)))?
        }
        Layout::Wide { size, unit } => {
            reading.header = unit;
            let curves = reader.wide(size)?;
            refuse_classes_by_sum(table, &curves)?;
            curves
        }
        Layout::SizesAsColumns { sizes, unit, names } => {
            reading.header = unit;
            reader.sizes_as_columns(&sizes, names)?
        }
        Layout::Percentiles { columns, by_shares } => {
            if by_shares {
                let said =
                    "percentiles are called by shares of 1: of 0.5 it is the size that 50 % pass";
                reader.repairs.said.push(said.to_owned());
            }
            // Each column has its own; one that all have is the table's.
            let first = columns.first().and_then(|column| column.unit);
            reading.header = first.filter(|_| columns.iter().all(|column| column.unit == first));
            reading.percentiles = true;
            reader.percentiles(&columns)?
        }
    };
    if curves.is_empty() {
        let remedy = "give sizes with their percent passing";
        return Err(Fault::at(table.header_line(), "it has no points", remedy));
    }
    finish(curves, reading, reader.repairs)
}

struct Reader<'a> {
    table: &'a Table,
    columns: &'a DistributionColumns,
    /// Of each column.
    holds_sieve_numbers: Vec<bool>,
    /// Of each column, those whose numbers say which series they are of.
    holds_astm_numbers: Vec<bool>,
    /// Of each column, whether a fraction without a unit is of the unit that is stated of sizes.
    fractions_are_of_its_unit: Vec<bool>,
    repairs: Repairs,
}

impl Reader<'_> {
    /// Nothing passes the pan: where something is in it, the column that nobody calls passing is what stays on the sieves.
    fn refuse_what_is_in_the_pan(
        &mut self,
        row: &Row,
        size: usize,
        column: usize,
    ) -> Result<(), Fault> {
        let name = self.table.name(column);
        if !names_pan(size_cell(row, size)) || role(&name) == Role::Passing || column >= row.len() {
            return Ok(());
        }
        match self.percent(row, column) {
            Ok(Some((in_it, _))) if in_it > 0.0 => {
                let what = format!(
                    "column '{name}' has {in_it} in the pan, which nothing passes: it seems to be what stays on the sieves"
                );
                let remedy =
                    "call it 'percent retained' or 'mass retained', or give percent passing";
                Err(Fault::at(row.line, what, remedy))
            }
            _ => Ok(()),
        }
    }

    /// What the columns of labels say of a line.
    fn labels(&self, row: &Row, columns: LabelColumns) -> Labels {
        let cell = |column: Option<usize>| column.map_or("", |column| row.cell(column)).to_owned();
        Labels {
            method: cell(columns.method),
            trial: cell(columns.trial),
            photo: cell(columns.photo),
        }
    }

    fn weight(&mut self, row: &Row, columns: LabelColumns) -> Result<Option<f64>, Fault> {
        match columns.weight {
            Some(column) if !is_missing(row.cell(column)) => {
                let weight = self.table.number(row, column, &mut self.repairs.numbers)?;
                let factor = weight_factor(&self.table.name(column));
                Ok(weight.map(|weight| weight * factor))
            }
            _ => Ok(None),
        }
    }

    /// Says which columns nobody looked at.
    fn say_unused(&mut self, used: &[usize]) {
        let header = self.table.header().iter().enumerate();
        let elsewhere = self.columns.point_weight.as_deref();
        let elsewhere = elsewhere.and_then(|name| self.table.column(name).ok());
        let is_used = |column: usize| used.contains(&column) || elsewhere == Some(column);
        let unused: Vec<String> = header
            .filter(|(column, name)| !name.is_empty() && !is_used(*column))
            .map(|(_, name)| shown(name))
            .collect();
        if unused.is_empty() {
            return;
        }
        let (first, rest) = unused.split_at(unused.len().min(8));
        let more = match rest.len() {
            0 => String::new(),
            more => format!(" and {more} others"),
        };
        let names = first.join(", ");
        self.repairs
            .said
            .push(format!("columns that are not used: {names}{more}"));
    }
}
