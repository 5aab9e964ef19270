//! Lines of equal value through a grid, by marching squares: over a scale field they say where one scale
//! holds.
//!
//! A value belongs to its place of the grid, (column, row); between the places it is bilinear along the
//! edges of the cells, and lines are straight across a cell. Where one of a cell's four places has no
//! value, no line goes through the cell: nothing is filled in.

use std::collections::HashMap;

use glam::DVec2;

use crate::numbers::round_down;

/// A line of equal value.
#[derive(Debug, Clone, PartialEq)]
pub struct Isoline {
    /// The value along it.
    pub level: f64,
    /// Its points, (column, row) of the grid; the first one again at the end where it is closed.
    pub points: Vec<DVec2>,
}

/// At most `most` round values (whole multiples of 1, 2 or 5 times a power of ten) inside a range; none
/// where the range is empty or not finite.
pub fn round_levels([low, high]: [f64; 2], most: u32) -> Vec<f64> {
    let span = high - low;
    // One more value than steps fits into a range.
    let least = span / f64::from(most.max(2) - 1);
    // The smallest round step that is no smaller: 10 over the largest round number within 10 / step.
    let Some(inverse) = round_down(1.0 / least) else {
        return Vec::new();
    };
    let step = 1.0 / inverse;
    let (first, last) = ((low / step).ceil(), (high / step).floor());
    (0..most)
        .map(|place| first + f64::from(place))
        .take_while(|multiple| *multiple <= last)
        // Divided by the inverse where that is whole: 0.3, not 0.30000000000000004.
        .map(|multiple| match inverse >= 1.0 {
            true => multiple / inverse,
            false => multiple * step.round(),
        })
        .collect()
}

/// An edge between two neighbouring places: from (column, row) to the right, or down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Edge {
    column: u32,
    row: u32,
    is_down: bool,
}

/// The lines of equal value at these levels. `value` says what is at a column and a row.
pub fn isolines(
    columns: u32,
    rows: u32,
    value: impl Fn(u32, u32) -> Option<f64>,
    levels: &[f64],
) -> Vec<Isoline> {
    let mut lines = Vec::new();
    for &level in levels {
        let mut segments = Vec::new();
        for row in 0..rows.saturating_sub(1) {
            for column in 0..columns.saturating_sub(1) {
                let at = |across: u32, down: u32| value(column + across, row + down);
                let (Some(a), Some(b), Some(c), Some(d)) = (at(0, 0), at(1, 0), at(1, 1), at(0, 1))
                else {
                    continue;
                };
                cell([column, row], [a, b, c, d], level, &mut segments);
            }
        }
        let point = |edge: Edge| crossing(edge, &value, level);
        lines.extend(chained(&segments).into_iter().map(|edges| Isoline {
            level,
            points: edges.into_iter().filter_map(point).collect(),
        }));
    }
    lines
}

/// The segments of one cell; its places clockwise from the top left.
fn cell([column, row]: [u32; 2], values: [f64; 4], level: f64, segments: &mut Vec<[Edge; 2]>) {
    let edge = |column: u32, row: u32, is_down: bool| Edge {
        column,
        row,
        is_down,
    };
    // Clockwise from the top, each between its place and the next one.
    let edges = [
        edge(column, row, false),
        edge(column + 1, row, true),
        edge(column, row + 1, false),
        edge(column, row, true),
    ];
    // What is on the level counts as above: a line never goes through a corner twice.
    let above = values.map(|value| value >= level);
    let mut crossed = (0..4_usize).filter(|&side| above[side] != above[(side + 1) % 4]);
    let crossed = [0; 4].map(|_: u8| crossed.next());
    match crossed {
        [Some(a), Some(b), None, None] => segments.push([edges[a], edges[b]]),
        [Some(_), Some(_), Some(_), Some(_)] => {
            // A saddle: its middle says which two corners belong together.
            let middle = values.iter().sum::<f64>() / 4.0 >= level;
            if middle == above[0] {
                segments.push([edges[0], edges[1]]);
                segments.push([edges[2], edges[3]]);
            } else {
                segments.push([edges[3], edges[0]]);
                segments.push([edges[1], edges[2]]);
            }
        }
        _ => {}
    }
}

/// Where a level crosses an edge.
fn crossing(edge: Edge, value: impl Fn(u32, u32) -> Option<f64>, level: f64) -> Option<DVec2> {
    let Edge {
        column,
        row,
        is_down,
    } = edge;
    let [right, down] = if is_down { [0, 1] } else { [1, 0] };
    let (from, to) = (value(column, row)?, value(column + right, row + down)?);
    let share = ((level - from) / (to - from)).clamp(0.0, 1.0);
    let start = DVec2::new(f64::from(column), f64::from(row));
    Some(start + DVec2::new(f64::from(right), f64::from(down)) * share)
}

