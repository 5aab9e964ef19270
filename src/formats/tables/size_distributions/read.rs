//! The points of a table in each layout.

use std::collections::{HashMap, HashSet};

use super::DistributionColumns;
use super::curves::{Repairs, SizeReading, SizesRead, finish, refuse_classes_by_sum};
use super::layout::{LabelColumns, Layout, PercentColumn};
use super::names::{
    Role, counts_fragments, holds_astm_numbers, holds_sieve_numbers, is_amount, names_percent,
    role, sample_of, weight_factor,
};
use super::names_of_sizes::{fractions_of_stated_unit, refuse_names_of_sizes, unknown};
use super::raw::{OnSieves, RawCurve, RawPoint};
use super::retained::{is_no_sieve, is_pan, is_result, is_total, is_washed, names_pan};
use super::size_text::{SizeText, fraction_of_inches, fraction_of_unit, sieve_mm};
use super::size_unit::SizeUnit;
use super::unit_above::Above;
use crate::fault::Fault;
use crate::fragmentation::Labels;
use crate::tables::table::{OR_LEAVE_OUT, Row, Table, number_and_unit};
use crate::text::fields::shown;
use crate::units::LengthUnit;

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

/// A cell of sizes; where it is empty, the cell beside it that says why: "Pan" and "Total" stand under the names of sieves, in ASTM
/// C136's sheet.
fn size_cell(row: &Row, column: usize) -> &str {
    let cell = row.cell(column);
    if !is_missing(cell) {
        return cell;
    }
    let cells = (0..row.len()).map(|column| row.cell(column));
    cells
        .into_iter()
        .find(|cell| is_no_sieve(cell))
        .unwrap_or(cell)
}

/// What stands where a number is not known.
fn is_missing(cell: &str) -> bool {
    let cell = cell.to_lowercase();
    matches!(cell.as_str(), "" | "na" | "n/a" | "nan" | "-" | "–" | "—")
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
    /// A size in a cell; `None` for a sieve's pan and a line of sums.
    fn size(&mut self, row: &Row, column: usize) -> Result<Option<SizeText>, Fault> {
        let cell = size_cell(row, column);
        if is_pan(cell) {
            self.repairs.pan(row.line);
            return Ok(None);
        }
        if is_total(cell) {
            self.repairs.total(row.line);
            return Ok(None);
        }
        if is_result(cell) {
            self.repairs.result(row.line);
            return Ok(None);
        }
        if is_missing(cell) {
            let what = format!("column {} has no size", self.table.name(column));
            return Err(Fault::at(
                row.line,
                what,
                format!("fill it in{OR_LEAVE_OUT}"),
            ));
        }
        match fraction_of_unit(cell) {
            Some((number, unit @ Some(_))) => return Ok(Some(SizeText::of_number(number, unit))),
            Some((number, None)) if self.is_of_its_unit(column) => {
                self.repairs.fraction(row.line);
                return Ok(Some(SizeText::of_number(number, None)));
            }
            _ => {}
        }
        let sieve_mm = match self.holds_astm_numbers.get(column) {
            Some(true) if cell.starts_with(|c: char| c.is_ascii_digit()) => {
                sieve_mm(&format!("No. {cell}"))
            }
            _ => sieve_mm(cell),
        };
        if let (None, Some(inches)) = (sieve_mm, fraction_of_inches(cell)) {
            let number = Some((inches, Some(SizeUnit::plain(LengthUnit::Inch))));
            return Ok(Some(SizeText { number, sieve_mm }));
        }
        let number = self
            .table
            .number_and_rest(row, column, &mut self.repairs.numbers);
        let number = match number {
            // A name that is no number alone.
            Err(_) if sieve_mm.is_some() => None,
            Ok(Some((_, rest))) if sieve_mm.is_some() && SizeUnit::of(rest).is_none() => None,
            found => found?,
        };
        let number = match number {
            Some((_, ""))
                if sieve_mm.is_none() && self.holds_sieve_numbers.get(column) == Some(&true) =>
            {
                let what = format!("'{}' is the number of a sieve, no size", shown(cell));
                let remedy = format!(
                    "write 'No. {cell}' where it is one of ASTM E11, else its opening with a unit"
                );
                return Err(Fault::at(row.line, what, remedy));
            }
            Some((number, "")) => Some((number, None)),
            Some((number, rest)) => match SizeUnit::of(rest) {
                Some(unit) => Some((number, Some(unit))),
                None => return Err(self.table.no_number(row, column)),
            },
            None => None,
        };
        Ok(Some(SizeText { number, sieve_mm }))
    }

    fn is_of_its_unit(&self, column: usize) -> bool {
        self.fractions_are_of_its_unit.get(column) == Some(&true)
    }

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

    /// A percent in a cell, with whether a percent sign stands behind it; `None` where it is not known.
    fn percent(&mut self, row: &Row, column: usize) -> Result<Option<(f64, bool)>, Fault> {
        if is_missing(row.cell(column)) {
            return Ok(None);
        }
        let found = self
            .table
            .number_and_rest(row, column, &mut self.repairs.numbers)?;
        match found {
            None => Ok(None),
            Some((percent, "")) => Ok(Some((percent, false))),
            Some((percent, "%")) => Ok(Some((percent, true))),
            Some(_) => Err(self.table.no_number(row, column)),
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

    /// A line a point: what passes, or what stays on the `sieves`, in a column of each sample.
    fn long(
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

    fn wide(&mut self, size: usize) -> Result<Vec<RawCurve>, Fault> {
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

    /// A line a curve, named in the column `names` where there is such a one.
    fn sizes_as_columns(
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

    /// The sizes in the names of columns. A fraction without a unit is of the one that is stated, else of the one that all others have.
    fn sizes_in_names(&mut self, sizes: &[(usize, SizeText)]) -> Vec<(usize, SizeText)> {
        let table = self.table;
        let name = |column: usize| table.header().get(column).map_or("", String::as_str);
        let fraction = |column: usize| match fraction_of_unit(name(column)) {
            Some((number, None)) => Some(number),
            _ => None,
        };
        let mut others = (sizes.iter())
            .filter(|(column, _)| fraction(*column).is_none())
            .map(|(_, size)| size.number.and_then(|(_, unit)| unit));
        let first = others.next().flatten();
        let is_of_all = |first: &SizeUnit| others.all(|unit| unit == Some(*first));
        let of_all = first
            .filter(|first| first.unit != LengthUnit::Inch)
            .filter(is_of_all);
        let line = table.header_line();
        let mut found = Vec::with_capacity(sizes.len());
        for &(column, size) in sizes {
            let unit = match self.is_of_its_unit(column) {
                true => Some(None),
                false => of_all.map(Some),
            };
            if let (Some(unit), Some(number)) = (unit, fraction(column)) {
                self.repairs.fraction(line);
                found.push((column, SizeText::of_number(number, unit)));
                continue;
            }
            if let (Some(_), Some((number, true, _))) = (size.number, number_and_unit(name(column)))
            {
                let numbers = &mut self.repairs.numbers;
                numbers.thousands_apart(line, name(column), number);
            }
            found.push((column, size));
        }
        found
    }

    fn percentiles(&mut self, columns: &[PercentColumn]) -> Result<Vec<RawCurve>, Fault> {
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
