//! Tiles against the whole triangulation, and on lattices and circles.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::local::first_first;
use super::*;
use crate::surface::delaunay::triangulate;

fn all(points: Vec<DVec3>) -> (Sites, Vec<[u32; 3]>) {
    let sites = Sites::new(points, &[]).unwrap();
    let tiles = Tiles::new(&sites);
    let made = tiles.seen(&sites, |_| false).unwrap();
    let mut triangles: Vec<[u32; 3]> = made.into_iter().flat_map(|m| m.triangles.clone()).collect();
    triangles.sort_unstable();
    (sites, triangles)
}

fn area(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| points[i as usize].truncate());
        (b - a).perp_dot(c - a) / 2.0
    };
    triangles.iter().map(of).sum()
}

/// Random points with a gap, a dense spot and a few far out: many tiles, and the triangles of the
/// whole triangulation, each once.
#[test]
fn tiles_make_the_whole_triangulation() {
    let mut random = crate::split_mix::SplitMix(7);
    let mut uniform = || random.unit();
    let mut points: Vec<DVec3> = (0..60_000)
        .map(|_| DVec3::new(uniform() * 100.0, uniform() * 100.0, 0.0))
        .filter(|p| (p.x - 40.0).abs() > 9.0 || (p.y - 60.0).abs() > 25.0)
        .collect();
    points.extend((0..20_000).map(|_| DVec3::new(70.0 + uniform(), 20.0 + uniform(), 1.0)));
    points.extend((0..9).map(|i| DVec3::new(f64::from(i) * 300.0 - 900.0, 500.0, 2.0)));
    let (sites, triangles) = all(points);
    let (columns, rows) = sites.grid_size();
    assert!(columns > SIDE && rows > SIDE, "one tile tests nothing");
    let mut expected: Vec<[u32; 3]> = triangulate(sites.points())
        .unwrap()
        .into_iter()
        .map(|triangle| first_first(triangle, |corner| corner))
        .collect();
    expected.sort_unstable();
    assert_eq!(triangles.len(), expected.len());
    assert_eq!(triangles, expected);
}

/// Whatever box is looked at, the tiles that are made have all triangles that lie in it; and of a small
/// box in the dense middle they are few.
#[test]
fn what_is_seen_is_there() {
    look_into_boxes(|_| 0.0, [-1.0, 3.0]);
}

/// As well where heights alone tell tiles apart: a slope of 40 degrees with a wall of 60 m across it, seen
/// through boxes that are 3 m high.
#[test]
fn what_is_seen_on_a_slope_is_there() {
    let wall = |y: f64| if y > 55.0 { 60.0 } else { 0.0 };
    look_into_boxes(|place| 0.84 * place.x + wall(place.y), [-1.0, 2.0]);
}

/// Looks through boxes over a ground with gaps, and with a few points far out; `between` are a box's lower
/// and upper side over the ground at its middle.
fn look_into_boxes(ground: impl Fn(DVec2) -> f64, between: [f64; 2]) {
    let mut random = crate::split_mix::SplitMix(11);
    let mut uniform = || random.unit();
    let mut points: Vec<DVec3> = (0..60_000)
        .map(|_| {
            let place = DVec2::new(uniform(), uniform()) * 100.0;
            place.extend(ground(place) + uniform())
        })
        .filter(|p| (p.x - 30.0).abs() > 9.0 || (p.y - 60.0).abs() > 14.0)
        .collect();
    points.extend((0..9).map(|i| DVec3::new(f64::from(i) * 300.0 - 900.0, 500.0, 2.0)));
    let sites = Sites::new(points.clone(), &[]).unwrap();
    let whole = triangulate(sites.points()).unwrap();
    let middle = |t: &[u32; 3]| t.iter().map(|&i| sites.points()[i as usize]).sum::<DVec3>() / 3.0;
    let (mut least, mut compared) = (usize::MAX, 0);
    for _ in 0..30 {
        let size = uniform() * 40.0;
        let from = DVec2::new(uniform() * 140.0 - 20.0, uniform() * 140.0 - 20.0);
        let [low, high] = between.map(|over| ground(from + size / 2.0) + over);
        let (min, max) = (from.extend(low), (from + size).extend(high));
        let misses = |bounds: &Bounds| bounds.max.cmplt(min).any() || bounds.min.cmpgt(max).any();
        let tiles = Tiles::new(&sites);
        let made = tiles.seen(&sites, misses).unwrap();
        let seen: std::collections::HashSet<[u32; 3]> = made
            .iter()
            .flat_map(|m| m.triangles.iter().copied())
            .collect();
        for triangle in &whole {
            let place = middle(triangle);
            if place.cmpge(min).all() && place.cmple(max).all() {
                compared += 1;
                assert!(
                    seen.contains(&first_first(*triangle, |corner| corner)),
                    "{place} is missing"
                );
            }
        }
        least = least.min(seen.len());
    }
    assert!(compared > 10_000, "{compared}");
    assert!(least < whole.len() / 4, "{least} of {}", whole.len());
}

