//! The two nearest descriptors of each descriptor, as products of matrices.
//!
//! Descriptors are 128 bytes; a product of two is a whole number below 128 · 255² < 2^24, and so is every
//! sum on the way: f32 holds them exactly, whatever the order. The kernel is `matrixmultiply`'s (through
//! nalgebra), which takes the processor's widest registers at run time.

use cumulus3d_matching::{MatcherBackend, Top2};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Bytes of a descriptor.
pub(super) const LENGTH: usize = 128;
/// How long a descriptor is as a vector.
pub(super) const NORM: f64 = 512.0;

/// Radians between two descriptors, of their product.
pub(super) fn radians(product: u32) -> f64 {
    (f64::from(product) / (NORM * NORM)).min(1.0).acos()
}

/// Rows that one thread works on at a time, and columns: their products stay in the cache.
const ROWS: usize = 256;
const COLUMNS: usize = 256;

/// Compares descriptors by products of matrices.
pub(super) struct Products;

impl MatcherBackend for Products {
    fn top2(&self, d1: &[u8], n1: usize, d2: &[u8], n2: usize) -> (Vec<Top2>, Vec<Top2>) {
        let number = |byte: &u8| f32::from(*byte);
        let first = DMatrix::from_row_iterator(n1, LENGTH, d1.iter().map(number));
        let second = DMatrix::from_iterator(LENGTH, n2, d2.iter().map(number));
        let starts: Vec<usize> = (0..n1).step_by(ROWS).collect();
        let parts: Vec<(Vec<Top2>, Vec<Top2>)> = starts
            .into_par_iter()
            .map(|start| {
                let rows = ROWS.min(n1 - start);
                let block = first.rows(start, rows).into_owned();
                block_top2(&block, start, &second)
            })
            .collect();
        let mut rows = Vec::with_capacity(n1);
        let mut columns = vec![Top2::default(); n2];
        for (part_rows, part_columns) in parts {
            rows.extend(part_rows);
            for (all, part) in columns.iter_mut().zip(&part_columns) {
                all.merge(part);
            }
        }
        (rows, columns)
    }
}

/// Of a block of rows that begins at `start`.
fn block_top2(block: &DMatrix<f32>, start: usize, second: &DMatrix<f32>) -> (Vec<Top2>, Vec<Top2>) {
    let (height, n2) = (block.nrows(), second.ncols());
    let mut rows = vec![Top2::default(); height];
    let mut columns = vec![Top2::default(); n2];
    // The second best of each row as a number to compare with: most products are below it.
    let mut least = vec![0.0_f32; height];
    let mut products = DMatrix::zeros(height, COLUMNS);
    for from in (0..n2).step_by(COLUMNS) {
        let width = COLUMNS.min(n2 - from);
        let mut part = products.columns_mut(0, width);
        part.gemm(1.0, block, &second.columns(from, width), 0.0);
        for (column, values) in part.column_iter().enumerate() {
            let values = values.as_slice();
            let place = from + column;
            // (Whole numbers below 2^24; places of a photo's features fit.)
            let best = &mut columns[place];
            let mut second_best = best.second as f32;
            for (row, (&value, least)) in values.iter().zip(&mut least).enumerate() {
                if value > *least {
                    rows[row].push(value as u32, place as u32);
                    *least = rows[row].second as f32;
                }
                if value > second_best {
                    best.push(value as u32, (start + row) as u32);
                    second_best = best.second as f32;
                }
            }
        }
    }
    (rows, columns)
}

#[cfg(test)]
mod tests {
    use cumulus3d_matching::descriptor::top2_naive;

    use super::*;
    use fragscale_core::split_mix::SplitMix;

    /// To the bit what one product after the other gives, of any count, with ties.
    #[test]
    fn nearest_two_are_those_of_single_products() {
        let mut random = SplitMix(3);
        for (n1, n2) in [(1, 1), (0, 5), (7, 300), (300, 513), (257, 256)] {
            let mut bytes = |count: usize, step: u64| -> Vec<u8> {
                let byte = |_| ((random.next() >> 20) % step * (255 / (step - 1))) as u8;
                (0..count * LENGTH).map(byte).collect()
            };
            for step in [2, 256] {
                let (d1, d2) = (bytes(n1, step), bytes(n2, step));
                let expected = top2_naive(&d1, n1, &d2, n2);
                assert_eq!(Products.top2(&d1, n1, &d2, n2), expected, "{n1} {n2}");
            }
        }
        // The largest products there are.
        let (d1, d2) = (vec![255; 2 * LENGTH], vec![255; 3 * LENGTH]);
        assert_eq!(Products.top2(&d1, 2, &d2, 3), top2_naive(&d1, 2, &d2, 3));
    }
}
