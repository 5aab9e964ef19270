//! Pixels of a depth map that stand out before something farther within the search's window.
//!
//! A window at a silhouette shows two surfaces, and what matches is the nearer one's texture: so the nearer surface is found up to
//! half a window too wide ("foreground fattening": Scharstein & Szeliski, "A taxonomy and evaluation of dense two-frame stereo
//! correspondence algorithms", IJCV 47, 2002), in all photos alike, and gaps between stones close. Whether a pixel that has something
//! farther within half a window is of the nearer surface nobody knows: no point is made of it, and the surface goes over the edge
//! between what is sure on both sides. On a simulated survey (docs/reconstruct.md), on which the numbers below were chosen, lines were
//! 0.41 ± 0.25 % too large with these pixels, 0.27 ± 0.18 % without.

use rayon::prelude::*;

/// How much farther than the pixel's own plane, in pixels of matching: noise was 0.15 of one there.
const FARTHER: f32 = 0.75;

/// How many pixels have to be: one alone is a depth that was not found rightly.
const SEVERAL: usize = 3;

/// Which pixels of a map these are, row by row. `inverse_depths` and `slopes` are its planes (see [`crate::DepthMap`]), `reach` is half
/// a window, and `per_pixel` the inverse depth that a pixel of matching is.
pub(crate) fn before_farther(
    [width, height]: [usize; 2],
    inverse_depths: &[f32],
    slopes: &[[f32; 2]],
    reach: usize,
    per_pixel: f32,
) -> Vec<bool> {
    let of_row = |row: usize| {
        let rows = row.saturating_sub(reach)..height.min(row + reach + 1);
        (0..width).map(move |column| {
            let (own, [right, down]) = {
                let at = row * width + column;
                (inverse_depths[at] - FARTHER * per_pixel, slopes[at])
            };
            let columns = column.saturating_sub(reach)..width.min(column + reach + 1);
            let farther = rows.clone().flat_map(|y| {
                let own = own + down * (y as f32 - row as f32);
                columns.clone().filter(move |x| {
                    let own = own + right * (*x as f32 - column as f32);
                    inverse_depths[y * width + x] < own
                })
            });
            farther.take(SEVERAL).count() == SEVERAL
        })
    };
    (0..height).into_par_iter().flat_map_iter(of_row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something that stands twice as near, in columns 0 to 5, before a plane that is inclined: the last three columns are, and none
    /// of the plane behind, however inclined. A step of less than what noise may make is none.
    #[test]
    fn what_stands_out_is_not_sure_at_its_edge() {
        let (size, slope) = ([12, 7], [0.004, -0.002]);
        let plane = |x: usize, y: usize| 0.1 + slope[0] * x as f32 + slope[1] * y as f32;
        let edges = |step: f32| {
            let of = |at: usize| {
                let (x, y) = (at % size[0], at / size[0]);
                plane(x, y) + if x < 6 { step } else { 0.0 }
            };
            let depths: Vec<f32> = (0..size[0] * size[1]).map(of).collect();
            before_farther(size, &depths, &vec![slope; depths.len()], 3, 0.01)
        };
        let row: Vec<bool> = (0..size[0]).map(|x| (3..6).contains(&x)).collect();
        for found in edges(0.1).chunks(size[0]) {
            assert_eq!(found, row);
        }
        assert!(!edges(0.007).contains(&true));
        // Nor is what stands behind, seen through a hole in front.
        assert!(!edges(-0.1)[..6].contains(&true));
    }
}
