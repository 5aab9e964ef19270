//! Columns as rows, so that what works along rows works along both.

use rayon::prelude::*;

/// What stands row by row, column by column.
pub(crate) fn transposed<T: Copy + Default + Send + Sync>(
    values: &[T],
    width: usize,
    height: usize,
) -> Vec<T> {
    let mut turned = vec![T::default(); values.len()];
    turned
        // Whole lines of the cache at a time.
        .par_chunks_mut(height.max(1) * 16)
        .enumerate()
        .for_each(|(band, columns)| {
            for row in 0..height {
                for (column, part) in columns.chunks_mut(height.max(1)).enumerate() {
                    part[row] = values[row * width + band * 16 + column];
                }
            }
        });
    turned
}
