//! The choice against all choices, one by one.

use fragscale_core::jobs::Progress;
use fragscale_core::split_mix::SplitMix;

use super::*;
use crate::evidence::Evidence;
use crate::tree::tree;

fn small_tree(seed: u64) -> Tree {
    let mut random = SplitMix(seed);
    let (width, height) = (7, 5);
    let mut some = || {
        (0..width * height)
            .map(|_| random.next() as u8)
            .collect::<Vec<u8>>()
    };
    let evidence = Evidence {
        width,
        height,
        border: some(),
        rock: some(),
        middle: vec![0; width * height],
        gray: some(),
        votes: None,
    };
    tree(&evidence, &[], &Progress::default()).unwrap()
}

/// The most that nodes below one and itself can give, by trying all.
fn best(tree: &Tree, scores: &[f64], node: u32, least: f64) -> f64 {
    let own = (scores[node as usize] - least).max(0.0);
    match tree.nodes[node as usize].children {
        None => own,
        Some([a, b]) => own.max(best(tree, scores, a, least) + best(tree, scores, b, least)),
    }
}

#[test]
fn the_best_nodes_are_chosen() {
    for seed in 0..40 {
        let tree = small_tree(seed);
        let mut random = SplitMix(seed + 1000);
        let scores: Vec<f64> = tree
            .nodes
            .iter()
            .map(|_| (random.next() % 1000) as f64 / 1000.0)
            .collect();
        let taken = chosen(&tree, &scores, 0.4);
        let sum: f64 = taken.iter().map(|node| scores[*node as usize] - 0.4).sum();
        let root = tree.nodes.len() as u32 - 1;
        assert!(
            (sum - best(&tree, &scores, root, 0.4)).abs() < 1e-9,
            "seed {seed}"
        );
        // None lies within another, and the labels are theirs.
        for node in &taken {
            let mut above = tree.nodes[*node as usize].parent;
            while let Some(parent) = above {
                assert!(!taken.contains(&parent));
                above = tree.nodes[parent as usize].parent;
            }
        }
        let labels = labelled(&tree, &taken);
        assert_eq!(labels.areas().iter().sum::<usize>(), 35);
        for (label, node) in (1..).zip(&taken) {
            assert_eq!(
                labels.areas()[label] as f64,
                tree.nodes[*node as usize].sums.area
            );
        }
    }
}

#[test]
fn numbers_that_are_no_scorer() {
    assert!(Scorer::read("1 2 3").is_none());
    assert!(Scorer::read("one").is_none());
    let text = include_str!("../../../assets/delineation/score_classical.txt");
    assert!(Scorer::read(text).is_some());
    assert!(Scorer::read(&format!("{text}\n1")).is_none());
}
