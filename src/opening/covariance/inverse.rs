//! Inverses of symmetric positive definite matrices, scaled to a diagonal of ones first: metres and coefficients are far
//! apart.
//!
//! The large one is made by blocks (Gauss-Jordan elimination without pivots, which such a matrix does not need): what a block
//! leaves to do is one product of matrices on all processors, and between two blocks it can be cancelled.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixViewMut};
use rayon::prelude::*;

use crate::fault::Fault;
use crate::jobs::Progress;

/// Rows of a block. At so many the products take the time, not the copies.
const BLOCK: usize = 128;
/// Columns that one processor takes at once.
const COLUMNS: usize = 64;

/// Of a matrix of a few rows; `None` where it is not positive definite.
pub(super) fn small_inverse(mut matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = Scale::of(&matrix);
    scale.apply(&mut matrix);
    let mut inverse = matrix.cholesky()?.inverse();
    scale.apply(&mut inverse);
    Some(inverse)
}

/// Of a matrix of thousands of rows; `None` where it is not positive definite.
///
/// # Errors
/// Where it is cancelled.
pub(super) fn inverse(
    mut matrix: DMatrix<f64>,
    progress: &Progress,
) -> Result<Option<DMatrix<f64>>, Fault> {
    let size = matrix.nrows();
    let scale = Scale::of(&matrix);
    scale.apply(&mut matrix);
    for start in (0..size).step_by(BLOCK) {
        progress.advance(start as u64, size as u64)?;
        let block = start..size.min(start + BLOCK);
        if eliminate(&mut matrix, block).is_none() {
            return Ok(None);
        }
    }
    scale.apply(&mut matrix);
    Ok(Some(matrix))
}

/// Exchanges a block of the right side of y = A x for that of its left side; `None` where it is not positive definite.
fn eliminate(matrix: &mut DMatrix<f64>, block: Range<usize>) -> Option<()> {
    let size = matrix.nrows();
    let own = matrix.view_range(block.clone(), block.clone());
    let inverse = own.clone_owned().cholesky()?.inverse();
    // A - C P R, whose block of columns is that of the identity by then, is at once what is left of the others, and the
    // block's own rows and columns: so C's own part is one less.
    let mut columns = matrix.columns_range(block.clone()).into_owned();
    matrix.columns_range_mut(block.clone()).fill(0.0);
    for (column, row) in block.clone().enumerate() {
        columns[(row, column)] -= 1.0;
        matrix[(row, row)] = 1.0;
    }
    let rows = inverse * matrix.rows_range(block);
    let parts = matrix.as_mut_slice().par_chunks_mut(size * COLUMNS);
    parts.enumerate().for_each(|(number, part)| {
        let wide = part.len() / size;
        let rows = rows.columns(number * COLUMNS, wide);
        let mut part = DMatrixViewMut::from_slice(part, size, wide);
        part.gemm(-1.0, &columns, &rows, 1.0);
    });
    Some(())
}

/// What brings a diagonal to ones, from both sides.
struct Scale(Vec<f64>);

impl Scale {
    fn of(matrix: &DMatrix<f64>) -> Self {
        let diagonal = matrix.diagonal();
        Self(
            diagonal
                .map(|own| own.max(1e-300).sqrt().recip())
                .data
                .into(),
        )
    }

    /// Of a matrix and of its inverse it is the same.
    fn apply(&self, matrix: &mut DMatrix<f64>) {
        for (mut column, of_column) in matrix.column_iter_mut().zip(&self.0) {
            for (value, of_row) in column.iter_mut().zip(&self.0) {
                *value *= of_row * of_column;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second differences of a string held at both ends: the inverse is known, `min(i, j) (n + 1 - max(i, j)) / (n + 1)`.
    fn string(size: usize) -> DMatrix<f64> {
        DMatrix::from_fn(size, size, |row, column| match row.abs_diff(column) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        })
    }

    /// Of a part of a block, of whole ones, of more.
    #[test]
    fn inverse_of_a_string() {
        for size in [1, 40, BLOCK, 2 * BLOCK, 2 * BLOCK + 77] {
            let found = inverse(string(size), &Progress::default()).unwrap();
            let found = found.unwrap();
            let small = small_inverse(string(size)).unwrap();
            let whole = size as f64 + 1.0;
            for row in 0..size {
                for column in 0..size {
                    let (least, most) = (row.min(column) as f64, row.max(column) as f64);
                    let right = (least + 1.0) * (whole - (most + 1.0)) / whole;
                    for found in [&found, &small] {
                        let off = found[(row, column)] / right - 1.0;
                        assert!(off.abs() < 1e-9, "{size} {row} {column}: {off}");
                    }
                }
            }
        }
    }

    /// Rows of other units, and a matrix that has no inverse of its kind.
    #[test]
    fn units_and_signs() {
        let far = DMatrix::from_row_slice(2, 2, &[4e16, 1e8, 1e8, 1.0]);
        let found = inverse(far, &Progress::default()).unwrap().unwrap();
        // By hand: 1 / (4e16 - 1e16) of [1, -1e8; -1e8, 4e16].
        for (found, right) in found.iter().zip([1.0, -1e8, -1e8, 4e16]) {
            assert!((found / (right / 3e16) - 1.0).abs() < 1e-12, "{found}");
        }
        let saddle = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]);
        let found = inverse(saddle.clone(), &Progress::default()).unwrap();
        assert!(found.is_none() && small_inverse(saddle).is_none());
    }

    /// It stops between two blocks.
    #[test]
    fn it_can_be_cancelled() {
        let progress = Progress::default();
        progress.cancel();
        let fault = inverse(string(BLOCK + 1), &progress).unwrap_err();
        assert_eq!(fault.what, "cancelled");
    }
}
