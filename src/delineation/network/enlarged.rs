//! Values of a smaller picture at the size of a larger one.

use rayon::prelude::*;

/// Linear between the middles of pixels; `values` row by row.
pub(crate) fn enlarged(
    values: Vec<f32>,
    from: (u32, u32),
    (to_width, to_height): (u32, u32),
) -> Vec<f32> {
    if from == (to_width, to_height) {
        return values;
    }
    let to = (to_width as usize, to_height as usize);
    enlarged_part(&values, (from.0 as usize, from.1 as usize), to)
}

/// The same of counts; nothing of nothing.
pub(crate) fn enlarged_part(
    values: &[f32],
    (columns, rows): (usize, usize),
    (to_width, to_height): (usize, usize),
) -> Vec<f32> {
    let mut large = vec![0.0; to_width * to_height];
    if columns == 0 || rows == 0 || values.len() < columns * rows || large.is_empty() {
        return large;
    }
    let place = |to: usize, size: usize, to_size: usize| {
        let at = (to as f32 + 0.5) * size as f32 / to_size as f32 - 0.5;
        let at = at.clamp(0.0, (size - 1) as f32);
        let first = at as usize;
        (first, (first + 1).min(size - 1), at - first as f32)
    };
    let across: Vec<_> = (0..to_width).map(|x| place(x, columns, to_width)).collect();
    large
        .par_chunks_mut(to_width)
        .enumerate()
        .for_each(|(y, row)| {
            let (above, below, down) = place(y, rows, to_height);
            let (above, below) = (&values[above * columns..], &values[below * columns..]);
            for (value, &(left, right, along)) in row.iter_mut().zip(&across) {
                let mix = |line: &[f32]| line[left] + (line[right] - line[left]) * along;
                let (one, other) = (mix(above), mix(below));
                *value = one + (other - one) * down;
            }
        });
    large
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A slope stays a slope, but for the half pixel at its ends, where there is nothing to go on from.
    #[test]
    fn a_slope_stays_one() {
        let slope: Vec<f32> = (0..8).map(|x| x as f32).collect();
        let large = enlarged(slope.clone(), (8, 1), (16, 1));
        for (x, value) in large.iter().enumerate() {
            let wanted = ((x as f32 + 0.5) / 2.0 - 0.5).clamp(0.0, 7.0);
            assert!((value - wanted).abs() < 1e-6, "{x}: {value}");
        }
        assert_eq!(enlarged(slope.clone(), (8, 1), (8, 1)), slope);
        assert_eq!(enlarged_part(&[], (0, 3), (2, 2)), [0.0; 4]);
    }
}
