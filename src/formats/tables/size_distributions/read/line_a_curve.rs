//! The layouts with a line a curve: a column each size, or each percent.

use std::collections::HashSet;

use super::Reader;
use super::cells::is_missing;
use crate::fault::Fault;
use crate::tables::size_distributions::label_columns::LabelColumns;
use crate::tables::size_distributions::layout::PercentColumn;
use crate::tables::size_distributions::names::{Role, role};
use crate::tables::size_distributions::raw::{RawCurve, RawPoint};
use crate::tables::size_distributions::size_text::SizeText;
use crate::tables::table::Row;
use crate::text::fields::shown;

impl Reader<'_> {
    /// A line a curve, named in the column `names` where there is such a one.
    pub(super) fn sizes_as_columns(
        &mut self,
        sizes: &[(usize, SizeText)],
        names: Option<usize>,
    ) -> Result<Vec<RawCurve>, Fault> {
        let taken: Vec<usize> = sizes.iter().map(|(column, _)| *column).collect();
        self.table.check_numbers_in_names(&taken)?;
        let sizes = self.sizes_in_names(sizes);
        self.a_line_a_curve(&taken, names, |reader, row| {
            if let Some(called) = names.map(|column| row.cell(column))
                && matches!(role(called), Role::Retained(_) | Role::PassingMass)
            {
                let what = format!("line '{}' is no percent passing", shown(called));
                let remedy = "give percent passing, or what stays on the sieves with a line for each of them";
                return Err(Fault::at(row.line, what, remedy));
            }
            let mut points = Vec::new();
            for &(column, size) in sizes.iter().take_while(|(column, _)| *column < row.len()) {
                if let Some((percent, percent_sign)) = reader.percent(row, column)? {
                    points.push(RawPoint {
                        line: row.line,
                        size,
                        percent,
                        percent_sign,
                    });
                }
            }
            Ok(points)
        })
    }

    pub(super) fn percentiles(
        &mut self,
        columns: &[PercentColumn],
    ) -> Result<Vec<RawCurve>, Fault> {
        let taken: Vec<usize> = columns.iter().map(|of| of.column).collect();
        self.a_line_a_curve(&taken, None, |reader, row| {
            let mut points = Vec::new();
            for &PercentColumn {
                column,
                percent,
                unit,
            } in columns.iter().take_while(|of| of.column < row.len())
            {
                if is_missing(row.cell(column)) {
                    continue;
                }
                if let Some(mut size) = reader.size(row, column)? {
                    if let Some((_, own)) = &mut size.number {
                        *own = own.or(unit);
                    }
                    points.push(RawPoint {
                        line: row.line,
                        size,
                        percent,
                        percent_sign: true,
                    });
                }
            }
            Ok(points)
        })
    }

    /// The curves of a table with one line each. Lines that no column names are called by their place.
    fn a_line_a_curve(
        &mut self,
        taken: &[usize],
        names: Option<usize>,
        mut points_of: impl FnMut(&mut Self, &Row) -> Result<Vec<RawPoint>, Fault>,
    ) -> Result<Vec<RawCurve>, Fault> {
        let mut labels = LabelColumns::of(self.table, self.columns, taken)?;
        labels.method = labels.method.or(names);
        let used: Vec<usize> = labels.all().chain(taken.iter().copied()).collect();
        self.say_unused(&used);
        let nameless = [labels.method, labels.trial, labels.photo]
            .iter()
            .all(Option::is_none);
        let several = self.table.rows().len() > 1;
        if nameless && several {
            let said = "no column names the curves: they are called by their lines";
            self.repairs.said.push(said.to_owned());
        }
        let mut seen = HashSet::new();
        let mut curves = Vec::new();
        for row in self.table.rows() {
            let points = points_of(self, row)?;
            if points.is_empty() {
                self.repairs.empty(row.line);
                continue;
            }
            let mut name = self.labels(row, labels);
            // As this program writes it below the photos.
            if name.photo == "all photos" && self.table.rows().len() > 1 {
                self.repairs.total(row.line);
                continue;
            }
            if nameless && several {
                name.photo = format!("line {}", row.line);
            } else if !seen.insert(name.clone()) {
                self.repairs.same_name(row.line);
                name.photo = format!("{} (line {})", name.photo, row.line);
            }
            curves.push(RawCurve {
                labels: name,
                weight: self.weight(row, labels)?,
                line: row.line,
                points,
                sieves: None,
            });
        }
        Ok(curves)
    }
}
