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

use glam::{DVec2, DVec3};

use super::draws::Draws;
use super::holes::Line;
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

/// Which triangles of a cloud bridge what no photo saw, as one photo shows them.
#[derive(Debug, Clone)]
pub(super) struct Bridges {
    /// Row by row; those without a scale `None`.
    pixels: Vec<Option<Pixel>>,
    columns: usize,
    /// The median of their longest edges, world units.
    median: f64,
    /// The most that is hidden, a share of the depth.
    most: f64,
}

impl Bridges {
    /// In the field of a photo over a cloud, with the photo's plane (`surface_error::plane_of`).
    pub(super) fn in_field(field: &ScaleField, plane: DVec3) -> Self {
        let rows = field.grid.rows;
        let pixels = field.grid.cells().map(|(column, row)| {
            let depth = field.depth_at(column, row)?;
            Some(Pixel {
                down: (f64::from(row) + 0.5) / f64::from(rows),
                scale: field.scale_at(column, row)?,
                depth,
                edge: field.longest_edge_at(column, row)?,
                off_plane: depth * plane.dot(field.direction_at(column, row)?) - 1.0,
            })
        });
        Self::among(pixels.collect(), field.grid.columns as usize)
    }

    fn among(pixels: Vec<Option<Pixel>>, columns: usize) -> Self {
        let seen = || pixels.iter().flatten();
        let mut edges: Vec<f64> = seen().map(|pixel| pixel.edge).collect();
        let squares: f64 = seen().map(|pixel| pixel.off_plane.powi(2)).sum();
        let count = edges.len();
        let (median, most) = match count {
            // Of nothing that is seen nothing is a bridge.
            0 => (f64::INFINITY, 0.0),
            _ => (
                *edges.select_nth_unstable_by(count / 2, f64::total_cmp).1,
                MOST * (squares / count as f64).sqrt(),
            ),
        };
        Self {
            pixels,
            columns,
            median,
            most,
        }
    }

    /// What a triangle with this longest edge at this depth hides in the mean, a share of the depth; 0 of those that are no
    /// bridges.
    fn hidden(&self, edge: f64, depth: f64) -> f64 {
        let over = (edge - USUAL * self.median).max(0.0);
        (HIDDEN * over / depth).min(self.most)
    }

    /// How much deeper a single place on such a triangle lies, a share of the depth, as a draw: 0 of those that are no
    /// bridges, which take none.
    pub(super) fn draw(&self, edge: f64, depth: f64, draws: &mut Draws) -> f64 {
        let hidden = self.hidden(edge, depth);
        match hidden > 0.0 {
            true => hidden * (1.0 + SPREAD / HIDDEN * draws.normal()),
            false => 0.0,
        }
    }

    /// What the triangle at a place of the photo hides, shares of its depth, in the mean and as a standard deviation around
    /// it. The place is from (0, 0) at the photo's upper left to (1, 1) at its lower right; the cell of the fit's grid that
    /// it lies in stands for it.
    pub(super) fn at(&self, place: DVec2) -> [f64; 2] {
        let rows = self.pixels.len() / self.columns.max(1);
        // `as` saturates.
        let cell = |at: f64, count: usize| ((at * count as f64) as usize).min(count - 1);
        let hidden = (rows > 0)
            .then(|| cell(place.y, rows) * self.columns + cell(place.x, self.columns))
            .and_then(|index| *self.pixels.get(index)?)
            .map_or(0.0, |pixel| self.hidden(pixel.edge, pixel.depth));
        [hidden, SPREAD / HIDDEN * hidden]
    }

    /// What they do to the ends of the best line, pixels per world unit.
    pub(super) fn on_line(&self, [top, bottom]: [f64; 2]) -> Bridged {
        let mut whole = Line::default();
        for pixel in self.pixels.iter().flatten() {
            whole.add(pixel.down, 0.0);
        }
        // What each pixel does to top and bottom; nothing where it shows no bridge.
        let by_pixel = self.pixels.iter().map(|pixel| {
            let pixel = pixel.as_ref()?;
            let share = self.hidden(pixel.edge, pixel.depth);
            let [to_top, to_bottom] = whole.weights(pixel.down);
            let ends = [to_top / top, to_bottom / bottom].map(|end| end * share * pixel.scale);
            (pixel.edge > USUAL * self.median).then_some(ends)
        });
        let mut by_pixel: Vec<Option<[f64; 2]>> = by_pixel.collect();
        let (mut too_large, mut squares) = ([0.0; 2], 0.0);
        for first in 0..by_pixel.len() {
            let Some([top, bottom]) = take_bridge(&mut by_pixel, self.columns, first) else {
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

    fn of_pixels(pixels: &[Option<Pixel>], columns: usize, line: [f64; 2]) -> Bridged {
        Bridges::among(pixels.to_vec(), columns).on_line(line)
    }

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

    /// A place on an edge of 4 where others have 1, at the depth 20: deeper by a quarter of the edge in the mean, over what is
    /// usual, and seldom nearer than half of that. Edges as others have take no draw.
    #[test]
    fn a_place_on_a_bridge_lies_deeper() {
        let bridges = Bridges::among(pixels(2, |_, row| row > 300), 2);
        let mut draws = Draws::new(1);
        let drawn: Vec<f64> = (0..20_000)
            .map(|_| bridges.draw(4.0, 20.0, &mut draws))
            .collect();
        let count = drawn.len() as f64;
        let mean = drawn.iter().sum::<f64>() / count;
        let squares: f64 = drawn.iter().map(|share| (share - mean).powi(2)).sum();
        // 0.5 of 4 - 2, and 0.85 of it, over 20.
        assert!((mean - 0.05).abs() < 0.002, "{mean}");
        assert!(((squares / count).sqrt() - 0.085).abs() < 0.002);
        let mut untouched = Draws::new(1);
        let mut asked = Draws::new(1);
        for edge in [1.0, 2.0] {
            assert_eq!(bridges.draw(edge, 20.0, &mut asked), 0.0);
        }
        assert_eq!(asked.normal(), untouched.normal());
        // Row 300 of 400 is the last without.
        for (down, hidden) in [(0.752, 0.0), (0.753, 0.05), (1.0, 0.05)] {
            let [mean, spread] = bridges.at(DVec2::new(0.7, down));
            assert!((mean - hidden).abs() < 1e-12, "{down}: {mean}");
            assert!((spread - 1.7 * hidden).abs() < 1e-12, "{down}: {spread}");
        }
        assert_eq!(
            Bridges::among(Vec::new(), 2).draw(4.0, 20.0, &mut draws),
            0.0
        );
    }
}
