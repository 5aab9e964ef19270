//! Parts against the whole, to the last bit.

use glam::DVec2;

use super::*;
use crate::geometry::Ray;
use crate::surface::{Cloud, Patch};

struct Random(crate::split_mix::SplitMix);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0.unit()
    }
}

/// Blocks of rock with holes between, at UTM coordinates rounded to `step`, some places twice, a few points far out.
fn rock(seed: u64, count: usize, step: f64) -> Vec<DVec3> {
    let mut random = Random(crate::split_mix::SplitMix(seed));
    let origin = DVec3::new(452_000.0, 5_411_000.0, 100.0);
    let mut points = Vec::new();
    while points.len() < count {
        let place = DVec2::new(random.uniform(), random.uniform()) * 200.0;
        if (place - DVec2::new(90.0, 110.0)).length() < 7.0 {
            continue;
        }
        let z = (place.x * 0.7).sin() * (place.y * 0.4).cos() * 2.0 + random.uniform() * 0.2;
        let rounded = (place.extend(z) / step).round() * step;
        points.push(origin + rounded);
        if random.uniform() < 0.02 {
            points.push(origin + rounded.with_z(rounded.z - 0.3));
        }
    }
    points.extend((0..5).map(|i| origin + DVec3::new(f64::from(i) * 150.0 - 200.0, 420.0, 1.0)));
    points
}

fn lattice() -> Vec<DVec3> {
    let places = (0..500).flat_map(|row| (0..700).map(move |column| (column, row)));
    let points = places.map(|(column, row)| {
        let [x, y] = [column, row].map(f64::from);
        DVec3::new(x * 0.5, y * 0.5, (x * 0.3).sin() + (y * 0.2).cos())
    });
    points.collect()
}

fn plan(points: &[DVec3]) -> PartPlan {
    let bounds = Bounds::of(points).unwrap();
    let stride = CloudFacts::sample_stride(points.len() as u64) as usize;
    let facts = CloudFacts {
        count: points.len() as u64,
        bounds,
        sample: points.iter().step_by(stride).copied().collect(),
    };
    let mut hull = HullOfMany::new(&bounds);
    for portion in points.chunks(7001) {
        let corners = hull.corners_of(portion);
        hull.take(&corners);
    }
    assert!(hull.is_of(&bounds));
    PartPlan::new(facts, &hull).unwrap()
}

/// What rays from above some places meet, what lies in a box, and how well it predicts its points.
fn answers(surface: &Surface, around: DVec3, size: f64) -> Vec<u64> {
    let mut random = Random(crate::split_mix::SplitMix(3));
    let mut bits = Vec::new();
    let mut caster = surface.caster().unwrap();
    for _ in 0..60 {
        let mut next = || random.uniform() - 0.5;
        let origin = around + DVec3::new(next() * size, next() * size, 30.0);
        let direction = DVec3::new(next() * 0.8, next() * 0.8, -1.0).normalize();
        for direction in [direction, DVec3::NEG_Z] {
            let hit = caster.cast(&Ray { origin, direction });
            bits.push(hit.map_or(0, |hit| hit.t.to_bits()));
            bits.push(hit.map_or(0, |hit| hit.longest_edge.to_bits()));
        }
    }
    let middle = surface.frame().local_from_world(around);
    let (low, high) = (middle - size / 2.0, middle + size / 2.0);
    let misses = |bounds: &Bounds| bounds.min.cmpgt(high).any() || bounds.max.cmplt(low).any();
    let inside = |p: DVec3| p.cmpge(low).all() && p.cmple(high).all();
    let patches = surface.patches().seen(misses).unwrap();
    for patch in &patches {
        for corners in patch.triangles_seen(misses) {
            if corners.iter().any(|&corner| inside(corner)) {
                bits.extend(corners.iter().flat_map(|c| c.to_array().map(f64::to_bits)));
            }
        }
    }
    for left_out in Patch::left_out(&patches).filter(|left_out| inside(left_out.point)) {
        bits.extend([left_out.above.to_bits(), left_out.star.to_bits()]);
    }
    let world = |bounds: &Bounds| {
        let frame = surface.frame();
        misses(&Bounds {
            min: frame.local_from_world(bounds.min),
            max: frame.local_from_world(bounds.max),
        })
    };
    let frame = surface.frame();
    let seen = surface
        .vertices_seen(world)
        .filter(|&p| inside(frame.local_from_world(p)));
    let mut heights: Vec<u64> = seen.map(|vertex| vertex.z.to_bits()).collect();
    heights.sort_unstable();
    bits.extend(heights);
    bits.extend(surface.usual_heights().unwrap().map(f64::to_bits));
    bits
}

/// Grows a part until it says what it was asked; how many of its blocks it then holds.
fn settled(
    points: &[DVec3],
    plan: &PartPlan,
    ask: impl Fn(&Surface) -> Vec<u64>,
) -> (Vec<u64>, usize) {
    let mut held = BTreeSet::new();
    for _ in 0..50 {
        let here = points
            .iter()
            .filter(|&&point| held.contains(&plan.block_of(point)));
        let here: Vec<DVec3> = here.copied().collect();
        let part = plan.surface(&here, &held, None).unwrap();
        let found = ask(&part);
        let wanted = part.wanted();
        assert_eq!(wanted.all, None);
        if wanted.is_nothing() {
            return (found, held.len());
        }
        let before = held.len();
        held.extend(wanted.blocks);
        assert!(held.len() > before);
    }
    panic!("it does not end");
}