/// Segments that share an edge, joined into lines.
fn chained(segments: &[[Edge; 2]]) -> Vec<Vec<Edge>> {
    let mut at: HashMap<Edge, Vec<usize>> = HashMap::new();
    for (place, segment) in segments.iter().enumerate() {
        for edge in segment {
            at.entry(*edge).or_default().push(place);
        }
    }
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    // Open lines from their ends, then what goes round.
    let is_end = |edge: &Edge| at.get(edge).is_some_and(|places| places.len() == 1);
    let begun_at_ends = segments.iter().enumerate().flat_map(|(place, segment)| {
        let ends = segment.iter().filter(|edge| is_end(edge));
        ends.map(move |edge| (place, *edge))
    });
    let all = segments
        .iter()
        .enumerate()
        .map(|(p, segment)| (p, segment[0]));
    for (mut place, start) in begun_at_ends.chain(all) {
        if used[place] {
            continue;
        }
        let (mut line, mut end) = (vec![start], start);
        loop {
            used[place] = true;
            let [a, b] = segments[place];
            end = if a == end { b } else { a };
            line.push(end);
            let next = at
                .get(&end)
                .and_then(|places| places.iter().find(|&&p| !used[p]));
            let Some(&next) = next else {
                break;
            };
            place = next;
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn middle_out(column: u32, row: u32) -> DVec2 {
        DVec2::new(f64::from(column) - 20.0, f64::from(row) - 15.0)
    }

    /// A cone's lines are circles: closed, and round to what straight pieces across a cell leave.
    #[test]
    fn lines_of_a_cone_are_circles() {
        let value = |column, row| Some(middle_out(column, row).length());
        let lines = isolines(41, 31, value, &[5.0, 10.5]);
        assert_eq!(lines.len(), 2);
        for line in &lines {
            assert_eq!(line.points.first(), line.points.last());
            for point in &line.points {
                let radius = (*point - DVec2::new(20.0, 15.0)).length();
                assert!((radius - line.level).abs() < 0.03, "{radius}");
            }
            // The circumference, a little short because chords are.
            let length: f64 = line.points.windows(2).map(|p| p[0].distance(p[1])).sum();
            let circle = std::f64::consts::TAU * line.level;
            assert!(
                length < circle && length > circle * 0.99,
                "{length} {circle}"
            );
        }
    }

    /// A plane's lines are straight, from edge to edge, one piece each.
    #[test]
    fn lines_of_a_plane_are_straight() {
        let value = |column: u32, row: u32| Some(f64::from(column) + 0.5 * f64::from(row));
        let levels = [2.3, 7.0, 11.25];
        let lines = isolines(11, 9, value, &levels);
        assert_eq!(lines.len(), 3);
        for line in &lines {
            for point in &line.points {
                assert!((point.x + 0.5 * point.y - line.level).abs() < 1e-12);
            }
            let ends = [line.points[0], line.points[line.points.len() - 1]];
            let on_rim = |p: &DVec2| p.x == 0.0 || p.y == 0.0 || p.x == 10.0 || p.y == 8.0;
            assert!(ends.iter().all(on_rim), "{ends:?}");
        }
    }

    /// Two opposite corners high: the middle, 0.5, decides which belong together.
    #[test]
    fn saddles_are_told_apart_by_their_middle() {
        let value = |column: u32, row: u32| Some(if column == row { 1.0 } else { 0.0 });
        for (level, low_corner) in [(0.4, true), (0.6, false)] {
            let lines = isolines(2, 2, value, &[level]);
            assert_eq!(lines.len(), 2);
            for line in lines {
                let middle = (line.points[0] + line.points[1]) / 2.0;
                // Each piece cuts off one corner: a low one, or a high one.
                let is_low = (middle.x > 0.5) != (middle.y > 0.5);
                assert_eq!(is_low, low_corner, "{level}: {middle}");
            }
        }
    }

    #[test]
    fn no_line_goes_through_a_hole() {
        let value = |column: u32, row: u32| {
            let is_hole = (4..=6).contains(&column) && (4..=6).contains(&row);
            (!is_hole).then_some(f64::from(row))
        };
        let lines = isolines(11, 11, value, &[5.5]);
        assert_eq!(lines.len(), 2, "one on each side");
        for point in lines.iter().flat_map(|line| &line.points) {
            assert!(point.x <= 3.0 || point.x >= 7.0, "{point}");
        }
        assert!(isolines(11, 11, |_, _| None, &[5.0]).is_empty());
        assert!(isolines(1, 1, |_, _| Some(1.0), &[1.0]).is_empty());
    }

    #[test]
    fn levels_are_round() {
        assert_eq!(
            round_levels([18.3, 24.9], 8),
            [19.0, 20.0, 21.0, 22.0, 23.0, 24.0]
        );
        assert_eq!(round_levels([0.11, 0.52], 5), [0.2, 0.4]);
        assert_eq!(round_levels([0.11, 0.52], 6), [0.2, 0.3, 0.4, 0.5]);
        assert_eq!(round_levels([1830.0, 2490.0], 4), [2000.0]);
        assert_eq!(
            round_levels([1830.0, 2490.0], 8),
            [1900.0, 2000.0, 2100.0, 2200.0, 2300.0, 2400.0]
        );
        assert!(round_levels([2.0, 2.0], 8).is_empty());
        assert!(round_levels([f64::NAN, 2.0], 8).is_empty());
        for most in 2..12 {
            assert!(round_levels([17.77, 31.3], most).len() <= most as usize);
        }
    }
}
