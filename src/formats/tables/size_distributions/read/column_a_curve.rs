//! The layout with a column a curve, which its name names.

use super::Reader;
use super::cells::is_missing;
use crate::fault::Fault;
use crate::fragmentation::Labels;
use crate::tables::size_distributions::names::{Role, is_amount, role};
use crate::tables::size_distributions::raw::{RawCurve, RawPoint};

impl Reader<'_> {
    pub(super) fn wide(&mut self, size: usize) -> Result<Vec<RawCurve>, Fault> {
        let count = self.table.header().len();
        let is_curve = |column: &usize| {
            let name = self.table.name(*column);
            *column != size && role(&name) != Role::Statistic && !is_amount(&name)
        };
        let used: Vec<usize> = (0..count).filter(is_curve).chain([size]).collect();
        self.say_unused(&used);
        let mut curves: Vec<(usize, RawCurve)> = (0..count)
            .filter(|column| *column != size && used.contains(column))
            .map(|column| {
                let curve = RawCurve {
                    labels: self.labels_of_column(column, count == 2),
                    weight: None,
                    line: self.table.header_line(),
                    points: Vec::new(),
                    sieves: None,
                };
                (column, curve)
            })
            .collect();
        for row in self.table.rows() {
            if is_missing(row.cell(size)) && (0..row.len()).all(|c| is_missing(row.cell(c))) {
                continue;
            }
            let Some(size) = self.size(row, size)? else {
                for (column, _) in &curves {
                    self.refuse_what_is_in_the_pan(row, size, *column)?;
                }
                continue;
            };
            let there = |place: &&mut (usize, RawCurve)| place.0 < row.len();
            for (column, curve) in curves.iter_mut().take_while(there) {
                if let Some((percent, percent_sign)) = self.percent(row, *column)? {
                    curve.points.push(RawPoint {
                        line: row.line,
                        size,
                        percent,
                        percent_sign,
                    });
                }
            }
        }
        let (full, empty): (Vec<_>, Vec<_>) = curves
            .into_iter()
            .partition(|(_, curve)| !curve.points.is_empty());
        for (column, _) in empty {
            let name = self.table.name(column);
            self.repairs
                .said
                .push(format!("column {name} is empty and left out"));
        }
        if let Some((column, curve)) = full
            .iter()
            .find(|(_, curve)| full.len() > 1 && curve.labels == Labels::default())
        {
            let what = format!("column {} has no name", self.table.name(*column));
            return Err(Fault::at(curve.line, what, "name the curve that it holds"));
        }
        Ok(full.into_iter().map(|(_, curve)| curve).collect())
    }

    /// What the name of a curve's column says: "method", "method/trial" or "method/trial/photo". A
    /// curve that is `alone` and called percent passing has no name.
    fn labels_of_column(&self, column: usize, alone: bool) -> Labels {
        let name = self.table.header().get(column).map_or("", String::as_str);
        let short = without_percent(name);
        let name = if short.is_empty() && !alone {
            name
        } else {
            short
        };
        let mut parts = name.splitn(3, '/').map(|part| part.trim().to_owned());
        Labels {
            method: parts.next().unwrap_or_default(),
            trial: parts.next().unwrap_or_default(),
            photo: parts.next().unwrap_or_default(),
        }
    }
}

/// A name without "(%)" and words for percent passing at its end.
fn without_percent(name: &str) -> &str {
    let mut name = name.trim();
    loop {
        let before = name;
        for end in [
            "(%)",
            "[%]",
            "%",
            "passing",
            "percent",
            "cumulative",
            "cum.",
            "cum",
        ] {
            let start = name.len().saturating_sub(end.len());
            if name
                .get(start..)
                .is_some_and(|found| found.eq_ignore_ascii_case(end))
            {
                let separators = [' ', '_', '-', ',', ';'];
                name = name
                    .get(..start)
                    .unwrap_or_default()
                    .trim_end_matches(separators);
            }
        }
        if name == before {
            return name;
        }
    }
}
