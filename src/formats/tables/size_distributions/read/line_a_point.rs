//! The layouts with a line a point: what passes, or what stays on sieves, of each sample.

use std::collections::HashMap;

use super::Reader;
use super::cells::{is_missing, size_cell};
use crate::fault::Fault;
use crate::fragmentation::Labels;
use crate::tables::size_distributions::label_columns::LabelColumns;
use crate::tables::size_distributions::names::{is_amount, sample_of};
use crate::tables::size_distributions::raw::{OnSieves, RawCurve, RawPoint};
use crate::tables::size_distributions::retained::{is_pan, is_total, is_washed};
use crate::tables::table::OR_LEAVE_OUT;
use crate::text::fields::shown;

/// A column of a long table.
struct SampleColumn {
    size: usize,
    column: usize,
    /// Which sample it is of, where there are several columns; else empty.
    sample: String,
}

/// Labels with a sample's name where they have none yet.
fn with_sample(mut labels: Labels, sample: &str) -> Labels {
    let free = [&mut labels.method, &mut labels.trial, &mut labels.photo];
    let free = free.into_iter().find(|place| place.is_empty());
    if let Some(free) = free {
        sample.clone_into(free);
    } else if !sample.is_empty() {
        labels.photo = format!("{}, {sample}", labels.photo);
    }
    labels
}

impl Reader<'_> {
    /// A line a point: what passes, or what stays on the `sieves`, in a column of each sample.
    pub(super) fn long(
        &mut self,
        size: usize,
        columns: &[usize],
        sieves: Option<OnSieves>,
    ) -> Result<Vec<RawCurve>, Fault> {
        let taken: Vec<usize> = columns.iter().copied().chain([size]).collect();
        let mut labels = LabelColumns::of(self.table, self.columns, &taken)?;
        if self.columns.weight.is_none() && (sieves.is_some() || self.is_of_points(labels)) {
            // A mass in a sieve's protocol is the sieve's.
            labels.weight = None;
        }
        let used: Vec<usize> = labels.all().chain(taken).collect();
        self.say_unused(&used);
        let mut curves = Vec::new();
        for &column in columns {
            let sample = match columns {
                [_] => String::new(),
                _ => sample_of(&self.table.name(column)),
            };
            let of_column = SampleColumn {
                size,
                column,
                sample,
            };
            self.long_column(&of_column, labels, sieves, &mut curves)
                .map_err(|fault| match sieves {
                    // What a protocol lacks is missing in its sum.
                    Some(_) => Fault {
                        remedy: fault.remedy.replace(OR_LEAVE_OUT, ""),
                        ..fault
                    },
                    None => fault,
                })?;
        }
        Ok(curves)
    }

    /// Whether what should be the mass of curves changes from point to point of one.
    fn is_of_points(&self, labels: LabelColumns) -> bool {
        let is_mass = |column: &usize| is_amount(&self.table.name(*column));
        let Some(weight) = labels.weight.filter(is_mass) else {
            return false;
        };
        let mut known: HashMap<Labels, &str> = HashMap::new();
        self.table.rows().iter().any(|row| {
            let cell = row.cell(weight);
            !is_missing(cell) && *known.entry(self.labels(row, labels)).or_insert(cell) != cell
        })
    }

    /// The curves of one column of a long table.
    fn long_column(
        &mut self,
        of: &SampleColumn,
        labels: LabelColumns,
        sieves: Option<OnSieves>,
        curves: &mut Vec<RawCurve>,
    ) -> Result<(), Fault> {
        let mut places: HashMap<Labels, usize> = HashMap::new();
        for row in self.table.rows() {
            let size = size_cell(row, of.size);
            let (washed, total) = (is_washed(size), is_total(size));
            let pan = is_pan(size) || size.parse() == Ok(0.0);
            let size = match sieves.is_some() && (washed || pan || total) {
                true => None,
                false => match self.size(row, of.size).map_err(|fault| {
                    // A line that is left out of a protocol would be missing in its sum.
                    let remedy = "give the opening of its sieve, or call it pan, washed or total";
                    match sieves.is_some() && fault.what.ends_with("is not a number") {
                        true => Fault {
                            remedy: remedy.to_owned(),
                            ..fault
                        },
                        false => fault,
                    }
                })? {
                    Some(size) => Some(size),
                    None => {
                        self.refuse_what_is_in_the_pan(row, of.size, of.column)?;
                        continue;
                    }
                },
            };
            let percent = self.percent(row, of.column)?;
            // A sieve that one of several samples was not shaken through.
            if percent.is_none() && (size.is_none() || !of.sample.is_empty()) {
                continue;
            }
            let Some((percent, percent_sign)) = percent else {
                let what = format!("column {} is empty", self.table.name(of.column));
                return Err(Fault::at(
                    row.line,
                    what,
                    format!("fill it in{OR_LEAVE_OUT}"),
                ));
            };
            let name = with_sample(self.labels(row, labels), &of.sample);
            let weight = self.weight(row, labels)?;
            let place = *places.entry(name.clone()).or_insert(curves.len());
            if place == curves.len() {
                curves.push(RawCurve {
                    labels: name,
                    weight,
                    line: row.line,
                    points: Vec::new(),
                    sieves,
                });
            }
            let Some(curve) = curves.get_mut(place) else {
                continue;
            };
            if let (Some(before), Some(now)) = (curve.weight, weight)
                && before != now
            {
                let what = format!(
                    "its weight is {now}, where line {} has {before} for the same curve",
                    curve.line
                );
                return Err(Fault::at(row.line, what, "give a curve one weight"));
            }
            curve.weight = curve.weight.or(weight);
            let Some(size) = size else {
                let Some(sieves) = &mut curve.sieves else {
                    continue;
                };
                if total {
                    let digit = self.table.last_digit(row, of.column);
                    sieves.total_digit = digit.unwrap_or_default();
                }
                let place = match (total, washed) {
                    (true, _) => &mut sieves.total,
                    (false, true) => &mut sieves.washed,
                    (false, false) => &mut sieves.pan,
                };
                if place.replace(percent).is_some() {
                    let what = format!("'{}' is there twice", shown(size_cell(row, of.size)));
                    return Err(Fault::at(row.line, what, "keep one, or name the curves"));
                }
                continue;
            };
            curve.points.push(RawPoint {
                line: row.line,
                size,
                percent,
                percent_sign,
            });
        }
        Ok(())
    }
}
