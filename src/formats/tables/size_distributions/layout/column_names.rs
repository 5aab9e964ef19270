//! What the names of a table's columns say, and the layout where the user named the sizes.

use super::Layout;
use crate::fault::Fault;
use crate::fragmentation::names_sieve;
use crate::tables::size_distributions::names::{
    RetainedName, Role, is_amount, is_called_size, role, sample_of,
};
use crate::tables::size_distributions::percentile_column::PercentileColumn;
use crate::tables::size_distributions::size_text::SizeText;
use crate::tables::size_distributions::size_unit::SizeUnit;
use crate::tables::table::Table;

/// What the names of a table's columns say.
pub(super) struct Names<'a> {
    pub(super) table: &'a Table,
    pub(super) roles: Vec<Role>,
    pub(super) percentiles: Vec<(usize, PercentileColumn)>,
    pub(super) sizes: Vec<(usize, SizeText)>,
}

impl<'a> Names<'a> {
    pub(super) fn of(table: &'a Table) -> Self {
        let header = || table.header().iter().enumerate();
        Self {
            table,
            roles: header().map(|(_, name)| role(name)).collect(),
            percentiles: header()
                .filter_map(|(column, name)| Some((column, PercentileColumn::of(name)?)))
                .collect(),
            sizes: header()
                .filter_map(|(column, name)| Some((column, SizeText::of_name(name)?)))
                .collect(),
        }
    }

    pub(super) fn fault(&self, what: impl Into<String>, remedy: impl Into<String>) -> Fault {
        Fault::at(self.table.header_line(), what, remedy)
    }

    /// The columns of a role.
    pub(super) fn with(&self, is: impl Fn(Role) -> bool) -> Vec<usize> {
        let roles = self.roles.iter().enumerate();
        roles
            .filter(|(_, role)| is(**role))
            .map(|(column, _)| column)
            .collect()
    }

    /// The column of sizes; `anywhere`, also one that is only perhaps one, where it is not the first. Beside one that is called sizes
    /// or has their unit, the bare word for a sieve is a method's: what was found by sieving.
    pub(super) fn size(&self, anywhere: bool) -> Result<Option<usize>, Fault> {
        let is_sieve = |column: &usize| names_sieve(&self.table.name(*column));
        let sure = self.with(|role| matches!(role, Role::Size(_)));
        let (sieves, called): (Vec<usize>, Vec<usize>) = sure.into_iter().partition(is_sieve);
        let sure = match called.is_empty() {
            true => sieves,
            false => called,
        };
        if let [one, two, ..] = sure[..] {
            let what = format!(
                "columns '{}' and '{}' may both be the sizes",
                self.table.name(one),
                self.table.name(two)
            );
            return Err(self.fault(what, "name one of them (--size)"));
        }
        let perhaps = self.with(|role| matches!(role, Role::PerhapsSize(_)));
        let first = perhaps.iter().find(|&&column| anywhere || column == 0);
        let found = sure.first().or(first).copied();
        if !found.as_ref().is_some_and(is_sieve) {
            return Ok(found);
        }
        let is_called = |column: &&usize| match self.roles.get(**column) {
            Some(Role::PerhapsSize(Some(_))) => true,
            _ => is_called_size(&self.table.name(**column)),
        };
        Ok(perhaps.iter().find(is_called).copied().or(found))
    }

    pub(super) fn unit(&self, column: usize) -> Option<SizeUnit> {
        match self.roles.get(column) {
            Some(Role::Size(unit) | Role::PerhapsSize(unit)) => *unit,
            // The user named it; its name may still end with a unit.
            _ => {
                let name = self.table.header().get(column)?;
                match role(&format!("size {name}")) {
                    Role::Size(unit) | Role::PerhapsSize(unit) => unit,
                    _ => None,
                }
            }
        }
    }

    /// A line a point, where that column is what passes or what stays.
    pub(super) fn long(&self, size: usize, column: usize) -> Layout {
        let passing = || Layout::Long {
            size,
            unit: self.unit(size),
            passing: column,
        };
        self.on_sieves(size, vec![column]).unwrap_or_else(passing)
    }