/// All cells of a lattice are squares on one circle: every diagonal is decided by the rule, and the
/// square is covered once.
#[test]
fn tiles_agree_on_a_lattice() {
    let points: Vec<DVec3> = (0..300)
        .flat_map(|x| (0..300).map(move |y| DVec3::new(f64::from(x), f64::from(y), 0.0)))
        .collect();
    let (sites, triangles) = all(points);
    assert_eq!(triangles.len(), 299 * 299 * 2);
    assert!((area(sites.points(), &triangles) - 299.0 * 299.0).abs() < 1e-6);
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .collect();
    edges.sort_unstable();
    let count = edges.len();
    edges.dedup();
    // No directed edge twice: no two triangles on one side of an edge.
    assert_eq!(edges.len(), count);
}

/// Hexagonal lattices and circles have more than four sites on a circle.
#[test]
fn polygons_on_a_circle_become_fans() {
    let ring = (0..4000).map(|i| {
        let (sin, cos) = (f64::from(i % 20) / 20.0 * std::f64::consts::TAU).sin_cos();
        let middle = DVec3::new(f64::from(i / 20 % 14), f64::from(i / 280), 0.0) * 7.0;
        middle + DVec3::new(cos, sin, 0.0) * 3.0
    });
    let (sites, triangles) = all(ring.collect());
    let hull: Vec<DVec3> = sites.hull().to_vec();
    let around = hull.iter().zip(hull.iter().cycle().skip(1));
    let expected: f64 = around
        .map(|(a, b)| a.truncate().perp_dot(b.truncate()) / 2.0)
        .sum();
    assert!((area(sites.points(), &triangles) - expected).abs() < 1e-6);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Small whole coordinates: many equal distances, lines and circles.
    #[test]
    fn any_points_are_covered_once(
        places in prop::collection::vec((0..12_i32, 0..9_i32), 3..80),
    ) {
        let points = places.iter().map(|&(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0));
        let Ok(sites) = Sites::new(points.collect(), &[]) else { return Ok(()) };
        let tiles = Tiles::new(&sites);
        let made = tiles.seen(&sites, |_| false).unwrap();
        let triangles: Vec<[u32; 3]> = made.into_iter().flat_map(|m| m.triangles.clone()).collect();
        let whole = triangulate(sites.points()).unwrap();
        prop_assert_eq!(triangles.len(), whole.len());
        let (a, b) = (area(sites.points(), &triangles), area(sites.points(), &whole));
        prop_assert!((a - b).abs() < 1e-9);
    }
}

/// Who looks into one hole makes the triangles over it and not those over another hole far away.
#[test]
fn a_hole_elsewhere_is_not_looked_into() {
    let mut random = crate::split_mix::SplitMix(5);
    let mut uniform = || random.unit();
    let points: Vec<DVec3> = (0..200_000)
        .map(|_| DVec3::new(uniform(), uniform(), 0.0) * 100.0)
        .filter(|p| {
            (p.y - 50.0).abs() > 4.0 || ((p.x - 20.0).abs() > 4.0 && (p.x - 80.0).abs() > 4.0)
        })
        .collect();
    let sites = Sites::new(points, &[]).unwrap();
    let tiles = Tiles::new(&sites);
    let near = |x: f64, bounds: &Bounds| bounds.min.x < x + 1.0 && bounds.max.x > x - 1.0;
    let misses =
        |bounds: &Bounds| !near(20.0, bounds) || bounds.min.y > 51.0 || bounds.max.y < 49.0;
    let made = tiles.seen(&sites, misses).unwrap();
    let corners = made.iter().flat_map(|made| &made.triangles);
    let corners: Vec<[DVec2; 3]> = corners
        .map(|t| t.map(|i| sites.points()[i as usize].truncate()))
        .collect();
    let hole = DVec2::new(20.0, 50.0);
    let covers = |[a, b, c]: &[DVec2; 3]| {
        let turns = |a: DVec2, b: DVec2| (b - a).perp_dot(hole - a) >= 0.0;
        turns(*a, *b) && turns(*b, *c) && turns(*c, *a)
    };
    assert!(corners.iter().any(covers));
    assert!(corners.iter().flatten().all(|corner| corner.x < 60.0));
}
