//! What of an outline lies within a frame.

/// A rectangle: least and greatest x and y.
pub(crate) type Box2 = [[f64; 2]; 2];

/// A closed outline cut to a rectangle, for filling (Sutherland and Hodgman, "Reentrant polygon clipping",
/// 1974).
pub(crate) fn area(outline: &[[f64; 2]], [min, max]: Box2) -> Vec<[f64; 2]> {
    let mut cut = outline.to_vec();
    for (axis, limit, sign) in [
        (0, min[0], 1.0),
        (0, max[0], -1.0),
        (1, min[1], 1.0),
        (1, max[1], -1.0),
    ] {
        let inside = |point: &[f64; 2]| (point[axis] - limit) * sign >= 0.0;
        let all = std::mem::take(&mut cut);
        let before = all.iter().cycle().skip(all.len().saturating_sub(1));
        for (from, to) in before.zip(&all) {
            if inside(from) != inside(to) {
                let share = (limit - from[axis]) / (to[axis] - from[axis]);
                cut.push([0, 1].map(|i| from[i] + share * (to[i] - from[i])));
            }
            if inside(to) {
                cut.push(*to);
            }
        }
    }
    cut
}

/// The parts of a line within a rectangle, for drawing (Liang and Barsky, "A new concept and method for line
/// clipping", 1984).
pub(crate) fn line(points: &[[f64; 2]], [min, max]: Box2) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    for ends in points.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        if !from.iter().chain(&to).all(|number| number.is_finite()) {
            continue;
        }
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let along = to[axis] - from[axis];
            if along == 0.0 {
                if from[axis] < min[axis] || from[axis] > max[axis] {
                    last = -1.0;
                }
                continue;
            }
            let (a, b) = (
                (min[axis] - from[axis]) / along,
                (max[axis] - from[axis]) / along,
            );
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        if first > last {
            continue;
        }
        // The very ends, without rounding: the next part begins where this one ends.
        let at = |share: f64| match share == 1.0 {
            true => to,
            false => [0, 1].map(|i| from[i] + share * (to[i] - from[i])),
        };
        let continues = first == 0.0 && parts.last().and_then(|part| part.last()) == Some(&from);
        match parts.last_mut().filter(|_| continues) {
            Some(part) => part.push(at(last)),
            None => parts.push(vec![at(first), at(last)]),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: Box2 = [[0.0, 0.0], [10.0, 10.0]];

    fn size(outline: &[[f64; 2]]) -> f64 {
        let next = outline.iter().cycle().skip(1);
        let twice = outline
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
        twice.sum::<f64>().abs() / 2.0
    }

    /// Of the triangle (-10, 0), (10, 0), (10, 20) the square holds itself without the corner above the
    /// diagonal from (0, 10): all of it below y = x + 10, which is all.
    #[test]
    fn areas_are_those_of_geometry() {
        let triangle = [[-10.0, 0.0], [10.0, 0.0], [10.0, 20.0]];
        assert!((size(&area(&triangle, SQUARE)) - 100.0).abs() < 1e-9);
        let half = [[0.0, 0.0], [20.0, 0.0], [0.0, 20.0]];
        assert!((size(&area(&half, SQUARE)) - 100.0).abs() < 1e-9);
        let corner = [[5.0, -5.0], [15.0, 5.0], [15.0, -5.0]];
        assert!((size(&area(&corner, SQUARE)) - 0.0).abs() < 1e-9);
        let cut = [[8.0, -2.0], [12.0, 2.0], [2.0, 12.0], [-2.0, 8.0]];
        // A square on its corner of side sqrt 32 x sqrt 200, less what hangs over: four triangles.
        assert!((size(&area(&cut, SQUARE)) - (80.0 - 2.0 * 4.0 - 2.0 * 4.0)).abs() < 1e-9);
        assert!(area(&[[20.0, 20.0], [30.0, 20.0], [30.0, 30.0]], SQUARE).is_empty());
        assert!(area(&[], SQUARE).is_empty());
    }

    #[test]
    fn lines_end_at_the_frame() {
        let there_and_back = [
            [-5.0, 5.0],
            [5.0, 5.0],
            [5.0, 15.0],
            [8.0, 15.0],
            [8.0, 5.0],
        ];
        let parts = line(&there_and_back, SQUARE);
        assert_eq!(
            parts,
            [
                vec![[0.0, 5.0], [5.0, 5.0], [5.0, 10.0]],
                vec![[8.0, 10.0], [8.0, 5.0]]
            ]
        );
        assert!(line(&[[20.0, 0.0], [20.0, 5.0]], SQUARE).is_empty());
        assert!(line(&[[f64::NAN, 0.0], [5.0, 5.0]], SQUARE).is_empty());
        assert_eq!(
            line(&[[-5.0, -5.0], [15.0, 15.0]], SQUARE),
            [vec![[0.0, 0.0], [10.0, 10.0]]]
        );
    }
}