    /// The columns of what stays on sieves: of several kinds those that need the least made of them, one of each sample.
    ///
    /// # Errors
    /// Where two are of the same sample.
    pub(super) fn retained(&self) -> Result<Vec<usize>, Fault> {
        let mut columns: Vec<(RetainedName, usize)> = (self.roles.iter().enumerate())
            .filter_map(|(column, role)| match role {
                Role::Retained(what) => Some((*what, column)),
                _ => None,
            })
            .collect();
        columns.sort_unstable();
        let best = columns.first().map(|(what, _)| *what);
        columns.retain(|(what, _)| Some(*what) == best);
        let mut samples = Vec::new();
        for (_, column) in &columns {
            let sample = sample_of(&self.table.name(*column)).to_lowercase();
            let is_same =
                |known: &String| *known == sample || known.is_empty() || sample.is_empty();
            let earlier = samples.iter().position(is_same);
            if let Some((_, first)) = earlier.and_then(|place| columns.get(place)) {
                let what = format!(
                    "columns '{}' and '{}' may both be what stays on the sieves",
                    self.table.name(*first),
                    self.table.name(*column)
                );
                let remedy = "name one of them (--passing), or give each the name of its sample";
                return Err(self.fault(what, remedy));
            }
            samples.push(sample);
        }
        Ok(columns.into_iter().map(|(_, column)| column).collect())
    }

    /// A line a sieve, with what stays on it.
    pub(super) fn on_sieves(&self, size: usize, retained: Vec<usize>) -> Option<Layout> {
        let first = retained.first().and_then(|column| self.roles.get(*column));
        match first {
            Some(Role::Retained(what)) => Some(Layout::Retained {
                size,
                unit: self.unit(size),
                what: *what,
                retained,
            }),
            _ => None,
        }
    }

    pub(super) fn wide(&self, size: usize) -> Result<Layout, Fault> {
        let others: Vec<usize> = (0..self.roles.len())
            .filter(|&column| column != size)
            .collect();
        self.refuse_classes(&others)?;
        let is_size = |column: &usize| {
            let role = self.roles.get(*column);
            matches!(role, Some(Role::Size(Some(_)) | Role::PerhapsSize(Some(_))))
        };
        if let Some(&column) = others.iter().find(|column| is_size(column)) {
            let (one, two) = (self.table.name(size), self.table.name(column));
            return Err(self.fault(
                format!("columns '{one}' and '{two}' are both sizes, and nothing says which percents belong to which"),
                "keep the sizes and the percents of one sample, or name them (--size, --passing)",
            ));
        }
        if let [column] = others[..]
            && is_amount(&self.table.name(column))
        {
            let name = self.table.name(column);
            return Err(self.fault(
                format!("column '{name}' is a mass, not percent passing"),
                "call it 'mass retained' where it lay on the sieves, or give percent passing",
            ));
        }
        let stays = |column: &usize| matches!(self.roles.get(*column), Some(Role::Retained(_)));
        if let Some(&column) = others.iter().find(|column| stays(column)) {
            let name = self.table.name(column);
            return Err(self.fault(
                format!("column '{name}' is what stays on the sieves, beside others that are not"),
                "leave it out, or name it alone (--passing)",
            ));
        }
        if others.is_empty() {
            return Err(self.fault(
                format!("there is no column beside '{}'", self.table.name(size)),
                "give the percent passing in a column",
            ));
        }
        Ok(Layout::Wide {
            size,
            unit: self.unit(size),
        })
    }

    /// Refuses the percents of classes.
    pub(super) fn refuse_classes(&self, columns: &[usize]) -> Result<(), Fault> {
        for &column in columns {
            let name = self.table.name(column);
            if self.roles.get(column) == Some(&Role::PassingMass) {
                return Err(self.fault(
                    format!("column '{name}' is the mass that passes, not percent"),
                    "give percent passing: that mass over the mass of all, times 100",
                ));
            }
            if self.roles.get(column) == Some(&Role::NotCumulative) {
                return Err(self.fault(
                    format!("column '{name}' is the percent of each size class, not cumulative"),
                    "give cumulative percent passing: the sum of all smaller classes",
                ));
            }
        }
        Ok(())
    }

    pub(super) fn no_sizes(&self) -> Fault {
        self.fault(
            format!(
                "no column is called size among {}",
                self.table.columns_in_words()
            ),
            "call the column of sizes size in the first line (or name it by --size)",
        )
    }

    /// The layout where the user named the sizes alone.
    pub(super) fn with_sizes(&self, size: usize) -> Result<Layout, Fault> {
        if let Some((_, column)) = self.percentiles.iter().find(|(column, _)| *column == size) {
            return self.percentiles_of(&column.set);
        }
        let mut passing = self.with(|role| role == Role::Passing);
        passing.retain(|&column| column != size);
        let mut retained = self.retained()?;
        retained.retain(|&column| column != size);
        match &passing[..] {
            [passing] => Ok(self.long(size, *passing)),
            [] => match self.on_sieves(size, retained) {
                Some(layout) => Ok(layout),
                None => self.wide(size),
            },
            _ => self.wide(size),
        }
    }
}
