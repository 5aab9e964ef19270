//! Widths of a convex outline: rotating calipers (Shamos 1978), one direction for each of its sides.

/// The least and the greatest distance of two parallels that hold the hull between them, pixels.
pub(super) fn widths(hull: &[[f32; 2]]) -> [f64; 2] {
    let mut greatest: f64 = 0.0;
    // Tens of corners: all pairs are as fast.
    for (place, one) in hull.iter().enumerate() {
        for other in &hull[place + 1..] {
            greatest = greatest.max(length(between(*one, *other)));
        }
    }
    let least = sides(hull).map(|side| extent(hull, [-side[1], side[0]]));
    let least = least.fold(greatest, f64::min);
    [least, greatest]
}

/// The sides of the rectangle of least area that holds the hull, the longer first, pixels: one of its sides
/// lies on one of the hull's (Freeman & Shapira 1975).
pub(super) fn rectangle(hull: &[[f32; 2]]) -> [f64; 2] {
    let all = sides(hull).map(|side| [extent(hull, side), extent(hull, [-side[1], side[0]])]);
    let least = all.min_by(|a, b| (a[0] * a[1]).total_cmp(&(b[0] * b[1])));
    let [a, b] = least.unwrap_or_default();
    [a.max(b), a.min(b)]
}

/// The directions of the sides, of length 1.
fn sides(hull: &[[f32; 2]]) -> impl Iterator<Item = [f64; 2]> {
    let next = hull.iter().cycle().skip(1);
    hull.iter().zip(next).filter_map(|(one, other)| {
        let side = between(*one, *other);
        let length = length(side);
        (length > 0.0).then(|| [side[0] / length, side[1] / length])
    })
}

fn between(one: [f32; 2], other: [f32; 2]) -> [f64; 2] {
    [
        f64::from(other[0]) - f64::from(one[0]),
        f64::from(other[1]) - f64::from(one[1]),
    ]
}

fn length([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}

/// How far the hull reaches along a direction.
fn extent(hull: &[[f32; 2]], direction: [f64; 2]) -> f64 {
    let along = hull
        .iter()
        .map(|[x, y]| f64::from(*x) * direction[0] + f64::from(*y) * direction[1]);
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
        (low.min(at), high.max(at))
    });
    (high - low).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rectangle of 8 by 3, turned by 30 degrees: its diagonal is sqrt(73).
    #[test]
    fn of_a_turned_rectangle() {
        let (sin, cos) = 30f64.to_radians().sin_cos();
        let corner = |x: f64, y: f64| [(x * cos - y * sin) as f32, (x * sin + y * cos) as f32];
        let hull = [
            corner(0.0, 0.0),
            corner(8.0, 0.0),
            corner(8.0, 3.0),
            corner(0.0, 3.0),
        ];
        let close = |found: [f64; 2], wanted: [f64; 2]| {
            found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-5)
        };
        assert!(
            close(widths(&hull), [3.0, 73f64.sqrt()]),
            "{:?}",
            widths(&hull)
        );
        assert!(
            close(rectangle(&hull), [8.0, 3.0]),
            "{:?}",
            rectangle(&hull)
        );
    }
}
