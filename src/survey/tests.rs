//! Against closed forms, at coordinates as large as UTM's.

use glam::{DVec2, DVec3};

use super::*;
use crate::split_mix::SplitMix;
use crate::surface::{Cloud, Surface};

const ORIGIN: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 160.0);

fn cloud(points: impl IntoIterator<Item = DVec3>) -> Surface {
    Surface::new(Cloud {
        points: points.into_iter().map(|point| point + ORIGIN).collect(),
        ..Cloud::default()
    })
    .unwrap()
}

fn mesh(points: &[DVec3], triangles: &[[u32; 3]]) -> Surface {
    Surface::new(Cloud {
        points: points.iter().map(|&point| point + ORIGIN).collect(),
        triangles: triangles.to_vec(),
        ..Cloud::default()
    })
    .unwrap()
}

fn at(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y) + ORIGIN.truncate()
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Polygon {
    let corners = [low, [high[0], low[1]], high, [low[0], high[1]]];
    Polygon::new(&corners.map(|[x, y]| at(x, y))).unwrap()
}

fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} for {expected}");
}

/// A cone with its foot on a level floor, which reaches out to `floor`, as rings of points.
fn cone(radius: f64, height: f64, floor: f64) -> Surface {
    let mut points = vec![DVec3::new(0.0, 0.0, height)];
    let sectors = 360;
    for ring in 1..=40 {
        let r = if ring <= 20 {
            radius * f64::from(ring) / 20.0
        } else {
            radius + (floor - radius) * f64::from(ring - 20) / 20.0
        };
        let z = (height * (1.0 - r / radius)).max(0.0);
        points.extend((0..sectors).map(|sector| {
            let angle = std::f64::consts::TAU * f64::from(sector) / f64::from(sectors);
            DVec3::new(r * angle.cos(), r * angle.sin(), z)
        }));
    }
    cloud(points)
}

/// Random places on a plane, with the corners of the square from -`reach` to `reach`.
fn plane(reach: f64, count: usize, seed: u64, z: impl Fn(DVec2) -> f64) -> Surface {
    let mut random = SplitMix(seed);
    let mut places: Vec<DVec2> = (0..count)
        .map(|_| DVec2::new(random.unit(), random.unit()) * 2.0 * reach - reach)
        .collect();
    for corner in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
        places.push(DVec2::from(corner) * reach);
    }
    cloud(places.into_iter().map(|place| place.extend(z(place))))
}

#[test]
fn heights_of_a_profile_are_exact() {
    let z = |place: DVec2| 2.0 + 0.3 * place.x - 0.2 * place.y;
    let surface = plane(10.0, 3000, 1, z);
    let line = [at(-9.0, -7.5), at(8.0, 3.25), at(-2.0, 9.0)];
    let profile = Profile::along(&surface, &line).unwrap();
    near(
        profile.length,
        line[0].distance(line[1]) + line[1].distance(line[2]),
        1e-9,
    );
    assert_eq!(profile.runs.len(), 1, "it does not tear");
    near(profile.covered(), 1.0, 1e-12);
    let points: Vec<_> = profile.points().collect();
    // A line through n random triangles crosses about sqrt(n) edges: 3000 points have 6000 triangles.
    assert!(points.len() > 90, "{}", points.len());
    for pair in points.windows(2) {
        assert!(pair[0].distance < pair[1].distance);
    }
    for point in &points {
        let local = point.point - ORIGIN;
        near(local.z, z(local.truncate()), 1e-8);
    }
    assert_eq!(points[0].point.truncate(), line[0]);
    assert_eq!(points.last().unwrap().point.truncate(), line[2]);
}

