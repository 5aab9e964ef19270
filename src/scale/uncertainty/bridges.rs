//! What the bridges of a cloud do to a photo's line.
//!
//! A cloud has no points where fewer than three photos look, and its triangulation bridges that: from the
//! top of one block to the next, over what lies between. So the longer a triangle is than most of its
//! photo, the deeper is what it hides, and the more its pixels' scale is too large. Of simulated piles, whose
//! true surface is known, depths are short by [`HIDDEN`] of what a triangle's longest edge has over
//! [`USUAL`] times the median one's in the mean. Each bridge hides an amount of its own: over a crest four tenths of
//! that, over a smooth ball less than nothing (it bulges through its chords). So bridges that hang together are
//! off together, by [`SPREAD`] of that, and those apart from each other are not: of many small ones, most of it
//! evens out in the line, of a crest across the photo nothing.
//!
//! Nothing is deeper than [`MOST`] times what is seen goes up and down (off the photo's plane): a level floor
//! with few points has long triangles, too, and hides nothing.
//!
//! The constants are fitted with those of `unseen`, which tells to what photos (what is hidden 0.38 to 0.46, the deviation 0.77
//! to 0.82), and taken somewhat larger, for benches, which have most of the bridges and need more of both. docs/scales.md's
//! coverage is of other piles (`benches/coverage.rs`).

use glam::DVec3;

use super::holes::Line;
use crate::scale::FittedScale;
use crate::scale::field::ScaleField;

/// Edges of so many times the median one are no bridges.
const USUAL: f64 = 2.0;

/// How deep it is under a bridge, over how far its longest edge is longer than that.
const HIDDEN: f64 = 0.5;

/// The standard deviation of what one bridge hides around that, over the same.
const SPREAD: f64 = 0.85;

/// The most that is hidden, over the root mean square of what the field's depths are off the photo's plane: from
/// the crests of a wave to its troughs it is 2.8 times that.
const MOST: f64 = 2.8;

/// What bridges do to the ends of a line, shares of its scales there.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Bridged {
    /// By how much top and bottom are too large, in the mean.
    pub(super) too_large: [f64; 2],
    /// The standard deviation around it, of either (root mean square of both).
    pub(super) spread: f64,
}

/// Of the line through a field over a cloud, with the photo's plane (`surface_error::plane_of`).
pub(super) fn of_bridges(field: &ScaleField, fitted: &FittedScale, plane: DVec3) -> Bridged {
    let rows = field.grid.rows;
    let places = field.grid.cells();
    let pixels = places.map(|(column, row)| {
        Some(Pixel {
            down: (f64::from(row) + 0.5) / f64::from(rows),
            scale: field.scale_at(column, row)?,
            depth: field.depth_at(column, row)?,
            edge: field.longest_edge_at(column, row)?,
            off_plane: field.depth_at(column, row)? * plane.dot(field.direction_at(column, row)?)
                - 1.0,
        })
    });
    let pixels: Vec<Option<Pixel>> = pixels.collect();
    of_pixels(
        &pixels,
        field.grid.columns as usize,
        [fitted.top, fitted.bottom],
    )
}

/// A pixel with a scale.
#[derive(Debug, Clone, Copy)]
struct Pixel {
    /// From 0 at the photo's top to 1 at its bottom.
    down: f64,
    /// Pixels per world unit.
    scale: f64,
    /// Along the optical axis, world units.
    depth: f64,
    /// The longest one of the triangle that it shows, world units.
    edge: f64,
    /// Its depth over the plane's, less 1.
    off_plane: f64,
}

/// Of pixels row by row, those without a scale `None`.
fn of_pixels(pixels: &[Option<Pixel>], columns: usize, line: [f64; 2]) -> Bridged {
    let seen = || pixels.iter().flatten();
    let mut edges: Vec<f64> = seen().map(|pixel| pixel.edge).collect();
    if edges.is_empty() {
        return Bridged::default();
    }
    let count = edges.len();
    let median = *edges.select_nth_unstable_by(count / 2, f64::total_cmp).1;
    let squares: f64 = seen().map(|pixel| pixel.off_plane.powi(2)).sum();
    let most = MOST * (squares / count as f64).sqrt();
    let mut whole = Line::default();
    for pixel in seen() {
        whole.add(pixel.down, 0.0);
    }
    // What each pixel does to top and bottom; nothing where it shows no bridge.
    let by_pixel = pixels.iter().map(|pixel| {
        let pixel = pixel.as_ref()?;
        let over = pixel.edge - USUAL * median;
        let share = (HIDDEN * over / pixel.depth).min(most);
        let [to_top, to_bottom] = whole.weights(pixel.down);
        let [top, bottom] = line;
        let ends = [to_top / top, to_bottom / bottom].map(|end| end * share * pixel.scale);
        (over > 0.0).then_some(ends)
    });
    let mut by_pixel: Vec<Option<[f64; 2]>> = by_pixel.collect();
    let (mut too_large, mut squares) = ([0.0; 2], 0.0);
    for first in 0..by_pixel.len() {
        let Some([top, bottom]) = take_bridge(&mut by_pixel, columns, first) else {
            continue;
        };
        too_large = [too_large[0] + top, too_large[1] + bottom];
        squares += (top * top + bottom * bottom) / 2.0;
    }
    // Of one row there is no line, and no fitted scale either.
    if !squares.is_finite() {
        return Bridged::default();
    }
    Bridged {
        too_large,
        spread: SPREAD / HIDDEN * squares.sqrt(),
    }
}

