//! Rays at surfaces whose answers are known, and the two ways to meet them against each other.

mod holes;

use glam::DVec2;
use proptest::prelude::*;

use super::caster::Way;
use super::*;
use crate::geometry::Ray;

fn cloud(points: Vec<DVec3>) -> Cloud {
    Cloud {
        points,
        ..Cloud::default()
    }
}

fn surface(points: Vec<DVec3>) -> Surface {
    Surface::new(cloud(points)).unwrap()
}

/// A generator of numbers in 0..1 that needs no crate: Knuth's MMIX.
fn random(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Bumps on a square of 100 by 100.
fn bumpy(count: usize, seed: u64) -> Vec<DVec3> {
    let mut random = random(seed);
    (0..count)
        .map(|_| {
            let (x, y) = (random() * 100.0, random() * 100.0);
            DVec3::new(
                x,
                y,
                5.0 * (x * 0.2).sin() * (y * 0.13).cos() + random() * 0.3,
            )
        })
        .collect()
}

/// A horizontal lattice of `side` x `side` points, one unit apart.
fn lattice(side: i32, z: impl Fn(f64, f64) -> f64) -> Vec<DVec3> {
    (0..side)
        .flat_map(|x| (0..side).map(move |y| (f64::from(x), f64::from(y))))
        .map(|(x, y)| DVec3::new(x, y, z(x, y)))
        .collect()
}

/// Some triangle by triangle, with plain fractions: slow, and independent of both ways.
fn brute_force(surface: &Surface, ray: &Ray) -> Option<f64> {
    let vertices: Vec<DVec3> = surface.vertices().collect();
    let mut nearest: Option<f64> = None;
    for triangle in surface.triangles().unwrap() {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        let normal = (b - a).cross(c - a);
        let t = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
        let p = ray.at(t);
        let inside = [(a, b), (b, c), (c, a)]
            .iter()
            .all(|&(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0);
        if t > 0.0 && inside && nearest.is_none_or(|n| t < n) {
            nearest = Some(t);
        }
    }
    nearest
}

fn down(x: f64, y: f64) -> Ray {
    Ray {
        origin: DVec3::new(x, y, 50.0),
        direction: DVec3::NEG_Z,
    }
}

#[test]
fn a_plane_is_met_where_it_should_be() {
    let z = |x: f64, y: f64| 3.0 + 0.25 * x - 0.5 * y;
    let surface = surface(lattice(20, z));
    let mut caster = surface.caster().unwrap();
    let mut random = random(7);
    for _ in 0..500 {
        let target = DVec3::new(random() * 19.0, random() * 19.0, 0.0);
        let target = target.with_z(z(target.x, target.y));
        let origin = DVec3::new(random() * 40.0 - 10.0, random() * 40.0 - 10.0, 60.0);
        let ray = Ray {
            origin,
            direction: (target - origin).normalize(),
        };
        let hit = caster.cast(&ray).unwrap();
        assert!(
            (hit.point - target).length() < 1e-12,
            "{} for {target}",
            hit.point
        );
    }
}

#[test]
fn both_ways_agree_on_rough_ground() {
    for (count, seed) in [(30, 1), (900, 2), (5_000, 3), (40_000, 4)] {
        let surface = surface(bumpy(count, seed));
        let mesh = surface.to_mesh().unwrap();
        let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
        let mut random = random(seed + 100);
        let mut hits = 0;
        for _ in 0..400 {
            let origin = DVec3::new(
                random() * 140.0 - 20.0,
                random() * 140.0 - 20.0,
                random() * 40.0,
            );
            let direction = DVec3::new(random() - 0.5, random() - 0.5, -random() * 1.5 + 0.1);
            let ray = Ray {
                origin,
                direction: direction.normalize(),
            };
            let (a, b) = (walk.cast(&ray), tree.cast(&ray));
            assert_eq!(a.is_some(), b.is_some(), "{count} points, {ray:?}");
            if let (Some(a), Some(b)) = (a, b) {
                assert!(
                    (a.t - b.t).abs() < 1e-9,
                    "{count} points, {ray:?}: {} or {}",
                    a.t,
                    b.t
                );
                hits += 1;
            }
            if count < 1_000 {
                let t = brute_force(&surface, &ray);
                assert_eq!(t.is_some(), a.is_some(), "{ray:?}");
                assert!(t.is_none_or(|t| (t - a.unwrap().t).abs() < 1e-9), "{ray:?}");
            }
        }
        assert!(hits > 100, "only {hits} hits");
    }
}

/// The walk builds a fraction of the triangles and still ends on the right ones.
#[test]
fn few_rays_build_little() {
    let surface = surface(bumpy(200_000, 5));
    let mut caster = surface.caster().unwrap();
    for i in 0..36 {
        let angle = f64::from(i) * 0.17;
        let ray = Ray {
            origin: DVec3::new(50.0, 50.0, 40.0),
            direction: DVec3::new(angle.cos() * 0.6, angle.sin() * 0.6, -1.0).normalize(),
        };
        assert!(caster.cast(&ray).is_some());
    }
    let Way::Walk(walk) = &caster.way else {
        panic!("a cloud is walked on");
    };
    let built = walk.vertex_count();
    assert!(built < 20_000, "{built} of 200 000 sites were triangulated");
}

/// A caster for many rays meets the same as one for a few, and changes of the maximal edge share
/// what it built.
#[test]
fn a_caster_for_many_rays_agrees() {
    let surface = surface(bumpy(20_000, 51));
    let is_walk = |caster: &Caster<'_>| matches!(caster.way, Way::Walk(_));
    assert!(is_walk(&surface.caster_for(500).unwrap()));
    let holed = surface.with_max_edge(Some(1.2)).unwrap();
    for surface in [&surface, &holed] {
        let (mut few, mut many) = (surface.caster().unwrap(), surface.caster_for(1000).unwrap());
        assert!(is_walk(&few) && !is_walk(&many));
        let mut random = random(52);
        for _ in 0..200 {
            let ray = Ray {
                origin: DVec3::new(random() * 110.0 - 5.0, random() * 110.0 - 5.0, 30.0),
                direction: DVec3::new(random() - 0.5, random() - 0.5, -1.0).normalize(),
            };
            let (a, b) = (few.cast(&ray), many.cast(&ray));
            assert_eq!(a.is_some(), b.is_some(), "{ray:?}");
            assert!(a.is_none_or(|a| (a.t - b.unwrap().t).abs() < 1e-9));
        }
    }
    let meshes = [&surface, &holed].map(|s| Arc::as_ptr(s.whole.mesh.get().unwrap()));
    assert_eq!(meshes[0], meshes[1]);
}

/// The first rays on a mesh look at every triangle, later ones use the hierarchy: same answers.
#[test]
fn a_mesh_answers_the_same_before_and_after_its_hierarchy() {
    let whole = surface(bumpy(2_000, 21));
    let triangles = whole.triangles().unwrap();
    let mesh = Cloud {
        points: whole.vertices().collect(),
        triangles,
        ..Cloud::default()
    };
    let mesh = Surface::new(mesh).unwrap();
    let mut caster = mesh.caster().unwrap();
    let mut random = random(22);
    let rays: Vec<Ray> = (0..100)
        .map(|_| Ray {
            origin: DVec3::new(random() * 120.0 - 10.0, random() * 120.0 - 10.0, 30.0),
            direction: DVec3::new(random() - 0.5, random() - 0.5, -1.0).normalize(),
        })
        .collect();
    let first: Vec<_> = rays.iter().map(|ray| caster.cast(ray)).collect();
    let Shape::Mesh(shape) = &mesh.whole.shape else {
        panic!("a file with faces is a mesh");
    };
    shape.hierarchy();
    let second: Vec<_> = rays.iter().map(|ray| caster.cast(ray)).collect();
    assert_eq!(first, second);
    assert!(first.iter().flatten().count() > 50);
}

#[test]
fn no_ray_slips_through_an_edge_or_a_vertex() {
    let bumps = |x: f64, y: f64| (x * 1.3).sin() + (y * 0.7).cos();
    for points in [lattice(30, bumps), bumpy(3_000, 9)] {
        let surface = surface(points);
        let mesh = surface.to_mesh().unwrap();
        let vertices: Vec<DVec3> = surface.vertices().collect();
        let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
        let middle = DVec3::new(15.0, 15.0, 30.0);
        for triangle in surface.triangles().unwrap().into_iter().step_by(3) {
            let [a, b, c] = triangle.map(|i| vertices[i as usize]);
            for target in [a, b, (a + b) / 2.0, b.lerp(c, 0.1), a.lerp(c, 1.0 / 3.0)] {
                for origin in [
                    middle,
                    target + DVec3::new(0.0, 0.0, 10.0),
                    target + DVec3::new(3.0, 0.0, 9.0),
                ] {
                    let ray = Ray {
                        origin,
                        direction: (target - origin).normalize(),
                    };
                    let limit = (target - origin).length() + 1e-9;
                    let (a, b) = (walk.cast(&ray), tree.cast(&ray));
                    assert!(
                        a.is_some_and(|hit| hit.t < limit),
                        "walk: {target} from {origin}: {a:?}"
                    );
                    assert!(
                        b.is_some_and(|hit| hit.t < limit),
                        "tree: {target} from {origin}: {b:?}"
                    );
                }
            }
        }
    }
}

/// Footprints often end exactly at the rim of a surface that somebody cut out.
#[test]
fn the_rim_belongs_to_the_surface() {
    for offset in [DVec3::ZERO, DVec3::new(500_000.3, 5_000_000.7, 161.1)] {
        let points: Vec<DVec3> = lattice(11, |x, y| (x - y) * 0.1)
            .into_iter()
            .map(|p| p + offset)
            .collect();
        let surface = surface(points.clone());
        let mesh = surface.to_mesh().unwrap();
        let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
        let rim = points.iter().filter(|p| {
            let local = **p - offset;
            [local.x, local.y]
                .iter()
                .any(|c| c.round() == 0.0 || c.round() == 10.0)
        });
        for &target in rim {
            for from in [
                (5.0, 5.0, 20.0),
                (0.0, 0.0, 15.0),
                (0.0, 5.0, 12.0),
                (30.0, -7.0, 9.0),
            ] {
                let origin = offset + DVec3::new(from.0, from.1, from.2);
                let ray = Ray {
                    origin,
                    direction: (target - origin).normalize(),
                };
                for hit in [walk.cast(&ray), tree.cast(&ray)] {
                    let hit = hit.unwrap_or_else(|| panic!("{target} from {origin} is missed"));
                    assert!(hit.t < (target - origin).length() + 1e-7);
                }
            }
            let above = Ray {
                origin: target + DVec3::Z,
                direction: DVec3::NEG_Z,
            };
            assert!(walk.cast(&above).is_some() && tree.cast(&above).is_some());
        }
        // A millimetre beside it is not on it.
        let beside = Ray {
            origin: offset + DVec3::new(-0.001, 5.0, 9.0),
            direction: DVec3::NEG_Z,
        };
        assert!(walk.cast(&beside).is_none() && tree.cast(&beside).is_none());
    }
}

#[test]
fn the_nearest_hit_in_front_counts_from_either_side() {
    // A ridge: a level ray from the west meets its west flank, one from inside meets it from below.
    let surface = surface(lattice(41, |x, _| 10.0 - (x - 20.0).abs()));
    let mesh = surface.to_mesh().unwrap();
    for mut caster in [surface.caster().unwrap(), mesh.caster().unwrap()] {
        let mut cast = |x: f64, direction: DVec3| {
            let ray = Ray {
                origin: DVec3::new(x, 20.3, 5.0),
                direction,
            };
            caster.cast(&ray).map(|hit| hit.point.x)
        };
        assert!((cast(0.0, DVec3::X).unwrap() - 15.0).abs() < 1e-12);
        assert!((cast(20.0, DVec3::X).unwrap() - 25.0).abs() < 1e-12);
        assert!((cast(20.0, DVec3::NEG_X).unwrap() - 15.0).abs() < 1e-12);
        assert_eq!(cast(0.0, DVec3::NEG_X), None);
        assert_eq!(cast(30.0, DVec3::Z), None);
        assert!((cast(30.0, DVec3::NEG_Z).unwrap() - 30.0).abs() < 1e-12);
    }
}

#[test]
fn utm_coordinates_give_the_same_distances() {
    let points = bumpy(20_000, 11);
    let offset = DVec3::new(500_000.0, 5_000_000.0, 200.0);
    let near = surface(points.clone());
    let far = surface(points.into_iter().map(|p| p + offset).collect());
    let (mut near, mut far) = (near.caster().unwrap(), far.caster().unwrap());
    for i in 0..200 {
        let angle = f64::from(i) * 0.7;
        let direction = DVec3::new(angle.cos() * 0.8, angle.sin() * 0.8, -1.0).normalize();
        let origin = DVec3::new(50.0, 50.0, 30.0);
        let a = near.cast(&Ray { origin, direction }).unwrap();
        let b = far
            .cast(&Ray {
                origin: origin + offset,
                direction,
            })
            .unwrap();
        // The offset rounds the heights to 1e-9.
        assert!((a.t - b.t).abs() < 2e-8, "{} or {}", a.t, b.t);
    }
}

/// Found by the property test below: the ray lies in the plane of the only triangle and enters it on
/// its rim at (9, 3, 2).
#[test]
fn a_ray_in_a_triangles_plane_meets_it_where_it_enters() {
    let corners = [(8.0, 3.0, 3.0), (9.0, 1.0, 1.0), (11.0, 3.0, 0.0)];
    let surface = surface(corners.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec());
    let mesh = surface.to_mesh().unwrap();
    let origin = DVec3::new(-3.0, 15.0, 20.0);
    let entry = DVec3::new(9.0, 3.0, 2.0);
    let ray = Ray {
        origin,
        direction: (entry - origin).normalize(),
    };
    for mut caster in [surface.caster().unwrap(), mesh.caster().unwrap()] {
        let hit = caster.cast(&ray).unwrap();
        assert!((hit.point - entry).length() < 1e-9, "{}", hit.point);
    }
}

#[test]
fn degenerate_clouds_are_named() {
    let point = |x: f64, y: f64| DVec3::new(x, y, 1.0);
    let refuse = |points: Vec<DVec3>| Surface::new(cloud(points)).map(|_| ()).unwrap_err();
    assert_eq!(refuse(vec![]), SurfaceError::TooFewPoints(0));
    assert_eq!(
        refuse(vec![point(0.0, 0.0), point(1.0, 0.0)]),
        SurfaceError::TooFewPoints(2)
    );
    assert_eq!(
        refuse(vec![point(3.0, 4.0); 50]),
        SurfaceError::TooFewPoints(1)
    );
    let line = (0..2000)
        .map(|i| point(f64::from(i) * 0.1, f64::from(i) * 0.3))
        .collect();
    assert!(matches!(refuse(line), SurfaceError::OnOneLine));
    let upright = (0..2000).map(|i| point(7.0, f64::from(i))).collect();
    assert_eq!(refuse(upright), SurfaceError::OnOneLine);
    assert_eq!(
        refuse(vec![point(0.0, 0.0), point(f64::NAN, 0.0)]),
        SurfaceError::NotFinite(1)
    );
    assert_eq!(
        refuse(vec![point(f64::INFINITY, 0.0)]),
        SurfaceError::NotFinite(0)
    );
    assert_eq!(
        refuse(vec![point(0.0, 0.0), point(1.0, 0.0), point(0.0, 1e70)]),
        SurfaceError::TooFarOut
    );
    let faces = Cloud {
        points: vec![point(0.0, 0.0), point(1.0, 0.0), point(0.0, 1.0)],
        triangles: vec![[0, 1, 3]],
        ..Cloud::default()
    };
    assert!(matches!(
        Surface::new(faces.clone()).map(|_| ()).unwrap_err(),
        SurfaceError::NoSuchPoint { point: 3, .. }
    ));
    let flat = Cloud {
        triangles: vec![[0, 1, 1]],
        ..faces
    };
    assert_eq!(
        Surface::new(flat).map(|_| ()).unwrap_err(),
        SurfaceError::NoTriangles
    );
}

#[test]
fn many_points_on_one_circle_make_a_disc() {
    let count = 100_000;
    let circle: Vec<DVec3> = (0..count)
        .map(|i| {
            let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), 2.0)
        })
        .collect();
    let surface = surface(circle);
    let mut caster = surface.caster().unwrap();
    assert_eq!(caster.cast(&down(0.3, 0.2)).unwrap().point.z, 2.0);
    assert!(caster.cast(&down(0.9, 0.9)).is_none());
}

