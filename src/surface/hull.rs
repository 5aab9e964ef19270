//! The convex hull of sites in (x, y).

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::sites::place::site_place;

/// The corners of the convex hull in (x, y), counter-clockwise, without points inside its edges.
/// Fewer than three where all points lie on one line. Exact: decided by adaptive predicates.
pub fn convex_hull(points: &[DVec3]) -> Vec<DVec3> {
    let mut candidates = outside_of_extremes(points);
    candidates.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    // Andrew's monotone chain: the lower hull from left to right, the upper one back.
    let mut hull: Vec<DVec3> = Vec::new();
    for pass in 0..2 {
        let floor = hull.len();
        for &point in &candidates {
            while let [.., a, b] = hull[floor..] {
                if turn(a, b, point) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        // The last point of this chain begins the other one.
        hull.pop();
        if pass == 0 {
            candidates.reverse();
        }
    }
    hull
}

/// The same of points of which several may have the same (x, y): each corner is the highest of those there.
pub(super) fn hull_of_points(points: &[DVec3]) -> Vec<DVec3> {
    let candidates = outside_of_extremes(points).into_iter();
    let mut candidates: Vec<DVec3> = candidates.map(site_place).collect();
    candidates.sort_unstable_by(|a, b| {
        (a.x.total_cmp(&b.x))
            .then(a.y.total_cmp(&b.y))
            .then(b.z.total_cmp(&a.z))
    });
    candidates.dedup_by(|b, a| a.truncate() == b.truncate());
    convex_hull(&candidates)
}

/// Whether points with this hull lie on one line, but for rounding: a hull that is a billion times
/// longer than wide is no surface.
pub(super) fn is_line(hull: &[DVec3]) -> bool {
    let Some(&first) = hull.first() else {
        return true;
    };
    let way = hull
        .iter()
        .map(|&p| (p - first).truncate())
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .unwrap_or(DVec2::ZERO);
    hull.iter().all(|&p| {
        let beside = way.perp_dot((p - first).truncate()).abs();
        beside <= 1e-9 * way.length_squared()
    })
}

/// Positive where a, b, c turn left.
fn turn(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let coord = |p: DVec3| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Drops the points that lie well inside the octagon of the outermost points in eight directions
/// (Akl and Toussaint): of a million points a few hundred are left to sort.
fn outside_of_extremes(points: &[DVec3]) -> Vec<DVec3> {
    let directions: [DVec2; 8] =
        std::array::from_fn(|i| DVec2::from_angle(i as f64 * std::f64::consts::FRAC_PI_4));
    let mut extremes = [DVec2::ZERO; 8];
    let mut reach = [f64::NEG_INFINITY; 8];
    for point in points {
        let point = point.truncate();
        for i in 0..8 {
            let along = point.dot(directions[i]);
            if along > reach[i] {
                (reach[i], extremes[i]) = (along, point);
            }
        }
    }
    // Clearly inside: left of every side by more than rounding can do.
    let size = reach.iter().fold(0.0, |size: f64, r| size.max(r.abs()));
    let margin = size * size * 1e-12;
    let inside = |p: DVec2| {
        (0..8).all(|i| {
            let (a, b) = (extremes[i], extremes[(i + 1) % 8]);
            a == b || (b - a).perp_dot(p - a) > margin
        })
    };
    points
        .iter()
        .copied()
        .filter(|p| !inside(p.truncate()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_has_four_corners() {
        let points: Vec<DVec3> = (0..100)
            .flat_map(|x| (0..70).map(move |y| DVec3::new(f64::from(x), f64::from(y), 0.0)))
            .collect();
        let hull = convex_hull(&points);
        let corners = [(0.0, 0.0), (99.0, 0.0), (99.0, 69.0), (0.0, 69.0)];
        assert_eq!(hull, corners.map(|(x, y)| DVec3::new(x, y, 0.0)));
    }

    #[test]
    fn points_on_a_line_have_no_hull() {
        let line: Vec<DVec3> = (0..50)
            .map(|i| DVec3::new(f64::from(i), f64::from(i) * 3.0, 1.0))
            .collect();
        assert!(convex_hull(&line).len() < 3);
        let rounded: Vec<DVec3> = line.iter().map(|p| *p * 0.1).collect();
        assert!(is_line(&convex_hull(&rounded)));
        assert!(is_line(&convex_hull(&line)));
        assert!(!is_line(&[
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(0.5, 1e-6, 0.0)
        ]));
        assert!(convex_hull(&line[..1]).len() < 3);
        assert!(convex_hull(&[]).is_empty());
    }

    #[test]
    fn every_point_is_inside_or_on_the_hull() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let points: Vec<DVec3> = (0..5000)
            .map(|_| DVec3::new(random(), random() * 0.3, 0.0))
            .collect();
        let hull = convex_hull(&points);
        for i in 0..hull.len() {
            let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
            assert!(points.iter().all(|&p| turn(a, b, p) >= 0.0));
        }
    }
}
