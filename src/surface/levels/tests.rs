//! Tests of the levels of detail.

use proptest::prelude::*;

use super::*;
use crate::split_mix::SplitMix;
use crate::surface::Cloud;

fn surface(points: Vec<DVec3>) -> Surface {
    Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap()
}

fn levels(points: Vec<DVec3>) -> Levels {
    let levels = Levels::new(&surface(points), &Progress::default());
    levels.unwrap().unwrap()
}

/// Points of a square of `size`, with a seed.
fn random(count: usize, size: f64, seed: u64) -> Vec<DVec3> {
    let mut random = SplitMix(seed);
    let mut uniform = || random.unit();
    let points = (0..count).map(|_| DVec3::new(uniform() * size, uniform() * size, uniform()));
    points.collect()
}

/// Every vertex is in one node, in its box and in the boxes of all above it, and nodes say how many they have.
fn check(levels: &Levels) {
    let vertices: Vec<DVec3> = levels.surface().vertices().collect();
    let mut times = vec![0_u8; vertices.len()];
    let mut above: Vec<Option<usize>> = vec![None; levels.nodes().len()];
    for (index, node) in levels.nodes().iter().enumerate() {
        let points = levels.points_of(node);
        assert_eq!(points.len(), node.count);
        for child in node.children.clone() {
            assert!(child > index && above[child].is_none());
            above[child] = Some(index);
        }
        for (vertex, point) in points {
            times[vertex] += 1;
            assert_eq!(point, vertices[vertex]);
            let mut at = Some(index);
            while let Some(node) = at {
                assert!(levels.nodes()[node].bounds.contains(point));
                at = above[node];
            }
        }
        assert!(!node.children.is_empty() || node.count <= LEAF);
        assert!(node.spacing.is_finite());
    }
    assert!(times.iter().all(|&times| times == 1));
    assert!(above[1..].iter().all(Option::is_some));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Clouds of any density: a square, a heap in one of its corners that is much denser, some far away.
    #[test]
    fn every_point_is_in_one_node(
        seed in any::<u64>(),
        count in 3..200_000_usize,
        heap in 0..200_000_usize,
        heap_size in prop::sample::select(vec![1e-6, 0.01, 1.0, 30.0]),
        far in 0..20_usize,
    ) {
        let mut points = random(count, 100.0, seed);
        points.extend(random(heap, heap_size, seed ^ 1));
        points.extend(random(far, 1e7, seed ^ 2));
        check(&levels(points));
    }
}

/// Of points with equal (x, y) the surface has one, the highest; so have the levels.
#[test]
fn of_points_above_each_other_one_is_there() {
    let mut points = random(60_000, 10.0, 4);
    points.extend(points.clone().iter().map(|&point| point - DVec3::Z));
    points.extend(points.clone());
    let levels = levels(points);
    check(&levels);
    let count: usize = levels.nodes().iter().map(|node| node.count).sum();
    assert_eq!(count, 60_000);
}

/// As narrow as a surface may be: on one line none can be made, nor of one point.
#[test]
fn a_strip_is_cut_along() {
    let mut points = random(150_000, 1.0, 5);
    for point in &mut points {
        point.y *= 1e-5;
    }
    let levels = levels(points);
    check(&levels);
    for node in levels.nodes().iter().filter(|n| n.children.is_empty()) {
        // Quarters of quarters of the strip's half at most.
        assert!(node.bounds.size().x < 0.3);
    }
    for no_surface in [vec![DVec3::ONE], random(1, 1.0, 1).repeat(50)] {
        let cloud = Cloud {
            points: no_surface,
            ..Cloud::default()
        };
        assert!(Surface::new(cloud).is_err());
    }
}

/// Few points are one node.
#[test]
fn few_points_are_one_node() {
    let levels = levels(random(LEAF, 5.0, 6));
    check(&levels);
    assert_eq!(levels.nodes().len(), 1);
}

