//! The columns that name a curve, and its weight.

use super::DistributionColumns;
use super::names::{Role, role, weight_of};
use crate::fault::Fault;
use crate::fragmentation::Weighting;
use crate::tables::table::Table;

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