/// Edges that are crossed are found one by one: a grid of 1 m whose heights are random.
#[test]
fn every_crossed_edge_is_a_point() {
    let mut random = SplitMix(7);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for y in 0..6_u32 {
        for x in 0..6_u32 {
            points.push(DVec3::new(f64::from(x), f64::from(y), random.unit()));
            if x < 5 && y < 5 {
                let i = y * 6 + x;
                triangles.extend([[i, i + 1, i + 7], [i, i + 7, i + 6]]);
            }
        }
    }
    let surface = mesh(&points, &triangles);
    // At y = 2.5 from 0 to 5: six upright edges, and five diagonals in the middle between them.
    let profile = Profile::along(&surface, &[at(0.0, 2.5), at(5.0, 2.5)]).unwrap();
    let found: Vec<f64> = profile.points().map(|p| p.distance).collect();
    assert_eq!(
        found,
        (0..=10)
            .map(|half| f64::from(half) / 2.0)
            .collect::<Vec<_>>()
    );
    for (place, point) in profile.points().enumerate() {
        let height = |x: usize, y: usize| points[y * 6 + x].z;
        let expected = match place % 2 {
            0 => (height(place / 2, 2) + height(place / 2, 3)) / 2.0,
            _ => (height(place / 2, 2) + height(place / 2 + 1, 3)) / 2.0,
        };
        near(point.point.z - ORIGIN.z, expected, 1e-9);
    }
    // Along an edge: its own ends, once.
    let profile = Profile::along(&surface, &[at(-1.0, 3.0), at(6.0, 3.0)]).unwrap();
    let found: Vec<f64> = profile.points().map(|p| p.distance).collect();
    assert_eq!(found, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    near(profile.covered(), 5.0 / 7.0, 1e-12);
}

#[test]
fn holes_are_gaps() {
    // Strips of points one apart, none from x = 4 to 8.
    let places = (0..13).filter(|&x| x <= 4 || x >= 8);
    let points =
        places.flat_map(|x| (0..5).map(move |y| DVec3::new(f64::from(x), f64::from(y), 1.0)));
    let surface = cloud(points).with_max_edge(Some(1.5)).unwrap();
    let profile = Profile::along(&surface, &[at(0.0, 1.3), at(12.0, 1.3)]).unwrap();
    let ends: Vec<[f64; 2]> = (profile.runs.iter())
        .map(|run| [run[0].distance, run.last().unwrap().distance])
        .collect();
    assert_eq!(ends, [[0.0, 4.0], [8.0, 12.0]]);
    near(profile.covered(), 8.0 / 12.0, 1e-12);
    let found = volume(
        &surface,
        &rectangle([1.0, 1.0], [11.0, 3.0]),
        Base::Height(ORIGIN.z),
    );
    let found = found.unwrap();
    near(found.covered, 0.6, 1e-12);
    near(found.fill, 12.0, 1e-9);
    near(found.plan_area, 20.0, 1e-9);
    near(found.surface_area, 12.0, 1e-9);
}

/// A level place of points 1 apart without those within 15 of its middle: the triangulation bridges the hole, and the part of
/// it under triangles of 10 times the longest edge of the others is told. Where all are there, none is.
#[test]
fn a_bridged_hole_is_told() {
    let bridged = |radius: f64| {
        let places = (0..60).flat_map(|x| (0..60).map(move |y| (f64::from(x), f64::from(y))));
        let points = places.filter(|(x, y)| (x - 30.0).hypot(y - 30.0) >= radius);
        let surface = cloud(points.map(|(x, y)| DVec3::new(x, y, 0.0)));
        let polygon = rectangle([5.0, 5.0], [55.0, 55.0]);
        volume(&surface, &polygon, Base::Height(ORIGIN.z))
            .unwrap()
            .bridged
    };
    let hole = std::f64::consts::PI * 15.0 * 15.0 / 2500.0;
    let found = bridged(15.0);
    assert!(
        // Its triangles end at the points around it.
        found > 0.98 * hole && found < 1.07 * hole,
        "{found} of {hole}"
    );
    assert_eq!(bridged(0.0), 0.0);
    // Of points of chance triangles are of many lengths, and only ten times the median one bridges: not four cells, which is told of
    // a grid (below).
    let by_chance = |radius: f64| {
        let mut random = SplitMix(7);
        let places = (0..60).flat_map(|x| (0..60).map(move |y| (f64::from(x), f64::from(y))));
        let places = places.map(|(x, y)| (x + random.unit() - 0.5, y + random.unit() - 0.5));
        let places: Vec<(f64, f64)> = places.collect();
        let points = places
            .into_iter()
            .filter(|(x, y)| (x - 30.0).hypot(y - 30.0) >= radius);
        let surface = cloud(points.map(|(x, y)| DVec3::new(x, y, 0.0)));
        let polygon = rectangle([5.0, 5.0], [55.0, 55.0]);
        let found = volume(&surface, &polygon, Base::Height(ORIGIN.z));
        found.unwrap().bridged
    };
    let found = by_chance(15.0);
    assert!(
        found > 0.6 * hole && found < 1.02 * hole,
        "{found} of {hole}"
    );
    assert_eq!([by_chance(2.5), by_chance(0.0)], [0.0; 2]);
    // Strips of points 1 apart with 36 between them: a line is on two triangles there.
    let places = (0..5).chain(40..45);
    let points = places.flat_map(|x| (0..5).map(move |y| DVec3::new(x.into(), y.into(), 0.0)));
    let surface = cloud(points);
    let over = Profile::along(&surface, &[at(0.0, 1.3), at(44.0, 1.3)]).unwrap();
    near(over.bridged, 36.0 / 44.0, 1e-9);
    // All its long triangles are of one length.
    let polygon = rectangle([0.0, 0.0], [44.0, 4.0]);
    let found = volume(&surface, &polygon, Base::Height(ORIGIN.z)).unwrap();
    near(found.bridged, 36.0 / 44.0, 1e-9);
    let beside = Profile::along(&surface, &[at(0.0, 1.3), at(4.0, 1.3)]).unwrap();
    assert_eq!(beside.bridged, 0.0);
    // Of a grid a few cells without a height are a hole, too: 4 by 4 of them between points 5 apart.
    let places = (0..60).flat_map(|x| (0..60).map(move |y| (x, y)));
    let points = places.filter(|(x, y)| !(20..24).contains(x) || !(20..24).contains(y));
    let surface = cloud(points.map(|(x, y)| DVec3::new(x.into(), y.into(), 0.0)));
    let polygon = rectangle([10.0, 10.0], [40.0, 40.0]);
    let found = volume(&surface, &polygon, Base::Height(ORIGIN.z)).unwrap();
    assert!(
        (found.bridged - 25.0 / 900.0).abs() < 0.011,
        "{}",
        found.bridged
    );
    // A line with bends where two places lie within rounding of each other.
    let bends = [
        at(0.0, 1.3),
        at(10.0, 1.3),
        at(10.0, 1.3 + 1e-9),
        at(19.0, 1.3),
    ];
    let profile = Profile::along(&surface, &bends).unwrap();
    assert_eq!(profile.bridged, 0.0);
}

#[test]
fn angle_of_repose_of_a_cone() {
    let height = 10.0 * 37_f64.to_radians().tan();
    let surface = cone(10.0, height, 20.0);
    let profile = Profile::along(&surface, &[at(-18.0, 0.0), at(18.0, 0.0)]).unwrap();
    let crest = profile.crest().unwrap();
    near(crest.point.z, ORIGIN.z + height, 1e-9);
    near(crest.distance, 18.0, 1e-9);
    for (face, toe) in profile.faces().into_iter().zip([8.0, 28.0]) {
        let face = face.unwrap();
        near(face.toe.distance, toe, 1e-6);
        near(face.toe.point.z, ORIGIN.z, 1e-9);
        near(face.height(), height, 1e-9);
        near(face.overall, 37.0, 1e-6);
        near(face.repose.unwrap(), 37.0, 1e-6);
    }
}

/// A bench with a level top, a face of 60 degrees with a rough foot of 30, and a floor that falls away.
#[test]
fn crest_and_toe_of_a_bench() {
    let steep = 60_f64.to_radians().tan();
    let flat = 30_f64.to_radians().tan();
    let line = [
        (0.0, 10.0),
        (20.0, 10.0),
        (20.0 + 8.0 / steep, 2.0),
        (20.0 + 8.0 / steep + 2.0 / flat, 0.0),
        (60.0, -1.0),
    ];
    let points = line
        .iter()
        .flat_map(|&(x, z)| [-5.0, 5.0].map(|y| DVec3::new(x, y, z)));
    let profile = Profile::along(&cloud(points), &[at(0.0, 0.5), at(60.0, 0.5)]).unwrap();
    let [before, after] = profile.faces();
    assert_eq!(before, None);
    let face = after.unwrap();
    near(face.crest.distance, 20.0, 1e-9);
    near(face.toe.distance, line[3].0, 1e-9);
    near(face.height(), 10.0, 1e-9);
    near(face.repose.unwrap(), 60.0, 1e-9);
    let [from, to] = face.fitted.unwrap();
    assert!(from >= 20.0 - 1e-9 && to <= line[2].0 + 1e-9, "{from} {to}");
    near(
        face.overall,
        (10.0 / (line[3].0 - 20.0)).atan().to_degrees(),
        1e-9,
    );
}

/// V = pi r^2 h / 3 and A = pi r sqrt(r^2 + h^2); inscribed in 360 sectors less than 1e-4 smaller.
#[test]
fn a_cone() {
    let surface = cone(10.0, 6.0, 20.0);
    let found = volume(
        &surface,
        &rectangle([-12.0, -13.0], [11.0, 12.5]),
        Base::Height(ORIGIN.z),
    )
    .unwrap();
    let pi = std::f64::consts::PI;
    near(found.fill / (pi * 100.0 * 6.0 / 3.0), 1.0, 1e-4);
    near(found.cut, 0.0, 1e-6);
    let floor = 23.0 * 25.5 - pi * 100.0;
    let cone = pi * 10.0 * 136_f64.sqrt();
    near(found.surface_area / (floor + cone), 1.0, 1e-4);
    near(found.covered, 1.0, 1e-12);
    let [low, high] = found.heights.unwrap();
    near(low, ORIGIN.z, 1e-9);
    near(high, ORIGIN.z + 6.0, 1e-9);
    // Over a level at half its height: a cone of an eighth stands out, and the rest of the plan is cut.
    let half = volume(
        &surface,
        &rectangle([-12.0, -13.0], [11.0, 12.5]),
        Base::Height(ORIGIN.z + 3.0),
    )
    .unwrap();
    near(half.fill / (pi * 100.0 * 6.0 / 24.0), 1.0, 1e-4);
    near(half.net(), found.fill - 3.0 * 23.0 * 25.5, 1e-6);
}

/// V = h (a^2 + a b + b^2) / 3.
#[test]
fn a_frustum_on_a_slope_over_its_rim() {
    // The floor rises by 0.1 a unit along x; the frustum is added to it.
    let square = |side: f64, z: f64| {
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| {
            let place = DVec2::new(x, y) * side / 2.0;
            place.extend(z + 0.1 * place.x)
        })
    };
    let points = [square(30.0, 0.0), square(10.0, 0.0), square(4.0, 3.0)].concat();
    let surface = cloud(points);
    let polygon = rectangle([-6.0, -5.5], [7.0, 6.0]);
    let found = volume(&surface, &polygon, Base::Rim).unwrap();
    near(found.fill, 156.0, 1e-6);
    near(found.cut, 0.0, 1e-6);
    let BaseFound::Rim(plane) = found.base else {
        panic!("{:?}", found.base);
    };
    near(plane.slope(), 0.1_f64.atan().to_degrees(), 1e-7);
    near(plane.height(at(3.0, 1.0)), ORIGIN.z + 0.3, 1e-7);
    near(plane.residual, 0.0, 1e-7);
}

