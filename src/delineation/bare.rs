//! Large pieces of a photo without any fragment.
//!
//! They may be fines, and are taken for some; a floor beside the pile looks the same to an engine, and makes a pile finer
//! than it is. So it is said.

use crate::labels::{FINES, LabelImage};
use crate::measures::circle_diameter;
use crate::tree::around;

/// Cells of the photo's longer side: what is between fragments has no cell to itself.
const CELLS: usize = 32;
/// From this share of the photo on a piece is worth a word.
const LARGE: f64 = 0.1;

/// That one piece without any fragment takes much of the photo, or is larger than any fragment: as a ball is that an engine
/// rightly takes for no rock.
pub(crate) fn bare(labels: &LabelImage) -> Option<String> {
    let said = if largest_bare(labels) > LARGE {
        "one piece of more than a tenth of the photo is without any fragment, and counts as fines; where it is floor and not fines, \
         exclude it (window, page Fragments, tool Exclude)"
    } else if largest_square(labels) > largest_across(labels) {
        "one piece without any fragment is larger than the largest fragment, and counts as fines; where it is a ball, floor or \
         another thing, exclude it (window, page Fragments, tool Exclude)"
    } else {
        return None;
    };
    Some(said.to_owned())
}

/// The diameter of the circle with the largest fragment's area, pixels; infinite where there is none.
fn largest_across(labels: &LabelImage) -> f64 {
    let largest = labels.areas().into_iter().skip(1).max();
    largest.map_or(f64::INFINITY, |pixels| circle_diameter(pixels as f64))
}

/// The side of the largest square in which every pixel is fines, pixels.
fn largest_square(labels: &LabelImage) -> f64 {
    // Of each column the side of the square that ends there: in the row above, then in this one.
    let mut above = vec![0_usize; labels.width + 1];
    let mut here = above.clone();
    let mut most = 0;
    for pixels in labels.labels.chunks_exact(labels.width.max(1)) {
        for (column, label) in pixels.iter().enumerate() {
            here[column + 1] = match *label == FINES {
                true => 1 + here[column].min(above[column]).min(above[column + 1]),
                false => 0,
            };
            most = most.max(here[column + 1]);
        }
        std::mem::swap(&mut above, &mut here);
    }
    most as f64
}

/// The share of the photo that its largest piece of cells takes of which every pixel is fines.
fn largest_bare(labels: &LabelImage) -> f64 {
    let side = labels.width.max(labels.height).div_ceil(CELLS).max(1);
    let [columns, rows] = [labels.width, labels.height].map(|length| length.div_ceil(side));
    let mut is_bare = vec![true; columns * rows];
    for (row, pixels) in labels.labels.chunks_exact(labels.width.max(1)).enumerate() {
        for (column, label) in pixels.iter().enumerate() {
            is_bare[row / side * columns + column / side] &= *label == FINES;
        }
    }
    let mut most = 0;
    for first in 0..is_bare.len() {
        let (mut count, mut open) = (0, vec![first]);
        while let Some(cell) = open.pop() {
            if !std::mem::take(&mut is_bare[cell]) {
                continue;
            }
            count += 1;
            open.extend(around(columns, rows, cell));
        }
        most = most.max(count);
    }
    most as f64 / is_bare.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::NOT_ROCK;

    /// A photo of which the left third is floor, beside fragments of 10 pixels with fines between them.
    #[test]
    fn a_floor_is_large_and_gaps_are_not() {
        let floor_to = |edge: usize, floor: u32| LabelImage {
            width: 320,
            height: 200,
            labels: (0..320 * 200)
                .map(|place| {
                    let (x, y) = (place % 320, place / 320);
                    let is_gap = x % 12 < 2 || y % 12 < 2;
                    match (x < edge, is_gap) {
                        (true, _) => floor,
                        (_, true) => FINES,
                        _ => 1 + (x / 12 + y / 12 * 30) as u32,
                    }
                })
                .collect(),
        };
        let share = largest_bare(&floor_to(110, FINES));
        assert!((share - 11.0 / 32.0).abs() < 1e-9, "{share}");
        assert!(bare(&floor_to(110, FINES)).is_some());
        assert_eq!(largest_bare(&floor_to(0, FINES)), 0.0);
        // A ball of 40 pixels among fragments of 10; one of the pixels of a fragment is none.
        let with_ball = |across: usize| {
            let mut labels = floor_to(0, FINES);
            for (place, label) in labels.labels.iter_mut().enumerate() {
                let (x, y) = ((place % 320).abs_diff(150), (place / 320).abs_diff(90));
                if 4 * (x * x + y * y) < across * across {
                    *label = FINES;
                }
            }
            labels
        };
        // Sides of the squares within: 40 / √2, and the gaps' two pixels beside it.
        let side = largest_square(&with_ball(40));
        assert!((27.0..=32.0).contains(&side), "{side}");
        let said = bare(&with_ball(40)).unwrap();
        assert!(said.contains("larger than the largest fragment"), "{said}");
        assert_eq!(bare(&with_ball(8)), None);
        // What was excluded is no fines.
        assert_eq!(bare(&floor_to(110, NOT_ROCK)), None);
    }
}
