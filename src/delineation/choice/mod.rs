//! Which nodes of the tree are fragments.
//!
//! Every node gets a score, the chance that it is one whole fragment, from what is measured of it
//! ([`features`]) by weights that were learned on simulated photos (`score.rs`). Of all sets of nodes that do
//! not overlap the one with the most in sum is found from the leaves up: a node is taken if its own score
//! beats the sum of the best below it.

pub mod features;
mod score;

pub use score::{Scorer, scores};

use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::tree::{NOWHERE, Tree};

/// The nodes that are fragments: no two overlap, and the sum of what their scores exceed `least` by is the
/// most there is.
pub fn chosen(tree: &Tree, scores: &[f64], least: f64) -> Vec<u32> {
    let mut best = vec![0.0; tree.nodes.len()];
    let mut takes = vec![false; tree.nodes.len()];
    // Children stand before their parents.
    for (place, node) in tree.nodes.iter().enumerate() {
        let below = node
            .children
            .map_or(0.0, |[a, b]| best[a as usize] + best[b as usize]);
        let own = scores.get(place).copied().unwrap_or_default() - least;
        takes[place] = own > 0.0 && own >= below;
        best[place] = if takes[place] { own } else { below };
    }
    let mut taken = Vec::new();
    let roots =
        (0..tree.nodes.len() as u32).filter(|node| tree.nodes[*node as usize].parent.is_none());
    let mut open: Vec<u32> = roots.collect();
    while let Some(node) = open.pop() {
        if takes[node as usize] {
            taken.push(node);
        } else if let Some(children) = tree.nodes[node as usize].children {
            open.extend(children);
        }
    }
    taken.sort_unstable();
    taken
}

/// The label image of chosen nodes: fragments in the order of their nodes, all else fines.
pub fn labelled(tree: &Tree, taken: &[u32]) -> LabelImage {
    let mut number = vec![FINES; tree.nodes.len()];
    for (fragment, node) in (1..).zip(taken) {
        number[*node as usize] = fragment;
    }
    // Parents stand behind their children: from the last to the first every node knows its parent's number.
    for place in (0..tree.nodes.len()).rev() {
        if let Some(parent) = tree.nodes[place].parent
            && number[place] == FINES
        {
            number[place] = number[parent as usize];
        }
    }
    let label = |leaf: &u32| match *leaf {
        NOWHERE => NOT_ROCK,
        leaf => number[leaf as usize],
    };
    LabelImage {
        width: tree.width,
        height: tree.height,
        labels: tree.leaf_of.iter().map(label).collect(),
    }
}

#[cfg(test)]
mod tests;
