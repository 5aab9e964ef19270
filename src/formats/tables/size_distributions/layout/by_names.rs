//! The layout where the user named no column.

use super::Layout;
use super::column_names::Names;
use crate::fault::Fault;
use crate::tables::size_distributions::names::Role;
use crate::tables::size_distributions::retained::{is_pan, is_total};
use crate::tables::size_distributions::size_text::SizeText;

impl Names<'_> {
    /// The layout where no column was named.
    pub(super) fn by_names(&self) -> Result<Layout, Fault> {
        let names = self.table.header().iter().filter(|name| !name.is_empty());
        if names.clone().all(|name| name.parse::<f64>().is_ok()) {
            let what = format!(
                "the first line names no columns: {}",
                self.table.columns_in_words()
            );
            let remedy = "put a line like 'size_mm,percent_passing' first";
            return Err(self.fault(what, remedy));
        }
        let sets = self.percentile_sets();
        let mut passing = self.with(|role| role == Role::Passing);
        // "10 % passing (cm)" and its like are sizes.
        passing.retain(|&column| !self.is_of_a_set(column, &sets));
        let mut retained = self.retained()?;
        retained.retain(|_| passing.is_empty());
        let mut size = self.size(!passing.is_empty() || !retained.is_empty())?;
        if passing.is_empty() && !sets.is_empty() {
            // A sample's size, or a coordinate.
            size = size.filter(|&column| matches!(self.roles.get(column), Some(Role::Size(_))));
        }
        let has_unit = |(_, text): &&(usize, SizeText)| {
            text.sieve_mm.is_some() || text.number.is_some_and(|(_, unit)| unit.is_some())
        };
        let with_unit = self.sizes.iter().filter(has_unit).count();
        // Bare numbers beside a column of sizes are the names of trials.
        let by_sizes = with_unit >= 2 || (size.is_none() && self.sizes.len() >= 2);
        if let Some(names) = size.filter(|&size| passing.is_empty() && self.names_curves(size)) {
            return Ok(Layout::SizesAsColumns {
                sizes: self.sizes.clone(),
                unit: self.unit(names),
                names: Some(names),
            });
        }
        match (size, &passing[..], by_sizes, &sets[..]) {
            (Some(size), [passing], false, []) => Ok(self.long(size, *passing)),
            (Some(_), [_], ..) | (Some(_), _, true, _) | (_, _, true, [_, ..]) => {
                let what = format!(
                    "it can be read in two ways, by {}",
                    self.ways(size, &passing, by_sizes, &sets)
                );
                let remedy = "keep the columns of one of them, or name the sizes and the percent \
                              passing (--size, --passing)";
                Err(self.fault(what, remedy))
            }
            (Some(size), ..) => match self.on_sieves(size, retained) {
                Some(layout) => Ok(layout),
                None => self.wide(size),
            },
            (None, _, true, []) => Ok(Layout::SizesAsColumns {
                sizes: self.sizes.clone(),
                unit: None,
                names: None,
            }),
            (None, _, false, [(_, set)]) => self.percentiles_of(set),
            (None, _, false, [(one, _), (two, _), ..]) => {
                let name = |column: &usize| self.table.name(*column);
                let what = format!(
                    "there are several sets of percentiles, one with '{}' and one with '{}'",
                    name(one),
                    name(two)
                );
                let remedy = format!("name a column of the one that holds (--size {})", name(one));
                Err(self.fault(what, remedy))
            }
            (None, [_, ..], false, []) => Err(self.no_sizes()),
            (None, [], false, []) if !retained.is_empty() => Err(self.no_sizes()),
            (None, [], false, []) => self.unnamed(),
        }
    }

    /// Whether the sizes stand in the first line, behind a column that is called so and names the curves.
    fn names_curves(&self, size: usize) -> bool {
        let is_size = |cell: &str| cell.is_empty() || SizeText::of_name(cell).is_some();
        let mut rows = self.table.rows().iter();
        // The pan and the sum of all may stand behind the sieves.
        let others = self
            .table
            .header()
            .iter()
            .filter(|name| is_pan(name) || is_total(name));
        self.sizes.len() >= 2
            && self.sizes.len() + 1 + others.count() == self.roles.len()
            && rows.all(|row| !is_size(row.cell(size)))
    }

    /// The ways to read it, for the fault that there are two.
    fn ways(
        &self,
        size: Option<usize>,
        passing: &[usize],
        by_sizes: bool,
        sets: &[(usize, &str)],
    ) -> String {
        let name = |column: usize| format!("'{}'", self.table.name(column));
        let mut ways = Vec::new();
        match (size, passing) {
            (Some(size), [passing]) => {
                ways.push(format!("{} with {}", name(size), name(*passing)));
            }
            (Some(size), _) => ways.push(format!("the sizes in {}", name(size))),
            _ => {}
        }
        if let (true, Some((column, _))) = (by_sizes, self.sizes.first()) {
            ways.push(format!("columns of sizes like {}", name(*column)));
        }
        if let Some((column, _)) = sets.first() {
            ways.push(format!("percentiles like {}", name(*column)));
        }
        ways.join(" and by ")
    }

    /// The layout of a table whose names say nothing: a corner left empty is over the sizes.
    fn unnamed(&self) -> Result<Layout, Fault> {
        let all: Vec<usize> = (0..self.roles.len()).collect();
        self.refuse_classes(&all)?;
        if self
            .table
            .header()
            .first()
            .is_some_and(|name| name.is_empty())
        {
            return self.wide(0);
        }
        Err(self.fault(
            format!(
                "no column is called size or passing among {}",
                self.table.columns_in_words()
            ),
            "call the columns size and passing in the first line (or name them by --size, --passing)",
        ))
    }
}