fn whole_of(points: &[DVec3]) -> Surface {
    Surface::new(Cloud {
        points: points.to_vec(),
        ..Cloud::default()
    })
    .unwrap()
}

#[test]
fn a_part_says_what_the_whole_says() {
    for (seed, step) in [(1, 1e-3), (3, 0.05)] {
        let points = rock(seed, 250_000, step);
        let plan = plan(&points);
        let whole = whole_of(&points);
        // In the middle; at the hole; at the rim of the bulk.
        for (x, y, least) in [
            (50.0, 60.0, 500),
            // Rays alone: of what lies in the box nothing is there.
            (90.0, 110.0, 240),
            (199.0, 100.0, 500),
            (3.0, 198.0, 500),
        ] {
            let around = DVec3::new(452_000.0 + x, 5_411_000.0 + y, 100.0);
            let expected = answers(&whole, around, 9.0);
            let (found, held) = settled(&points, &plan, |part| answers(part, around, 9.0));
            assert!(expected.len() > least, "{}", expected.len());
            assert!(found == expected, "seed {seed}, around {x}, {y}");
            assert!(
                held < plan.block_count(),
                "{held} of {}",
                plan.block_count()
            );
        }
        // In the middle no more than half of it is needed, though the cloud is small: 3 x 3 blocks, and those that circles
        // reach into on the way.
        let around = DVec3::new(452_050.0, 5_411_060.0, 100.0);
        let (_, held) = settled(&points, &plan, |part| answers(part, around, 9.0));
        assert!(
            2 * held <= plan.block_count(),
            "{held} of {}",
            plan.block_count()
        );
    }
}

/// Of four points on one circle there are two triangulations: all ask the tiles, which have one.
#[test]
fn on_a_lattice_too() {
    let points = lattice();
    let plan = plan(&points);
    let whole = whole_of(&points);
    for (x, y) in [(60.0, 60.0), (349.0, 30.0)] {
        let around = DVec3::new(x, y, 0.0);
        let expected = answers(&whole, around, 8.0);
        let (found, held) = settled(&points, &plan, |part| answers(part, around, 8.0));
        assert!(found == expected, "around {x}, {y}");
        assert!(held < plan.block_count());
    }
}

/// What a ray meets does not depend on which rays came before.
#[test]
fn rays_do_not_depend_on_each_other() {
    for points in [rock(5, 20_000, 1e-3), lattice()] {
        let surface = whole_of(&points);
        let middle = Bounds::of(&points[..10_000]).unwrap().center();
        let mut random = Random(crate::split_mix::SplitMix(8));
        let rays: Vec<Ray> = (0..40)
            .map(|_| {
                let mut next = || random.uniform() - 0.5;
                Ray {
                    origin: middle + DVec3::new(next() * 20.0, next() * 20.0, 15.0),
                    direction: DVec3::new(next(), next(), -1.0).normalize(),
                }
            })
            .collect();
        let mut caster = surface.caster().unwrap();
        let mut forth: Vec<_> = rays.iter().map(|ray| caster.cast(ray)).collect();
        let mut caster = surface.caster().unwrap();
        let back: Vec<_> = rays.iter().rev().map(|ray| caster.cast(ray)).collect();
        forth.reverse();
        assert_eq!(forth, back);
        // Some leave the surface at its side.
        assert!(back.iter().flatten().count() > 20);
    }
}

#[test]
fn what_needs_all_says_so() {
    let points = rock(4, 20_000, 1e-3);
    let plan = plan(&points);
    let part = plan.surface(&[], &BTreeSet::new(), None).unwrap();
    assert!(part.is_part() && part.wanted().is_nothing());
    assert_eq!(part.to_mesh().err(), Some(SurfaceError::OnlyAPart));
    assert!(part.wanted().all.is_some());
    let part = plan.surface(&[], &BTreeSet::new(), None).unwrap();
    let _ = part.bulk_bounds();
    assert!(part.wanted().all.is_some());
    assert_eq!(part.bounds(), whole_of(&points).bounds());
}

/// A box of a file that is larger than its points: the surface of all is laid out by it as well.
#[test]
fn what_a_file_says_holds_for_the_whole() {
    let points = rock(6, 30_000, 1e-3);
    let mut facts = plan(&points).facts;
    facts.bounds = facts.bounds.widened(3.25);
    facts.sample = points[..5000].iter().step_by(2).copied().collect();
    let mut hull = HullOfMany::new(&facts.bounds);
    let corners = hull.corners_of(&points);
    hull.take(&corners);
    let plan = PartPlan::new(facts.clone(), &hull).unwrap();
    let cloud = Cloud {
        points: points.clone(),
        ..Cloud::default()
    };
    let options = SurfaceOptions::default();
    let whole = Surface::with_facts(cloud.clone(), &options, Some(&facts)).unwrap();
    let around = DVec3::new(452_050.0, 5_411_060.0, 100.0);
    let expected = answers(&whole, around, 9.0);
    let (found, _) = settled(&points, &plan, |part| answers(part, around, 9.0));
    assert!(found == expected);
    assert_eq!(whole.bounds(), facts.bounds);
    // Not where it is wrong.
    facts.bounds.max.x -= 200.0;
    let whole = Surface::with_facts(cloud, &options, Some(&facts)).unwrap();
    assert_eq!(whole.bounds(), Bounds::of(&points).unwrap());
}
