//! Which of the layouts a table has, told by the names of its columns.

use super::DistributionColumns;
use super::names::{RetainedName, Role, is_amount, is_called_size, role, sample_of, weight_of};
use super::percentile_column::{PercentileColumn, PercentsOfSet};
use super::retained::{is_pan, is_total};
use super::size_text::SizeText;
use super::size_unit::SizeUnit;
use super::vocabulary::PASSING_NAMES;
use crate::fault::Fault;
use crate::fragmentation::{Weighting, names_sieve};
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

/// The columns that name a curve, and its weight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct LabelColumns {
    pub(super) method: Option<usize>,
    pub(super) trial: Option<usize>,
    pub(super) photo: Option<usize>,
    pub(super) weight: Option<usize>,
}

impl LabelColumns {
    /// Those that the user named, else those whose names say so; none of `taken`.
    pub(super) fn of(
        table: &Table,
        columns: &DistributionColumns,
        taken: &[usize],
    ) -> Result<Self, Fault> {
        let named =
            |name: &Option<String>| name.as_deref().map(|name| table.column(name)).transpose();
        let free = || {
            let roles = table.header().iter().map(|name| role(name)).enumerate();
            roles.filter(|(column, _)| !taken.contains(column))
        };
        let found = |wanted: Role| {
            free()
                .find(|(_, role)| *role == wanted)
                .map(|(column, _)| column)
        };
        let photo = free().filter_map(|(column, role)| match role {
            Role::Photo(place) => Some((place, column)),
            _ => None,
        });
        let mut weights: Vec<usize> = free()
            .filter(|(_, role)| *role == Role::Weight)
            .map(|(column, _)| column)
            .collect();
        let others = match columns.merging {
            Weighting::Equal => None,
            Weighting::Area => Some(Weighting::Mass),
            Weighting::Mass => Some(Weighting::Area),
        };
        let all = weights.clone();
        weights.retain(|column| {
            let of = weight_of(&table.name(*column));
            of.is_none() || of != others
        });
        if let (None, [], [other, ..]) = (&columns.weight, &weights[..], &all[..]) {
            let what = format!(
                "column '{}' is no {}, by which curves are to be merged",
                table.name(*other),
                columns.merging.key()
            );
            let remedy = "merge them by what it is, or all the same (--merge)";
            return Err(Fault::at(table.header_line(), what, remedy));
        }
        let weight = match (named(&columns.weight)?, &weights[..]) {
            (Some(named), _) => Some(named),
            (None, []) => None,
            (None, [one]) => Some(*one),
            (None, [one, two, ..]) => {
                let what = format!(
                    "columns '{}' and '{}' may both be what curves weigh",
                    table.name(*one),
                    table.name(*two)
                );
                let remedy = "name one of them (--weight)";
                return Err(Fault::at(table.header_line(), what, remedy));
            }
        };
        Ok(Self {
            method: named(&columns.method)?.or(found(Role::Method)),
            trial: named(&columns.trial)?.or(found(Role::Trial)),
            photo: named(&columns.photo)?.or(photo.min().map(|(_, column)| column)),
            weight,
        })
    }

    pub(super) fn all(self) -> impl Iterator<Item = usize> {
        [self.method, self.trial, self.photo, self.weight]
            .into_iter()
            .flatten()
    }
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

/// What the names of a table's columns say.
struct Names<'a> {
    table: &'a Table,
    roles: Vec<Role>,
    percentiles: Vec<(usize, PercentileColumn)>,
    sizes: Vec<(usize, SizeText)>,
}

impl<'a> Names<'a> {
    fn of(table: &'a Table) -> Self {
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

    fn fault(&self, what: impl Into<String>, remedy: impl Into<String>) -> Fault {
        Fault::at(self.table.header_line(), what, remedy)
    }

    /// The columns of a role.
    fn with(&self, is: impl Fn(Role) -> bool) -> Vec<usize> {
        let roles = self.roles.iter().enumerate();
        roles
            .filter(|(_, role)| is(**role))
            .map(|(column, _)| column)
            .collect()
    }

    /// The column of sizes; `anywhere`, also one that is only perhaps one, where it is not the first. Beside one that is called sizes
    /// or has their unit, the bare word for a sieve is a method's: what was found by sieving.
    fn size(&self, anywhere: bool) -> Result<Option<usize>, Fault> {
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

    fn unit(&self, column: usize) -> Option<SizeUnit> {
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
    fn long(&self, size: usize, column: usize) -> Layout {
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
    fn retained(&self) -> Result<Vec<usize>, Fault> {
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
    fn on_sieves(&self, size: usize, retained: Vec<usize>) -> Option<Layout> {
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

    fn wide(&self, size: usize) -> Result<Layout, Fault> {
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
    fn refuse_classes(&self, columns: &[usize]) -> Result<(), Fault> {
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

    fn no_sizes(&self) -> Fault {
        self.fault(
            format!(
                "no column is called size among {}",
                self.table.columns_in_words()
            ),
            "call the column of sizes size in the first line (or name it by --size)",
        )
    }

    /// The layout where the user named the sizes alone.
    fn with_sizes(&self, size: usize) -> Result<Layout, Fault> {
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

    fn percentiles_of(&self, set: &str) -> Result<Layout, Fault> {
        let columns = self.percentiles.iter();
        let columns = columns.filter(|(_, column)| column.set == set);
        let mut columns: Vec<PercentColumn> = columns
            .map(|(column, percentile)| PercentColumn {
                column: *column,
                percent: percentile.percent,
                unit: percentile.unit,
            })
            .collect();
        if let [one] = columns[..] {
            let name = self.table.name(one.column);
            let what = format!("column '{name}' is a single percentile");
            return Err(self.fault(what, "give two or more, called alike"));
        }
        let by_shares = match PercentsOfSet::of(columns.iter().map(|column| column.percent)) {
            PercentsOfSet::Percents => false,
            PercentsOfSet::Shares => true,
            PercentsOfSet::Either => {
                let name = columns.first().map(|column| self.table.name(column.column));
                let what = format!(
                    "columns as '{}' are percentiles of shares of 1 or of percents below 1, which nothing says",
                    name.unwrap_or_default()
                );
                return Err(self.fault(what, "call them by percents: D10, D50"));
            }
        };
        if by_shares {
            for column in &mut columns {
                // 0.29 times 100 is 28.999999999999996.
                column.percent = (column.percent * 1e11).round() / 1e9;
            }
        }
        Ok(Layout::Percentiles { columns, by_shares })
    }

    /// The sets of two percentiles or more, without those of logarithms, by their first columns.
    fn percentile_sets(&self) -> Vec<(usize, &str)> {
        let mut sets: Vec<(usize, &str, usize)> = Vec::new();
        for (column, percentile) in &self.percentiles {
            if percentile.is_logarithm() {
                continue;
            }
            match sets.iter_mut().find(|(_, set, _)| *set == percentile.set) {
                Some((.., count)) => *count += 1,
                None => sets.push((*column, &percentile.set, 1)),
            }
        }
        let sets = sets.into_iter().filter(|(.., count)| *count > 1);
        sets.map(|(column, set, _)| (column, set)).collect()
    }

    /// Whether a column is one of a set of percentiles that are called by percents.
    fn is_of_a_set(&self, column: usize, sets: &[(usize, &str)]) -> bool {
        self.percentiles.iter().any(|(own, percentile)| {
            *own == column
                && percentile.set.starts_with('%')
                && sets.iter().any(|(_, set)| *set == percentile.set)
        })
    }

    /// The layout where no column was named.
    fn by_names(&self) -> Result<Layout, Fault> {
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
