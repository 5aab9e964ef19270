//! Columns that are called by percentiles, in their sets.

use super::column_names::Names;
use super::{Layout, PercentColumn};
use crate::fault::Fault;
use crate::tables::size_distributions::percentile_column::PercentsOfSet;

impl Names<'_> {
    pub(super) fn percentiles_of(&self, set: &str) -> Result<Layout, Fault> {
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
    pub(super) fn percentile_sets(&self) -> Vec<(usize, &str)> {
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
    pub(super) fn is_of_a_set(&self, column: usize, sets: &[(usize, &str)]) -> bool {
        self.percentiles.iter().any(|(own, percentile)| {
            *own == column
                && percentile.set.starts_with('%')
                && sets.iter().any(|(_, set)| *set == percentile.set)
        })
    }
}