/// The root of an even cloud is an even sample of it: of a 10 x 10 raster each cell has about a hundredth,
/// and no two of its points are much nearer than its spacing.
#[test]
fn the_root_is_an_even_sample() {
    let levels = levels(random(400_000, 10.0, 7));
    check(&levels);
    let root = &levels.nodes()[0];
    assert!(root.count > GROUPS * GROUPS * 9 / 10 && root.count <= GROUPS * GROUPS);
    let mut cells = [0_usize; 100];
    for (_, point) in levels.points_of(root) {
        cells[(point.x as usize).min(9) + 10 * (point.y as usize).min(9)] += 1;
    }
    let mean = root.count / 100;
    // A fair draw would have a standard deviation of 13.
    assert!(
        cells.iter().all(|&count| count.abs_diff(mean) < 30),
        "{cells:?}"
    );
    assert!((root.spacing - 10.0 / GROUPS as f64).abs() < 0.01);
}

fn all_counts(levels: &Levels) -> usize {
    levels.nodes().iter().map(|node| node.count).sum()
}

#[test]
fn the_choice_keeps_to_the_budget_and_is_whole_where_it_can_be() {
    let levels = levels(random(500_000, 10.0, 8));
    let all = all_counts(&levels);
    assert_eq!(all, 500_000);
    for most in [0, 1000, 20_000, 100_000, 499_999, 500_000, usize::MAX] {
        let chosen = levels.choose(most, 0.0, |node| Some(node.spacing));
        assert!(chosen.points <= most);
        let counts = chosen.nodes.iter().map(|&node| levels.nodes()[node].count);
        assert_eq!(counts.sum::<usize>(), chosen.points);
        assert_eq!(chosen.is_whole, most >= all);
        assert_eq!(chosen.nodes.len() == levels.nodes().len(), most >= all);
        // No leaf is larger, so that no more is left of the budget than its node.
        assert!(most >= all || chosen.points + LEAF > most);
        // Whoever is chosen has all above it chosen before.
        for (place, &node) in chosen.nodes.iter().enumerate().skip(1) {
            let mut before = chosen.nodes[..place].iter();
            assert!(before.any(|&above| levels.nodes()[above].children.contains(&node)));
        }
        assert!(chosen.looked_at <= 4 * chosen.nodes.len() + 1);
    }
}

#[test]
fn the_choice_is_finer_where_it_is_nearer_and_leaves_out_what_is_not_in_sight() {
    let levels = levels(random(500_000, 10.0, 9));
    let eye = DVec3::new(0.0, 0.0, 1.0);
    let distance = |bounds: &Bounds| eye.distance(eye.clamp(bounds.min, bounds.max)).max(0.1);
    let near = levels.choose(200_000, 0.0, |node| {
        Some(node.spacing / distance(&node.bounds))
    });
    let mean = |nodes: &[usize]| {
        let leaves = nodes.iter().map(|&node| &levels.nodes()[node]);
        let leaves: Vec<f64> = leaves
            .filter(|node| node.children.is_empty())
            .map(|node| distance(&node.bounds))
            .collect();
        leaves.iter().sum::<f64>() / leaves.len() as f64
    };
    let all = levels.choose(usize::MAX, 0.0, |node| Some(node.spacing));
    assert!(mean(&near.nodes) < 0.8 * mean(&all.nodes));
    let left = levels.choose(usize::MAX, 0.0, |node| {
        (node.bounds.min.x < 4.0).then_some(node.spacing)
    });
    assert!(left.is_whole && left.nodes.len() < all.nodes.len());
    for &node in &left.nodes {
        assert!(levels.nodes()[node].bounds.min.x < 4.0);
    }
    // Fine enough at the top.
    let coarse = levels.choose(usize::MAX, 1.0, |node| Some(node.spacing));
    assert_eq!((coarse.nodes, coarse.is_whole), (vec![0], true));
}

#[test]
fn cancelling_ends_it() {
    let progress = Progress::default();
    progress.cancel();
    let surface = surface(random(100, 1.0, 1));
    assert!(Levels::new(&surface, &progress).is_err());
}

#[test]
fn a_mesh_has_none() {
    let mesh = surface(random(100, 1.0, 1)).to_mesh().unwrap();
    assert!(Levels::new(&mesh, &Progress::default()).unwrap().is_none());
}
