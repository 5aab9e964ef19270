//! Convex hulls of pixels.

/// The convex hull of points by Andrew's chain (1979), counter-clockwise where y points up; the points are
/// put in order.
pub(crate) fn hull(points: &mut Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points.clone();
    }
    let mut hull: Vec<[f32; 2]> = Vec::with_capacity(16);
    let mut chain = |points: &mut dyn Iterator<Item = &[f32; 2]>| {
        let start = hull.len();
        for point in points {
            while let [.., before, last] = hull[start..] {
                if turn(before, last, *point) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(*point);
        }
        // It begins the other chain.
        hull.pop();
    };
    chain(&mut points.iter());
    chain(&mut points.iter().rev());
    hull
}

/// Twice the area of the triangle; exact, since corners of pixels are small whole numbers.
fn turn(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f64 {
    let [a, b, c] = [a, b, c].map(|[x, y]| [f64::from(x), f64::from(y)]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The area within a hull.
pub(crate) fn area(hull: &[[f32; 2]]) -> f64 {
    let [first, rest @ ..] = hull else {
        return 0.0;
    };
    let pairs = rest.windows(2);
    0.5 * pairs
        .map(|pair| turn(*first, pair[0], pair[1]))
        .sum::<f64>()
        .abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with points within it, on its sides and twice.
    #[test]
    fn of_a_square() {
        let mut points = vec![
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [2.0, 2.0],
            [2.0, 0.0],
            [4.0, 4.0],
            [1.0, 3.0],
        ];
        let hull = hull(&mut points);
        assert_eq!(hull.len(), 4, "{hull:?}");
        assert!((area(&hull) - 16.0).abs() < 1e-12);
        assert_eq!(area(&[[1.0, 1.0], [2.0, 5.0]]), 0.0);
    }
}