/// A box on a floor, with upright walls, as a mesh; then the same with its faces turned round, and one
/// that floats, under which there is no rock.
#[test]
fn a_box() {
    let lid = |low: f64, high: f64, z: f64| {
        [[low, low], [high, low], [high, high], [low, high]].map(|[x, y]| DVec3::new(x, y, z))
    };
    // Floor with a hole under the box, box on it: outer 0..4, foot 4..8, top 8..12.
    let points = [
        lid(-5.0, 5.0, 0.0),
        lid(-1.0, 2.0, 0.0),
        lid(-1.0, 2.0, 4.0),
    ]
    .concat();
    let mut triangles: Vec<[u32; 3]> = vec![[8, 9, 10], [8, 10, 11]];
    for ring in [0, 4] {
        for i in 0..4 {
            let next = (i + 1) % 4;
            let (a, b, c, d) = (ring + i, ring + next, ring + 4 + next, ring + 4 + i);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let polygon = rectangle([-3.0, -3.0], [3.0, 3.0]);
    let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [c, b, a]).collect();
    for triangles in [&triangles, &turned] {
        let surface = mesh(&points, triangles);
        let found = volume(&surface, &polygon, Base::Height(ORIGIN.z)).unwrap();
        near(found.fill, 36.0, 1e-9);
        near(found.covered, 1.0, 1e-9);
        near(found.overhang, 0.0, 1e-9);
        near(found.surface_area, 36.0 + 12.0 * 4.0, 1e-9);
        let profile = Profile::along(&surface, &[at(-4.0, 0.5), at(4.0, 0.5)]).unwrap();
        let heights: Vec<f64> = profile.points().map(|p| p.point.z - ORIGIN.z).collect();
        assert!(
            heights
                .iter()
                .all(|&z| z.abs() < 1e-9 || (z - 4.0).abs() < 1e-9)
        );
        let upright = profile.points().filter(|p| (p.distance - 3.0).abs() < 1e-9);
        assert_eq!(upright.count(), 2, "an upright face");
        near(profile.faces()[0].unwrap().repose.unwrap(), 90.0, 1e-9);
    }
    let points = [
        lid(-5.0, 5.0, 0.0),
        lid(-1.0, 2.0, 4.0),
        lid(-1.0, 2.0, 3.0),
    ]
    .concat();
    let mut triangles = vec![
        [0, 1, 2],
        [0, 2, 3],
        [4, 5, 6],
        [4, 6, 7],
        [10, 9, 8],
        [11, 10, 8],
    ];
    for i in 0..4 {
        let next = (i + 1) % 4;
        triangles.extend([[8 + i, 8 + next, 4 + next], [8 + i, 4 + next, 4 + i]]);
    }
    let found = volume(&mesh(&points, &triangles), &polygon, Base::Height(ORIGIN.z)).unwrap();
    near(found.fill, 9.0, 1e-9);
    near(found.covered, 1.0, 1e-9);
    near(found.overhang, 9.0 / 36.0, 1e-9);
}

/// Between z = x and z = -x / 2 lies 1.5 x: over a U that is open above, the integral of |1.5 x|.
#[test]
fn between_two_surfaces() {
    let above = plane(4.0, 900, 3, |place| place.x);
    let below = plane(4.0, 700, 5, |place| -0.5 * place.x);
    // -2..2 by 0..3, less -1..1 by 1..3.
    let corners = [
        [-2.0, 0.0],
        [2.0, 0.0],
        [2.0, 3.0],
        [1.0, 3.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 3.0],
        [-2.0, 3.0],
    ];
    let polygon = Polygon::new(&corners.map(|[x, y]| at(x, y))).unwrap();
    near(polygon.area(), 8.0, 1e-9);
    let found = volume(&above, &polygon, Base::Surface(&below)).unwrap();
    // Right half: 1.5 (3 * 2 - 2 * 0.5) = 7.5.
    near(found.fill, 7.5, 1e-7);
    near(found.cut, 7.5, 1e-7);
    near(found.covered, 1.0, 1e-9);
    near(found.surface_area, 8.0 * 2_f64.sqrt(), 1e-7);
    // Half of the plan has no base.
    let half = volume(
        &above,
        &rectangle([3.0, 0.0], [5.0, 1.0]),
        Base::Surface(&below),
    )
    .unwrap();
    near(half.covered, 0.5, 1e-9);
    near(half.fill, 1.5 * 3.5, 1e-7);
}

/// A polygon in parts has the sum of their volumes, whatever its outline: no triangle is counted twice.
#[test]
fn parts_add_up() {
    let mut random = SplitMix(11);
    let places: Vec<DVec2> = (0..4000)
        .map(|_| DVec2::new(random.unit(), random.unit()) * 20.0 - 10.0)
        .collect();
    let surface = cloud((places.iter()).map(|p| p.extend((p.x * 0.7).sin() * (p.y * 0.4).cos())));
    let spokes: Vec<DVec2> = (0..24)
        .map(|spoke| {
            let radius = if spoke % 2 == 0 { 8.0 } else { 3.0 };
            let angle = std::f64::consts::TAU * f64::from(spoke) / 24.0;
            at(radius * angle.cos(), radius * angle.sin())
        })
        .collect();
    let star = Polygon::new(&spokes).unwrap();
    // 24 triangles of r1 r2 sin(15 degrees) / 2; corners are rounded at 1e-9.
    near(
        star.area(),
        24.0 * 24.0 * 15_f64.to_radians().sin() / 2.0,
        1e-7,
    );
    let base = Base::Height(ORIGIN.z);
    let whole = volume(&surface, &star, base).unwrap();
    near(whole.covered, 1.0, 1e-12);
    let mut sum = [0.0; 3];
    for (place, &from) in spokes.iter().enumerate() {
        let to = spokes[(place + 1) % spokes.len()];
        let part = Polygon::new(&[at(0.0, 0.0), to, from]).unwrap();
        let part = volume(&surface, &part, base).unwrap();
        sum[0] += part.fill;
        sum[1] += part.cut;
        sum[2] += part.surface_area;
    }
    near(sum[0], whole.fill, 1e-9);
    near(sum[1], whole.cut, 1e-9);
    near(sum[2], whole.surface_area, 1e-9);
}

#[test]
fn what_cannot_be_measured_is_refused() {
    let surface = plane(10.0, 50, 2, |_| 0.0);
    let polygon = |corners: &[[f64; 2]]| {
        let corners: Vec<DVec2> = corners.iter().map(|&[x, y]| at(x, y)).collect();
        Polygon::new(&corners)
    };
    assert_eq!(
        polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]),
        Err(SurveyError::TooFewCorners(2))
    );
    assert_eq!(
        polygon(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]),
        Err(SurveyError::NoArea)
    );
    let crossed = polygon(&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]);
    assert_eq!(crossed, Err(SurveyError::CrossesItself(1, 3)));
    let back = polygon(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 2.0]]);
    assert_eq!(back, Err(SurveyError::CrossesItself(1, 2)));
    assert!(polygon(&[[0.0, 0.0], [f64::NAN, 0.0], [1.0, 0.0]]).is_err());
    let line = [at(1.0, 1.0); 2];
    assert_eq!(Profile::along(&surface, &line), Err(SurveyError::NoLength));
    let inside = rectangle([0.0, 0.0], [1.0, 1.0]);
    assert!(volume(&surface, &inside, Base::Height(f64::INFINITY)).is_err());
    let beside = rectangle([20.0, 0.0], [21.0, 1.0]);
    let refused = volume(&surface, &beside, Base::Rim);
    assert_eq!(refused, Err(SurveyError::RimNotCovered(0.0)));
    // Beside the surface there is nothing, and that is said.
    let nothing = volume(&surface, &beside, Base::Height(0.0)).unwrap();
    assert_eq!(
        (nothing.covered, nothing.fill, nothing.heights),
        (0.0, 0.0, None)
    );
}