#[test]
fn a_few_stray_points_far_away_change_nothing_here() {
    let mut points = bumpy(30_000, 12);
    let near = surface(points.clone());
    points.extend([
        DVec3::new(90_000.0, 20.0, 900.0),
        DVec3::new(-70_000.0, -80_000.0, -5.0),
    ]);
    let far = surface(points);
    let (mut near, mut far) = (near.caster().unwrap(), far.caster().unwrap());
    for i in 0..50 {
        let at = f64::from(i) + 20.0;
        let (a, b) = (
            near.cast(&down(at, at)).unwrap(),
            far.cast(&down(at, at)).unwrap(),
        );
        assert!((a.t - b.t).abs() < 1e-9);
    }
}

/// On the plane z = x / 2 the triangles of a unit lattice have a diagonal of √(2 + ¼) = 1.5.
#[test]
fn a_hit_knows_the_size_of_its_triangle() {
    let surface = surface(lattice(50, |x, _| x / 2.0));
    let mesh = surface.to_mesh().unwrap();
    for mut caster in [surface.caster().unwrap(), mesh.caster().unwrap()] {
        for (x, y) in [(3.3, 4.4), (20.0, 30.2), (20.0, 30.0)] {
            let hit = caster.cast(&down(x, y)).unwrap();
            assert!((hit.longest_edge - 1.5).abs() < 1e-12, "{hit:?}");
        }
    }
}

