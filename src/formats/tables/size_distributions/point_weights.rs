//! A weight for each size, from another column of a table with one line a point.

use std::path::Path;

use super::size_text::{SizeText, sieve_mm};
use super::size_unit::SizeUnit;
use super::{DistributionColumns, below_titles, table_of};
use crate::FileError;
use crate::fault::Fault;
use crate::tables::table::{NumberRepairs, Table, read_bounded};
use crate::units::LengthUnit;

/// Sizes are the same that differ by less: of micrometres brought to mm.
const SAME: f64 = 1e-9;

/// Weights of points by their size.
#[derive(Debug, Clone, PartialEq)]
pub struct PointWeights {
    /// What sizes may be as they are written, and their weights; no size twice, fractions last.
    weights: Vec<(Vec<SizeText>, f64)>,
}

impl PointWeights {
    /// The weights of these points [size, percent passing] in `unit`, of which `factor` are one of the table's lengths
    /// ([`SizesRead`](super::SizesRead)).
    ///
    /// # Errors
    /// Where a size has none.
    pub fn of(
        &self,
        points: &[[f64; 2]],
        unit: LengthUnit,
        factor: f64,
    ) -> Result<Vec<f64>, Fault> {
        let in_unit = |of: SizeUnit| of.factor * of.unit.in_units_of(unit);
        // A name may be a sieve's and inches: "2 in." is 50 mm beside others of ASTM E11.
        let may_be = |text: &SizeText, size: f64| {
            let number = text
                .number
                .map(|(number, own)| number * own.map_or(factor, in_unit));
            let mm = SizeUnit::plain(LengthUnit::Millimetre);
            let sieve = text.sieve_mm.map(|of| of * in_unit(mm));
            [number, sieve]
                .into_iter()
                .flatten()
                .any(|of| (of / size - 1.0).abs() < SAME)
        };
        let weight = |&[size, _]: &[f64; 2]| {
            let is_it = |texts: &[SizeText]| texts.iter().any(|text| may_be(text, size));
            let found = self.weights.iter().find(|(texts, _)| is_it(texts));
            found.map(|(_, weight)| *weight).ok_or_else(|| {
                let what = format!("size {size} has no weight");
                Fault::new(what, "give every line a weight; 0 leaves a point out")
            })
        };
        points.iter().map(weight).collect()
    }
}

/// Reads the weights of a table's sizes, with what was mended. Curves share the weight of a size.
///
/// # Errors
/// Where a column is missing, where a weight is no number, and where a size has two different ones.
pub fn read_point_weights(
    path: &Path,
    size: &str,
    weight: &str,
) -> Result<(PointWeights, Vec<String>), FileError> {
    let (text, _) = read_bounded(path)?;
    point_weights(&text, size, weight).map_err(|fault| FileError::new(path, fault))
}