/// Tiles that overlap, faces that are there twice or look inwards are refused; bodies alone count their own volume, and are
/// told.
#[test]
fn faces_that_would_make_another_volume_are_refused() {
    let sheet = |low: [f64; 2], high: [f64; 2], z: f64| {
        [[low[0], low[1]], [high[0], low[1]], high, [low[0], high[1]]]
            .map(|[x, y]| DVec3::new(x, y, z))
    };
    let faces = |from: u32| [[from, from + 1, from + 2], [from, from + 2, from + 3]];
    // A closed box, faces outwards: foot and lid, and four walls.
    let walls = |from: u32| {
        (0..4).flat_map(move |i| {
            let [a, b] = [from + i, from + (i + 1) % 4];
            [[a, b, b + 4], [a, b + 4, a + 4]]
        })
    };
    let body = |from: u32| -> Vec<[u32; 3]> {
        let foot = faces(from).map(|[a, b, c]| [c, b, a]);
        foot.into_iter()
            .chain(faces(from + 4))
            .chain(walls(from))
            .collect()
    };
    let turned = |faces: &[[u32; 3]]| -> Vec<[u32; 3]> {
        faces.iter().map(|&[a, b, c]| [c, b, a]).collect()
    };
    let polygon = rectangle([-4.0, -4.0], [4.0, 4.0]);
    let measured = |points: &[DVec3], faces: &[[u32; 3]]| {
        volume(&mesh(points, faces), &polygon, Base::Height(ORIGIN.z))
    };
    // Two tiles 5 high that share a strip of 2 by 8.
    let tiles = [
        sheet([-5.0, -5.0], [1.0, 5.0], 5.0),
        sheet([-1.0, -5.0], [5.0, 5.0], 5.0),
    ];
    match measured(&tiles.concat(), &[faces(0), faces(4)].concat()) {
        Err(SurveyError::CountedTwice(percent)) => near(percent, 25.0, 1.0),
        other => panic!("{other:?}"),
    }
    let floor = sheet([-5.0, -5.0], [5.0, 5.0], 0.0);
    assert!(matches!(
        measured(&floor, &[faces(0), faces(0)].concat()),
        Err(SurveyError::CountedTwice(_))
    ));
    // A box of 2 by 2 by 3 on the floor: its foot lies on it.
    let of_box = [
        sheet([-1.0, -1.0], [1.0, 1.0], 0.0),
        sheet([-1.0, -1.0], [1.0, 1.0], 3.0),
    ]
    .concat();
    let on_floor = [floor.to_vec(), of_box.clone()].concat();
    let outwards = [faces(0).to_vec(), body(4)].concat();
    for faces in [&outwards, &turned(&outwards)] {
        let found = measured(&on_floor, faces).unwrap();
        near(found.fill, 12.0, 1e-9);
        near(found.cut, 0.0, 1e-9);
        assert_eq!(found.bodies, 0.0);
    }
    let inwards = [faces(0).to_vec(), turned(&body(4))].concat();
    match measured(&on_floor, &inwards) {
        Err(SurveyError::TurnedOver(percent)) => near(percent, 100.0 * 4.0 / 64.0, 0.5),
        other => panic!("{other:?}"),
    }
    // Alone, either way round.
    for faces in [body(0), turned(&body(0))] {
        let found = measured(&of_box, &faces).unwrap();
        near(found.fill, 12.0, 1e-9);
        near(found.covered, 0.0, 1e-9);
        near(found.bodies, 4.0 / 64.0, 5e-3);
    }
    // As a base a mesh must not count twice either.
    let base = mesh(&tiles.concat(), &[faces(0), faces(4)].concat());
    let over = mesh(&floor, &faces(0));
    assert!(matches!(
        volume(&over, &polygon, Base::Surface(&base)),
        Err(SurveyError::CountedTwice(_))
    ));
}
