//! A weight for each size, from another column of a table with one line a point.

use std::path::Path;

use crate::FileError;
use crate::fault::Fault;
use crate::tables::table::{NumberRepairs, Table};

/// Weights of points by their size.
#[derive(Debug, Clone, PartialEq)]
pub struct PointWeights {
    /// [size, weight], sizes in the file's unit; no size twice.
    weights: Vec<[f64; 2]>,
}

impl PointWeights {
    /// The weights of these points [size, percent passing].
    ///
    /// # Errors
    /// Where a size has none.
    pub fn of(&self, points: &[[f64; 2]]) -> Result<Vec<f64>, Fault> {
        let weight = |&[size, _]: &[f64; 2]| {
            let found = self.weights.iter().find(|weight| weight[0] == size);
            found.map(|weight| weight[1]).ok_or_else(|| {
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
    let table = Table::read_file(path)?;
    point_weights(&table, size, weight).map_err(|fault| FileError::new(path, fault))
}

fn point_weights(
    table: &Table,
    size: &str,
    weight: &str,
) -> Result<(PointWeights, Vec<String>), Fault> {
    let (size_column, weight_column) = (table.column(size)?, table.column(weight)?);
    let mut repairs = NumberRepairs::default();
    let mut weights: Vec<[f64; 2]> = Vec::new();
    for row in table.rows() {
        // The reader of the sizes has said what was mended in them.
        let mut said = NumberRepairs::default();
        let Ok(Some((size, _))) = table.number_and_rest(row, size_column, &mut said) else {
            continue;
        };
        let Some(weight) = table.number(row, weight_column, &mut repairs)? else {
            continue;
        };
        if weight < 0.0 {
            let what = format!("column {}: a weight of {weight}", table.name(weight_column));
            let remedy = "give weights of 0 (not used) or more";
            return Err(Fault::at(row.line, what, remedy));
        }
        match weights.iter().find(|known| known[0] == size) {
            Some(known) if known[1] != weight => {
                let what = format!("size {size} has the weights {} and {weight}", known[1]);
                return Err(Fault::at(row.line, what, "give each size one weight"));
            }
            Some(_) => {}
            None => weights.push([size, weight]),
        }
    }
    Ok((PointWeights { weights }, repairs.warnings()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PointWeights, Fault> {
        Ok(point_weights(&Table::read(text)?, "size", "w")?.0)
    }

    #[test]
    fn by_size() {
        let weights = read("size,passing,w\n20,80,1\n10,20,0.5\n40,100,\n").unwrap();
        let of = weights.of(&[[10.0, 20.0], [20.0, 80.0]]).unwrap();
        assert_eq!(of, [0.5, 1.0]);
        let fault = weights.of(&[[40.0, 100.0]]).unwrap_err().to_string();
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