#[test]
fn colours_stay_with_their_points() {
    let points = bumpy(3_000, 41);
    // Each point twice at one place, the lower one black.
    let doubled: Vec<DVec3> = points.iter().flat_map(|&p| [p - DVec3::Z, p]).collect();
    let color = |p: DVec3| [(p.x * 2.0) as u8, (p.y * 2.0) as u8, 1];
    let colors = points.iter().flat_map(|&p| [[0, 0, 0], color(p)]).collect();
    let cloud = Cloud {
        points: doubled,
        colors,
        ..Cloud::default()
    };
    let surface = Surface::new(cloud.clone()).unwrap();
    let thinned = SurfaceOptions {
        thinning: Some(5.0),
        max_edge: None,
    };
    let thinned = Surface::with_options(cloud, &thinned).unwrap();
    assert_eq!(thinned.vertices().len(), 400);
    for surface in [&surface, &surface.to_mesh().unwrap(), &thinned] {
        assert_eq!(surface.colors().len(), surface.vertices().len());
        for (point, &found) in surface.vertices().zip(surface.colors()) {
            assert_eq!(found, color(point), "{point}");
        }
    }
    assert!(super::tests::surface(bumpy(10, 1)).colors().is_empty());
    // A mesh keeps the file's order, and is not thinned.
    let mesh = Cloud {
        points: vec![DVec3::X, DVec3::Y, DVec3::ZERO],
        colors: vec![[1, 2, 3], [4, 5, 6], [7, 8, 9]],
        triangles: vec![[0, 1, 2]],
    };
    let options = SurfaceOptions {
        thinning: Some(100.0),
        max_edge: None,
    };
    let mesh = Surface::with_options(mesh, &options).unwrap();
    assert_eq!(mesh.colors(), [[1, 2, 3], [4, 5, 6], [7, 8, 9]]);
    assert_eq!(mesh.vertices().nth(1), Some(DVec3::Y));
}