fn point_weights(
    text: &str,
    size: &str,
    weight: &str,
) -> Result<(PointWeights, Vec<String>), Fault> {
    let columns = DistributionColumns {
        size: Some(size.to_owned()),
        ..DistributionColumns::default()
    };
    // As the sizes are read: below the lines of a title.
    let whole = table_of(text);
    let has_both = |table: &Table| table.column(size).is_ok() && table.column(weight).is_ok();
    let table = match whole {
        Ok(table) if has_both(&table) => table,
        whole => match below_titles(text, &columns) {
            Some((table, _)) => table,
            None => whole?,
        },
    };
    let (size_column, weight_column) = (table.column(size)?, table.column(weight)?);
    let mut repairs = NumberRepairs::default();
    let mut weights: Vec<(Vec<SizeText>, f64)> = Vec::new();
    // What they are of, the reader of the sizes has found out; here they are whatever they can be, after what is sure.
    let mut of_fractions = Vec::new();
    for row in table.rows() {
        // The reader of the sizes has said what was mended in them.
        let mut said = NumberRepairs::default();
        let number = table
            .number_and_rest(row, size_column, &mut said)
            .ok()
            .flatten();
        let cell = row.cell(size_column);
        let fraction = SizeText::of_fraction(cell);
        let (size, known) = match fraction.is_empty() {
            true => {
                let size = SizeText {
                    number: number.map(|(number, rest)| (number, SizeUnit::of(rest))),
                    sieve_mm: sieve_mm(cell),
                };
                (vec![size], &mut weights)
            }
            false => (fraction, &mut of_fractions),
        };
        let is_none = |text: &SizeText| text.number.is_none() && text.sieve_mm.is_none();
        if size.iter().all(is_none) {
            continue;
        }
        let Some(weight) = table.number(row, weight_column, &mut repairs)? else {
            continue;
        };
        if weight < 0.0 {
            let what = format!("column {}: a weight of {weight}", table.name(weight_column));
            let remedy = "give weights of 0 (not used) or more";
            return Err(Fault::at(row.line, what, remedy));
        }
        match known.iter().find(|known| known.0 == size) {
            Some(known) if known.1 != weight => {
                let what = format!("size {cell} has the weights {} and {weight}", known.1);
                return Err(Fault::at(row.line, what, "give each size one weight"));
            }
            Some(_) => {}
            None => known.push((size, weight)),
        }
    }
    weights.extend(of_fractions);
    Ok((PointWeights { weights }, repairs.warnings()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MM: LengthUnit = LengthUnit::Millimetre;

    fn read(text: &str) -> Result<PointWeights, Fault> {
        Ok(point_weights(text, "size", "w")?.0)
    }

    /// In whatever unit the table is, below whatever title.
    #[test]
    fn sizes_are_those_that_are_read() {
        for (text, factor, points) in [
            ("size,passing,w\n4,20,1\n8,80,2\n", 0.001, [0.004, 0.008]),
            ("size,passing,w\n4 mm,20,1\n3.2 cm,80,2\n", 1.0, [4.0, 32.0]),
            (
                "size,passing,w\nNo. 4,20,1\n2 in.,80,2\n",
                1.0,
                [4.75, 50.0],
            ),
            (
                "Lab of the mine\nsize,passing,w\n4,20,1\n8,80,2\n",
                1.0,
                [4.0, 8.0],
            ),
            // Fractions of the table's unit, names of sieves, inches; after what is sure.
            ("size,passing,w\n1/2,20,1\n2 1/2,80,2\n", 1.0, [0.5, 2.5]),
            ("size,passing,w\n1/2,20,1\n2 in,80,2\n", 1.0, [12.5, 50.8]),
            (
                "size,passing,w\n15 3/4,20,1\n1/2 ft,80,2\n",
                1.0,
                [400.05, 152.4],
            ),
            ("size,passing,w\n1/2,20,1\n0.5,80,2\n", 1.0, [12.5, 0.5]),
            ("size,passing,w\n1 200,20,1\n8,80,2\n", 1.0, [1200.0, 8.0]),
        ] {
            let points = points.map(|size| [size, 50.0]);
            let found = read(text).unwrap().of(&points, MM, factor);
            assert_eq!(found.unwrap(), [1.0, 2.0], "{text}");
        }
    }

    #[test]
    fn by_size() {
        let weights = read("size,passing,w\n20,80,1\n10,20,0.5\n40,100,\n").unwrap();
        let of = weights.of(&[[10.0, 20.0], [20.0, 80.0]], MM, 1.0).unwrap();
        assert_eq!(of, [0.5, 1.0]);
        let fault = weights
            .of(&[[40.0, 100.0]], MM, 1.0)
            .unwrap_err()
            .to_string();
        assert!(fault.contains("size 40 has no weight"), "{fault}");
    }

    #[test]
    fn refuses_with_the_line() {
        for (text, sentence) in [
            ("size,w\n10,-1\n", "a weight of -1"),
            ("size,w\n5,1\n10,x\n", "'x' is not a number"),
            ("size,w\n10,1\n10,2\n", "the weights 1 and 2"),
        ] {
            let fault = read(text).unwrap_err();
            assert!(fault.line.is_some());
            assert!(fault.to_string().contains(sentence), "{fault}");
        }
    }
}
