//! From basins to the tree.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use rustc_hash::FxHashMap;

use super::leaves::leaves_and_seams;
use super::watershed::basins;
use super::{Node, Seam, Tree};
use crate::evidence::Evidence;
use crate::hull::hull;
use crate::smoothing::smoothed;

/// The tree of regions of what an engine sees. `left_out` pixels belong to no region; it may be empty for
/// none.
///
/// # Errors
/// On cancel.
pub fn tree(evidence: &Evidence, left_out: &[bool], progress: &Progress) -> Result<Tree, Fault> {
    let (width, height) = (evidence.width, evidence.height);
    let none;
    let left_out = if left_out.is_empty() {
        none = vec![false; width * height];
        &none
    } else {
        left_out
    };
    let relief = relief(evidence);
    progress.advance(1, 4)?;
    let (leaf_of, leaves) = basins(width, height, &relief, left_out);
    progress.advance(2, 4)?;
    let (mut nodes, seams) = leaves_and_seams(evidence, &leaf_of, leaves);
    progress.advance(3, 4)?;
    join(&mut nodes, seams);
    Ok(Tree {
        width,
        height,
        leaf_of,
        leaves,
        nodes,
    })
}

/// What the water floods: borders are ridges. A little smoothed, so that a gap in a border is bridged, and
/// higher far from middles, where the engine knows them.
fn relief(evidence: &Evidence) -> Vec<u8> {
    let (width, height) = (evidence.width, evidence.height);
    let border = smoothed(&evidence.border, width, height, 1);
    if evidence.middle.iter().all(|middle| *middle == 0) {
        return border;
    }
    let middle = smoothed(&evidence.middle, width, height, 1);
    let both = border.iter().zip(&middle);
    both.map(|(border, middle)| ((u16::from(*border) + u16::from(255 - middle)) / 2) as u8)
        .collect()
}

/// Joins regions over the weakest seam until none is left.
fn join(nodes: &mut Vec<Node>, seams: Vec<([u32; 2], Seam)>) {
    // A region keeps its slot when it takes over a smaller one; so only the smaller one's seams move.
    let mut node_in: Vec<u32> = (0..nodes.len() as u32).collect();
    let mut beside: Vec<FxHashMap<u32, Seam>> = vec![FxHashMap::default(); nodes.len()];
    let mut weakest = BinaryHeap::with_capacity(seams.len());
    // Positive floats have the order of their bits. Of equal seams the first regions go first.
    let entry = |a: u32, b: u32, seam: Seam| {
        Reverse((seam.mean().to_bits(), a.min(b), a.max(b), seam.sides))
    };
    for ([a, b], seam) in seams {
        beside[a as usize].insert(b, seam);
        beside[b as usize].insert(a, seam);
        weakest.push(entry(a, b, seam));
    }
    while let Some(Reverse((strength, a, b, sides))) = weakest.pop() {
        // An empty slot has no seams any more; a seam that grew has a later entry.
        let Some(seam) = beside[a as usize].get(&b).copied() else {
            continue;
        };
        if seam.sides != sides || seam.mean().to_bits() != strength {
            continue;
        }
        let joined = nodes.len() as u32;
        let children = [a, b].map(|slot| node_in[slot as usize]);
        let [one, other] = children.map(|node| &nodes[node as usize]);
        let mut corners = one.hull.clone();
        corners.extend(&other.hull);
        let node = Node {
            children: Some(children),
            parent: None,
            joined_at: f32::from_bits(strength),
            sums: one.sums.and(&other.sums, seam),
            hull: hull(&mut corners),
        };
        nodes.push(node);
        for child in children {
            nodes[child as usize].parent = Some(joined);
        }
        let [large, small] = if beside[a as usize].len() < beside[b as usize].len() {
            [b, a]
        } else {
            [a, b]
        };
        node_in[large as usize] = joined;
        beside[large as usize].remove(&small);
        let mut moved: Vec<(u32, Seam)> = std::mem::take(&mut beside[small as usize])
            .into_iter()
            .filter(|(other, _)| *other != large)
            .collect();
        moved.sort_unstable_by_key(|(other, _)| *other);
        for (other, seam) in moved {
            beside[other as usize].remove(&small);
            let sum = beside[large as usize].entry(other).or_default();
            *sum = sum.and(seam);
            let sum = *sum;
            beside[other as usize].insert(large, sum);
            weakest.push(entry(large, other, sum));
        }
    }
}