#[test]
fn lengths_that_are_none_are_refused() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for (max_edge, thinning) in [(Some(value), None), (None, Some(value))] {
            let options = SurfaceOptions { max_edge, thinning };
            let refused = Surface::with_options(cloud(bumpy(10, 1)), &options);
            assert!(matches!(refused, Err(SurfaceError::Option { .. })));
        }
        assert!(surface(bumpy(10, 1)).with_max_edge(Some(value)).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Coordinates on a coarse lattice: ties, collinear and co-circular points all over.
    #[test]
    fn coarse_clouds_agree_with_brute_force(
        points in prop::collection::vec((0..12_i32, 0..12_i32, 0..4_i32), 3..200),
        rays in prop::collection::vec((-4..16_i32, -4..16_i32, -4..16_i32, -4..16_i32), 1..10),
        max_edge in prop::option::of(1.2..9.0_f64),
    ) {
        let points = points.into_iter()
            .map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)))
            .collect();
        let options = SurfaceOptions { max_edge, thinning: None };
        let Ok(surface) = Surface::with_options(cloud(points), &options) else { return Ok(()) };
        let mesh = surface.to_mesh().unwrap();
        let (mut walk, mut tree) = (surface.caster().unwrap(), mesh.caster().unwrap());
        for (x0, y0, x1, y1) in rays {
            let origin = DVec3::new(f64::from(x0), f64::from(y0), 20.0);
            let target = DVec3::new(f64::from(x1), f64::from(y1), 0.5);
            let ray = Ray { origin, direction: (target - origin).normalize() };
            let (a, b) = (walk.cast(&ray), tree.cast(&ray));
            prop_assert_eq!(a.is_some(), b.is_some(), "{:?}", ray);
            if let (Some(a), Some(b)) = (a, b) {
                prop_assert!((a.t - b.t).abs() < 1e-9, "{:?} {} {}", ray, a.t, b.t);
            }
        }
    }
}

/// Over several blocks of vertices, at UTM coordinates, from a formula: no digit is lost.
#[test]
fn bounds_are_those_of_the_vertices() {
    let points: Vec<DVec3> = (0..20_000_u32)
        .map(|i| {
            let (x, y) = (f64::from(i % 200), f64::from(i / 200));
            DVec3::new(500_000.25 + x, 5_000_000.5 + 2.0 * y, 160.0 + (x * y) / 8.0)
        })
        .collect();
    let surface = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    assert!(surface.vertex_blocks().len() > 1);
    let bounds = surface.bounds();
    assert_eq!(bounds.min, DVec3::new(500_000.25, 5_000_000.5, 160.0));
    assert_eq!(
        bounds.max,
        DVec3::new(500_199.25, 5_000_198.5, 160.0 + 199.0 * 99.0 / 8.0)
    );
}
