//! How far each pixel lies within its fragment: exact distances (Felzenszwalb & Huttenlocher 2012).

use rayon::prelude::*;

use crate::labels::LabelImage;
use crate::transposed::transposed;

/// From the middle of each pixel to the outline of what it belongs to, pixels; the photo's edge is an outline.
pub(crate) fn distances(labels: &LabelImage) -> Vec<f64> {
    let (width, height) = (labels.width, labels.height);
    let at = |x: usize, y: usize| labels.labels[y * width + x];
    // Squared distances to the nearest pixel that has another one beside it.
    let far = ((width + height) * (width + height)) as f64;
    let mut squares: Vec<f64> = vec![far; width * height];
    squares
        .par_chunks_mut(width.max(1))
        .enumerate()
        .for_each(|(y, row)| {
            for (x, square) in row.iter_mut().enumerate() {
                let here = at(x, y);
                let edge = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
                if edge
                    || at(x - 1, y) != here
                    || at(x + 1, y) != here
                    || at(x, y - 1) != here
                    || at(x, y + 1) != here
                {
                    *square = 0.0;
                }
            }
        });
    squares
        .par_chunks_mut(width.max(1))
        .for_each(lower_envelope);
    let mut turned = transposed(&squares, width, height);
    turned
        .par_chunks_mut(height.max(1))
        .for_each(lower_envelope);
    let squares = transposed(&turned, height, width);
    // That pixel's middle is half a pixel within.
    squares
        .into_par_iter()
        .map(|square| square.sqrt() + 0.5)
        .collect()
}

/// Of each place the least of value + distance squared, by the lower envelope of parabolas.
fn lower_envelope(values: &mut [f64]) {
    let count = values.len();
    let (mut places, mut starts) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for (place, value) in values.iter().enumerate() {
        let q = place as f64;
        let start = loop {
            let Some(&last) = places.last() else {
                break f64::NEG_INFINITY;
            };
            let last: usize = last;
            let p = last as f64;
            // Where the two parabolas cross.
            let crossing = ((value + q * q) - (values[last] + p * p)) / (2.0 * (q - p));
            if starts.last().is_some_and(|start: &f64| crossing <= *start) {
                places.pop();
                starts.pop();
            } else {
                break crossing;
            }
        };
        places.push(place);
        starts.push(start);
    }
    let own = values.to_vec();
    let mut with = 0;
    for (place, value) in values.iter_mut().enumerate() {
        while starts
            .get(with + 1)
            .is_some_and(|start| *start < place as f64)
        {
            with += 1;
        }
        let from = places[with];
        let away = place as f64 - from as f64;
        *value = own[from] + away * away;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against all pixels, one by one.
    #[test]
    fn as_by_all_pixels() {
        let (width, height) = (37, 29);
        let of = |x: usize, y: usize| {
            u32::from((x as f64 - 17.3).hypot(y as f64 - 12.8) < 9.0) + 2 * u32::from(x > 30)
        };
        let labels = (0..width * height)
            .map(|place| of(place % width, place / width))
            .collect();
        let labels = LabelImage {
            width,
            height,
            labels,
        };
        let found = distances(&labels);
        let is_outline = |x: usize, y: usize| {
            let edge = x == 0 || y == 0 || x + 1 == width || y + 1 == height;
            edge || [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
                .iter()
                .any(|(a, b)| of(*a, *b) != of(x, y))
        };
        for y in 0..height {
            for x in 0..width {
                let mut least = f64::INFINITY;
                for b in 0..height {
                    for a in 0..width {
                        if is_outline(a, b) {
                            least = least.min((x as f64 - a as f64).hypot(y as f64 - b as f64));
                        }
                    }
                }
                assert!((found[y * width + x] - least - 0.5).abs() < 1e-9, "{x} {y}");
            }
        }
    }
}
