//! Smoothing by boxes: three passes are nearly a Gauss bell.

use rayon::prelude::*;

use crate::transposed::transposed;

/// Three box means of `2 * radius + 1` pixels along both axes; beyond the edge the photo goes on as its
/// last pixel. Deviation: sqrt(radius (radius + 1)).
pub(crate) fn smoothed(values: &[u8], width: usize, height: usize, radius: usize) -> Vec<u8> {
    let floats: Vec<f32> = values.iter().map(|value| f32::from(*value)).collect();
    let smooth = smoothed_floats(floats, width, height, radius);
    smooth
        .into_iter()
        .map(|value| value.round() as u8)
        .collect()
}

/// The same of floats.
pub(crate) fn smoothed_floats(
    mut values: Vec<f32>,
    width: usize,
    height: usize,
    radius: usize,
) -> Vec<f32> {
    if radius == 0 || width == 0 || height == 0 {
        return values;
    }
    box_means(&mut values, width, radius);
    // Columns as rows.
    let mut turned = transposed(&values, width, height);
    box_means(&mut turned, height, radius);
    transposed(&turned, height, width)
}

/// Three box means along each row.
fn box_means(values: &mut [f32], width: usize, radius: usize) {
    values.par_chunks_mut(width).for_each_init(
        || vec![0.0; width],
        |line, row| {
            for _ in 0..3 {
                box_mean(row, line, radius);
                row.copy_from_slice(line);
            }
        },
    );
}

fn box_mean(row: &[f32], out: &mut [f32], radius: usize) {
    let last = row.len() - 1;
    // Beyond both ends it goes on as the last.
    let at = |place: usize| f64::from(row[place.min(last)]);
    let mut sum: f64 = (0..=2 * radius)
        .map(|place| at(place.saturating_sub(radius)))
        .sum();
    let share = 1.0 / (2 * radius + 1) as f64;
    for (place, mean) in out.iter_mut().enumerate() {
        *mean = (sum * share) as f32;
        sum += at(place + radius + 1) - at(place.saturating_sub(radius));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point becomes a bell of the stated deviation whose sum is the point; what is even stays so.
    #[test]
    fn a_point_becomes_a_bell() {
        let (width, height, radius) = (41, 35, 2);
        let mut values = vec![0.0; width * height];
        values[17 * width + 20] = 1000.0;
        let bell = smoothed_floats(values, width, height, radius);
        let (mut sum, mut across) = (0.0, 0.0);
        for (place, value) in bell.iter().enumerate() {
            let off = (place % width) as f32 - 20.0;
            sum += value;
            across += value * off * off;
        }
        assert!((sum - 1000.0).abs() < 0.01, "{sum}");
        let wanted = (radius * (radius + 1)) as f32;
        assert!((across / sum - wanted).abs() < 0.01, "{}", across / sum);
        let even = smoothed(&[7; 12], 4, 3, 3);
        assert_eq!(even, [7; 12]);
    }
}
