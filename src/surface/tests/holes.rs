//! Rays and the holes that a longest edge leaves: through them, at their rims, and by both ways alike.

use super::*;

/// A 10 x 10 lattice with a hole: the points of 3 < x, y < 6 are missing, so over [3, 6]² there are
/// triangles with edges of √5 and more, and everywhere else none longer than √2 (level ground).
fn lattice_with_a_hole() -> Vec<DVec3> {
    let missing = |c: f64| c > 3.0 && c < 6.0;
    lattice(10, |_, _| 2.0)
        .into_iter()
        .filter(|p| !(missing(p.x) && missing(p.y)))
        .collect()
}

#[test]
fn rays_pass_through_holes_and_meet_their_rims() {
    let whole = surface(lattice_with_a_hole());
    let holed = whole.with_max_edge(Some(1.5)).unwrap();
    assert_eq!((whole.max_edge(), holed.max_edge()), (None, Some(1.5)));
    // 9 x 9 cells of two triangles, 3 x 3 of them in the hole; in each corner of it the three points
    // around a missing one make a triangle no larger than the others.
    let count = 2 * (81 - 9) + 4;
    assert_eq!(holed.triangles().unwrap().len(), count);
    assert_eq!(holed.vertices().len(), 96);
    for surface in [holed.clone(), holed.to_mesh().unwrap()] {
        assert_eq!(surface.triangles().unwrap().len(), count);
        let mut caster = surface.caster().unwrap();
        for (x, y, met) in [
            (4.5, 4.5, false),
            (3.001, 4.5, false),
            (2.999, 4.5, true),
            // Edges and corners of the hole belong to the surface.
            (3.0, 4.5, true),
            (6.0, 6.0, true),
            (4.0, 3.0, true),
        ] {
            assert_eq!(caster.cast(&down(x, y)).is_some(), met, "{x} {y}");
            // Aslant, from all sides.
            for i in 0..12 {
                let from = DVec2::from_angle(f64::from(i) * 0.53) * 7.0;
                let target = DVec3::new(x, y, 2.0);
                let origin = target + from.extend(5.0);
                let ray = Ray {
                    origin,
                    direction: (target - origin).normalize(),
                };
                assert_eq!(caster.cast(&ray).is_some(), met, "{x} {y} from {origin}");
            }
        }
        // Without the limit the hole is closed again.
        let closed = surface.with_max_edge(None).unwrap();
        assert!(closed.caster().unwrap().cast(&down(4.5, 4.5)).is_some());
    }
}

/// Through a hole in a ridge's near flank to its far one: z = 10 - |x - 20|, the hole over
/// 12 <= x <= 16, 10 <= y <= 30. A level ray at z = 4 from the west passes x = 14 and meets the far
/// flank at x = 26, a ray at z = 1 the near one at x = 11.
#[test]
fn a_ray_through_a_hole_meets_what_lies_behind() {
    let points = lattice(41, |x, _| 10.0 - (x - 20.0).abs())
        .into_iter()
        .filter(|p| !(p.x > 12.0 && p.x < 16.0 && p.y > 10.0 && p.y < 30.0));
    let surface = surface(points.collect()).with_max_edge(Some(2.0)).unwrap();
    let mesh = surface.to_mesh().unwrap();
    for mut caster in [surface.caster().unwrap(), mesh.caster().unwrap()] {
        let mut cast = |z: f64| {
            let ray = Ray {
                origin: DVec3::new(-5.0, 20.3, z),
                direction: DVec3::X,
            };
            caster.cast(&ray).unwrap().point.x
        };
        assert!((cast(4.0) - 26.0).abs() < 1e-12);
        assert!((cast(1.0) - 11.0).abs() < 1e-12);
    }
}

#[test]
fn both_ways_agree_about_holes() {
    for (count, max_edge, seed) in [
        (30, 30.0, 1),
        (900, 6.0, 2),
        (5_000, 2.5, 3),
        (40_000, 0.9, 4),
    ] {
        let surface = surface(bumpy(count, seed))
            .with_max_edge(Some(max_edge))
            .unwrap();
        let mesh = surface.to_mesh().unwrap();
        let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
        let mut random = random(seed + 200);
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..400 {
            let origin = DVec3::new(random() * 100.0, random() * 100.0, 10.0 + random() * 40.0);
            let direction = DVec3::new(random() - 0.5, random() - 0.5, -random() * 1.5);
            let ray = Ray {
                origin,
                direction: direction.normalize(),
            };
            let (a, b) = (walk.cast(&ray), tree.cast(&ray));
            assert_eq!(a.is_some(), b.is_some(), "{count} points, {ray:?}");
            let (Some(a), Some(b)) = (a, b) else {
                misses += 1;
                continue;
            };
            assert!((a.t - b.t).abs() < 1e-9, "{count} points, {ray:?}");
            assert!((a.longest_edge - b.longest_edge).abs() < 1e-9, "{ray:?}");
            assert!(a.longest_edge > 0.0 && a.longest_edge <= max_edge);
            hits += 1;
        }
        assert!(hits > 100 && misses > 30, "{hits} hits, {misses} misses");
    }
}

/// No ray slips through between two short triangles, wherever the long ones are.
#[test]
fn edges_and_vertices_of_short_triangles_belong_to_the_surface() {
    let surface = surface(bumpy(2_000, 31)).with_max_edge(Some(3.5)).unwrap();
    let mesh = surface.to_mesh().unwrap();
    let vertices: Vec<DVec3> = surface.vertices().collect();
    let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
    for triangle in surface.triangles().unwrap().into_iter().step_by(3) {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        for target in [a, (a + b) / 2.0, b.lerp(c, 0.1), a.lerp(c, 1.0 / 3.0)] {
            for from in [(0.0, 0.0, 10.0), (3.0, 0.0, 9.0), (-7.0, 11.0, 20.0)] {
                let origin = target + DVec3::from(from);
                let ray = Ray {
                    origin,
                    direction: (target - origin).normalize(),
                };
                let limit = (target - origin).length() + 1e-9;
                for hit in [walk.cast(&ray), tree.cast(&ray)] {
                    assert!(
                        hit.is_some_and(|hit| hit.t < limit),
                        "{target} from {origin}: {hit:?}"
                    );
                }
            }
        }
    }
}
