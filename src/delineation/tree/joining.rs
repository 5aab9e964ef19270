//! From basins to the tree.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use glam::DVec2;
use rustc_hash::FxHashMap;

use super::watershed::{NOWHERE, around, basins};
use super::{Node, Seam, Sums, Tree};
use crate::evidence::Evidence;
use crate::hull::hull;
use crate::smoothing::smoothed;

/// Seams below this are weak, of 255.
const WEAK: u8 = 76;

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
    let (mut nodes, seams) = small_regions(evidence, &leaf_of, leaves);
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

/// The leaves, and the seams between them.
fn small_regions(
    evidence: &Evidence,
    leaf_of: &[u32],
    leaves: usize,
) -> (Vec<Node>, Vec<([u32; 2], Seam)>) {
    let (width, height) = (evidence.width, evidence.height);
    let mut sums = vec![Sums::default(); leaves];
    let mut corners: Vec<Vec<[f32; 2]>> = vec![Vec::new(); leaves];
    let mut seams: FxHashMap<[u32; 2], Seam> = FxHashMap::default();
    for (pixel, &leaf) in leaf_of.iter().enumerate() {
        if leaf == NOWHERE {
            continue;
        }
        let (x, y) = (pixel % width, pixel / width);
        let of = &mut sums[leaf as usize];
        let place = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        of.area += 1.0;
        of.place += place;
        of.squares[0] += place.x * place.x;
        of.squares[1] += place.x * place.y;
        of.squares[2] += place.y * place.y;
        of.border += f64::from(evidence.border[pixel]);
        of.rock += f64::from(evidence.rock[pixel]);
        of.middle += f64::from(evidence.middle[pixel]);
        of.most_middle = of.most_middle.max(evidence.middle[pixel]);
        let gray = f64::from(evidence.gray[pixel]);
        of.gray += gray;
        of.gray_squared += gray * gray;
        let at_edge = [x == 0, y == 0, x + 1 == width, y + 1 == height];
        let at_edge = at_edge.into_iter().filter(|at| *at).count() as f64;
        of.at_edge += at_edge;
        of.outline += at_edge;
        // Ends of its rows are all that a hull needs.
        let left_differs = x == 0 || leaf_of[pixel - 1] != leaf;
        let right_differs = x + 1 == width || leaf_of[pixel + 1] != leaf;
        for (differs, x) in [(left_differs, x), (right_differs, x + 1)] {
            if differs {
                let (x, y) = (x as f32, y as f32);
                corners[leaf as usize].extend([[x, y], [x, y + 1.0]]);
            }
        }
        for beside in around(width, height, pixel) {
            let other = leaf_of[beside];
            if other == leaf {
                continue;
            }
            let strength = evidence.border[pixel].max(evidence.border[beside]);
            let of = &mut sums[leaf as usize];
            of.outline += 1.0;
            of.strength += f64::from(if other == NOWHERE { 255 } else { strength });
            if other != NOWHERE && strength < WEAK {
                of.weak += 1.0;
            }
            if other != NOWHERE && leaf < other {
                let seam = seams.entry([leaf, other]).or_default();
                *seam = seam.and(Seam {
                    sides: 1,
                    strength: u32::from(strength),
                    weak: u32::from(strength < WEAK),
                });
            }
        }
    }
    let nodes = sums.into_iter().zip(corners);
    let nodes = nodes.map(|(sums, mut corners)| Node {
        children: None,
        parent: None,
        joined_at: 0.0,
        sums,
        hull: hull(&mut corners),
    });
    let mut seams: Vec<_> = seams.into_iter().collect();
    // A map has no order of its own.
    seams.sort_unstable_by_key(|(between, _)| *between);
    (nodes.collect(), seams)
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
