//! The tree against what is counted anew from the pixels.

use fragscale_core::jobs::Progress;
use fragscale_core::split_mix::SplitMix;

use super::*;
use crate::evidence::Evidence;
use crate::votes::{VoteSums, Votes};

fn noise(width: usize, height: usize, seed: u64) -> Evidence {
    let mut random = SplitMix(seed);
    let mut some = || {
        (0..width * height)
            .map(|_| random.next() as u8)
            .collect::<Vec<u8>>()
    };
    Evidence {
        width,
        height,
        border: some(),
        rock: some(),
        middle: some(),
        gray: some(),
        votes: Some(Votes {
            size: some(),
            right: some(),
            down: some(),
        }),
    }
}

/// Of every node: its pixels, its outline and its strength, and that its hull holds it.
#[test]
fn sums_are_those_of_the_pixels() {
    let (width, height) = (40, 31);
    let (columns, rows) = (40isize, 31isize);
    let evidence = noise(width, height, 3);
    let mut left_out = vec![false; width * height];
    left_out[7 * width..7 * width + 12].fill(true);
    let tree = tree(&evidence, &left_out, &Progress::default()).unwrap();
    assert_eq!(tree.nodes.len(), 2 * tree.leaves - 1, "it hangs together");
    for (place, node) in tree.nodes.iter().enumerate() {
        // The leaves below it.
        let mut leaves = vec![false; tree.leaves];
        let mut open = vec![place as u32];
        while let Some(one) = open.pop() {
            match tree.nodes[one as usize].children {
                None => leaves[one as usize] = true,
                Some(children) => open.extend(children),
            }
        }
        let is_in = |x: isize, y: isize| {
            let on = (0..columns).contains(&x) && (0..rows).contains(&y);
            let leaf = on.then(|| tree.leaf_of[y as usize * width + x as usize]);
            leaf.is_some_and(|leaf| leaf != NOWHERE && leaves[leaf as usize])
        };
        let (mut area, mut outline, mut at_edge, mut strength, mut border) =
            (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut votes = VoteSums::default();
        for y in 0..rows {
            for x in 0..columns {
                if !is_in(x, y) {
                    continue;
                }
                area += 1.0;
                let own = evidence.border[y as usize * width + x as usize];
                border += f64::from(own);
                let middle = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let pixel = y as usize * width + x as usize;
                votes.count(evidence.votes.as_ref().unwrap(), pixel, middle);
                for (a, b) in [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)] {
                    if is_in(a, b) {
                        continue;
                    }
                    outline += 1.0;
                    if !(0..columns).contains(&a) || !(0..rows).contains(&b) {
                        at_edge += 1.0;
                        continue;
                    }
                    let other = b as usize * width + a as usize;
                    let theirs = if left_out[other] {
                        255
                    } else {
                        own.max(evidence.border[other])
                    };
                    strength += f64::from(theirs);
                }
            }
        }
        let sums = &node.sums;
        assert_eq!(
            (sums.area, sums.outline, sums.at_edge),
            (area, outline, at_edge)
        );
        assert_eq!((sums.strength, sums.border), (strength, border));
        assert_eq!(sums.votes, votes);
        assert!(crate::hull::area(&node.hull) >= area);
    }
}

/// Joined over weak seams first: two halves with a strong border between them are the last to be one.
#[test]
fn halves_are_joined_last() {
    let (width, height) = (30, 20);
    let mut evidence = noise(width, height, 9);
    for (place, border) in evidence.border.iter_mut().enumerate() {
        *border = if (14..16).contains(&(place % width)) {
            250
        } else {
            *border / 4
        };
    }
    evidence.middle.fill(0);
    let tree = tree(&evidence, &[], &Progress::default()).unwrap();
    let last = tree.nodes.last().unwrap();
    let halves = last
        .children
        .unwrap()
        .map(|child| tree.nodes[child as usize].sums.area);
    assert!(
        halves.iter().all(|area| (area - 300.0).abs() < 25.0),
        "{halves:?}"
    );
    assert!(last.joined_at > 200.0);
    let rest = &tree.nodes[..tree.nodes.len() - 1];
    assert!(rest.iter().all(|node| node.joined_at < 130.0));
}

/// The same photo gives the same tree.
#[test]
fn is_the_same_again() {
    let evidence = noise(50, 50, 4);
    let again = || tree(&evidence, &[], &Progress::default()).unwrap();
    assert_eq!(again(), again());
}