/// The sum over the bridge that a place belongs to: all pixels of bridges that hang together with it by their sides.
/// They are taken out.
fn take_bridge(
    by_pixel: &mut [Option<[f64; 2]>],
    columns: usize,
    first: usize,
) -> Option<[f64; 2]> {
    let mut sum = by_pixel.get_mut(first)?.take()?;
    let mut open = vec![first];
    while let Some(place) = open.pop() {
        let column = place % columns;
        let beside = [
            (column > 0).then(|| place - 1),
            (column + 1 < columns).then_some(place + 1),
            place.checked_sub(columns),
            Some(place + columns),
        ];
        for next in beside.into_iter().flatten() {
            if let Some([top, bottom]) = by_pixel.get_mut(next).and_then(Option::take) {
                sum = [sum[0] + top, sum[1] + bottom];
                open.push(next);
            }
        }
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: usize = 400;

    /// Longest edges of 1, and of 4 where `bridged` says so of a column and a row.
    fn pixels(columns: usize, bridged: impl Fn(usize, usize) -> bool) -> Vec<Option<Pixel>> {
        let pixels = (0..ROWS * columns).map(|place| {
            Some(Pixel {
                down: ((place / columns) as f64 + 0.5) / ROWS as f64,
                scale: 50.0,
                depth: 20.0,
                edge: match bridged(place % columns, place / columns) {
                    true => 4.0,
                    false => 1.0,
                },
                off_plane: 1.0,
            })
        });
        pixels.collect()
    }

    /// The least squares line through a step of the height h at 3/5 of the photo, by hand: its slope is
    /// 12 h ∫(v - 1/2) over the step, 1.44 h, its mean 0.4 h.
    #[test]
    fn bridges_over_the_lower_part_tilt_the_line() {
        let mut pixels = pixels(1, |_, row| row >= 240);
        let bridged = of_pixels(&pixels, 1, [50.0, 50.0]);
        let height = HIDDEN * (4.0 - USUAL) / 20.0;
        let [top, bottom] = bridged.too_large;
        assert!((top / height + 0.32).abs() < 1e-4, "{top}");
        assert!((bottom / height - 1.12).abs() < 1e-4, "{bottom}");
        let both = ((0.32_f64.powi(2) + 1.12_f64.powi(2)) / 2.0).sqrt();
        let spread = bridged.spread / (SPREAD * (4.0 - USUAL) / 20.0);
        assert!((spread - both).abs() < 1e-4, "{spread}");
        // Of a plane nothing is hidden.
        for pixel in pixels.iter_mut().flatten() {
            pixel.off_plane = 0.0;
        }
        let smooth = of_pixels(&pixels, 1, [50.0, 50.0]);
        assert_eq!((smooth.too_large, smooth.spread), ([0.0; 2], 0.0));
    }

    /// Four bridges apart hide as much as one of their size in the mean, but each an amount of its own: half the
    /// deviation. What a hole parts is apart, too.
    #[test]
    fn bridges_apart_even_out() {
        let of = |pixels: &[Option<Pixel>]| of_pixels(pixels, 9, [50.0, 50.0]);
        let one = of(&pixels(9, |column, row| column < 4 && row >= 240));
        let four = of(&pixels(9, |column, row| column % 2 == 1 && row >= 240));
        for (one, four) in one.too_large.into_iter().zip(four.too_large) {
            assert!((one - four).abs() < 1e-12, "{one} {four}");
        }
        assert!((one.spread / four.spread - 2.0).abs() < 1e-9);
        let mut parted = pixels(9, |column, row| column < 5 && row >= 240);
        for place in (2..parted.len()).step_by(9) {
            parted[place] = None;
        }
        let halves = of(&parted);
        // The whole line then rests on eight columns instead of nine.
        assert!((halves.too_large[1] / one.too_large[1] - 9.0 / 8.0).abs() < 1e-9);
        assert!((halves.spread / one.spread - 9.0 / 8.0 / 2_f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn edges_of_a_kind_are_no_bridges() {
        let pixels = [0.1, 0.9].map(|down| {
            Some(Pixel {
                down,
                scale: 50.0,
                depth: 20.0,
                edge: 1.0 + down,
                off_plane: 1.0,
            })
        });
        assert_eq!(of_pixels(&pixels, 1, [50.0, 50.0]).too_large, [0.0; 2]);
        assert_eq!(of_pixels(&[], 1, [50.0, 50.0]), Bridged::default());
    }
}
