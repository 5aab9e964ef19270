//! The pixels of a polygon.

use std::ops::Range;

use glam::DVec2;

/// Crossings of a row that are no further apart are one place, in pixels.
const SAME_PLACE: f64 = 1e-6;

/// The pixels whose centres lie in a polygon, row by row as spans of columns, cut at an image of
/// `width` x `height`. Its corners are in pixels, (0, 0) at the outer corner of the top left one; where its
/// outline crosses itself, what an odd number of turns goes about is inside.
pub fn spans_within(corners: &[DVec2], width: u32, height: u32, each: impl FnMut(u32, Range<u32>)) {
    spans_of_rings(&[corners], width, height, each);
}

/// The same of several rings together: what an odd number of them goes about is inside, so that a ring
/// within another is a hole. Whether rows show that an outline goes about itself twice, or once to the left and once to
/// the right: of one ring that tells that it crosses itself.
pub fn spans_of_rings<R: AsRef<[DVec2]>>(
    rings: &[R],
    width: u32,
    height: u32,
    mut each: impl FnMut(u32, Range<u32>),
) -> bool {
    let sides = rings.iter().flat_map(|ring| sides(ring.as_ref(), height));
    let mut sides: Vec<Side> = sides.collect();
    sides.sort_by_key(|side| side.rows.start);
    let mut waiting = sides.into_iter().peekable();
    let mut active: Vec<Side> = Vec::new();
    let mut crossings: Vec<(f64, i32)> = Vec::new();
    let mut turns = Turns::default();
    let mut row = 0;
    loop {
        match (active.is_empty(), waiting.peek()) {
            (true, None) => return turns.are_crossed,
            (true, Some(next)) => row = next.rows.start,
            (false, _) => {}
        }
        while let Some(side) = waiting.next_if(|side| side.rows.start <= row) {
            active.push(side);
        }
        crossings.clear();
        crossings.extend(active.iter().map(|side| side.crossing(row)));
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        turns.count(&crossings);
        for span in crossings.chunks_exact(2) {
            // The centres between the two. Casts of floats end at the limits of their type; NaN is 0.
            let from = (span[0].0 - 0.5).ceil().max(0.0) as u32;
            let to = ((span[1].0 - 0.5).ceil().max(0.0) as u32).min(width);
            if from < to {
                each(row, from..to);
            }
        }
        row += 1;
        active.retain(|side| side.rows.end > row);
    }
}

/// A side of a polygon that crosses the middles of rows.
#[derive(Debug)]
struct Side {
    from: DVec2,
    to: DVec2,
    rows: Range<u32>,
}

impl Side {
    /// Where it crosses the middle of a row: the column, and whether it leads down (1) or up (-1).
    fn crossing(&self, row: u32) -> (f64, i32) {
        let Self { from, to, .. } = self;
        let share = (f64::from(row) + 0.5 - from.y) / (to.y - from.y);
        let direction = if to.y > from.y { 1 } else { -1 };
        (from.x + (to.x - from.x) * share, direction)
    }
}

/// The sides of a ring that cross the middles of rows of an image.
fn sides(corners: &[DVec2], height: u32) -> impl Iterator<Item = Side> {
    // The first row whose middle is not above; casts of floats end at the limits of their type.
    let row = move |y: f64| ((y - 0.5).ceil().max(0.0) as u32).min(height);
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).filter_map(move |(from, to)| {
        let rows = row(from.y.min(to.y))..row(from.y.max(to.y));
        let (from, to) = (*from, *to);
        (!rows.is_empty()).then_some(Side { from, to, rows })
    })
}

/// How often outlines go about the places of rows.
#[derive(Debug, Default)]
struct Turns {
    /// The way around that was seen first.
    way: i32,
    are_crossed: bool,
}

impl Turns {
    /// Counts those of a row.
    fn count(&mut self, crossings: &[(f64, i32)]) {
        let mut turns = 0;
        for (at, (column, direction)) in crossings.iter().enumerate() {
            turns += direction;
            // Where corners of an outline touch, nothing lies between its sides.
            let next = crossings.get(at + 1).map_or(f64::INFINITY, |next| next.0);
            if turns == 0 || next - column < SAME_PLACE {
                continue;
            }
            if self.way == 0 {
                self.way = turns.signum();
            }
            self.are_crossed |= turns != self.way;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split_mix::SplitMix;

    fn pixels(rings: &[Vec<DVec2>], width: u32, height: u32) -> (Vec<[u32; 2]>, bool) {
        let mut found = Vec::new();
        let crossed = spans_of_rings(rings, width, height, |row, columns| {
            found.extend(columns.map(|column| [column, row]));
        });
        (found, crossed)
    }

    fn ring(corners: &[[f64; 2]]) -> Vec<DVec2> {
        corners.iter().copied().map(DVec2::from).collect()
    }

    /// By the crossing number of each pixel's centre (Franklin's PNPOLY), for random stars, some of which cross
    /// themselves, with corners far outside.
    #[test]
    fn what_lies_inside_is_as_point_by_point() {
        let mut random = SplitMix(7);
        let mut number = |most: f64| random.next() as f64 / u64::MAX as f64 * most;
        for _ in 0..50 {
            let corners = 3 + number(9.0) as usize;
            let rings: Vec<Vec<DVec2>> = (0..2)
                .map(|_| {
                    (0..corners)
                        .map(|_| DVec2::new(number(60.0) - 10.0, number(50.0) - 10.0))
                        .collect()
                })
                .collect();
            let mut expected = Vec::new();
            for row in 0..30 {
                for column in 0..40 {
                    let at = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                    let mut inside = false;
                    for ring in &rings {
                        for (i, a) in ring.iter().enumerate() {
                            let b = ring[(i + 1) % ring.len()];
                            let crosses = (a.y > at.y) != (b.y > at.y);
                            if crosses && at.x < (b.x - a.x) * (at.y - a.y) / (b.y - a.y) + a.x {
                                inside = !inside;
                            }
                        }
                    }
                    if inside {
                        expected.push([column, row]);
                    }
                }
            }
            assert_eq!(pixels(&rings, 40, 30).0, expected);
        }
    }

    #[test]
    fn outlines_that_cross_themselves_are_told() {
        let square = ring(&[[1.0, 1.0], [5.0, 1.0], [5.0, 5.0], [1.0, 5.0]]);
        let bow = ring(&[[1.0, 1.0], [9.0, 9.0], [9.0, 1.0], [1.0, 9.0]]);
        let twice: Vec<DVec2> = square.iter().chain(&square).copied().collect();
        // Two squares that touch at a corner, drawn as one outline.
        let pinched = ring(&[
            [1.0, 1.0],
            [3.0, 1.0],
            [3.0, 3.0],
            [5.0, 3.0],
            [5.0, 5.0],
            [3.0, 5.0],
            [3.0, 3.0],
            [1.0, 3.0],
        ]);
        for (ring, crossed, count) in [
            (square, false, 16),
            (bow, true, 32),
            (twice, true, 0),
            (pinched, false, 8),
        ] {
            let (found, is_crossed) = pixels(&[ring], 20, 20);
            assert_eq!((is_crossed, found.len()), (crossed, count));
        }
        assert_eq!(pixels(&[ring(&[])], 5, 5), (Vec::new(), false));
        assert_eq!(
            pixels(
                &[ring(&[[1e308, -1e308], [-1e308, 1e308], [f64::NAN, 3.0]])],
                5,
                5
            )
            .0
            .len()
                % 5,
            0
        );
    }
}
