//! Which nodes a picture is made of: from the top, the coarsest first, as many as the budget allows. The
//! work grows with the nodes that are chosen and those right below them, not with the points.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::{LevelNode, Levels};

/// The nodes of a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chosen {
    /// Indices into [`Levels::nodes`], the most important first: each stands behind the one above it.
    pub nodes: Vec<usize>,
    /// How many points they have.
    pub points: usize,
    /// How many nodes were looked at.
    pub looked_at: usize,
    /// Whether nothing was left out for the budget.
    pub is_whole: bool,
}

/// A node that waits, with what the picture shows there without it.
struct Waiting {
    /// How far the points of the node above appear to be apart.
    without: f64,
    node: usize,
}

impl Ord for Waiting {
    /// The coarsest is the greatest; of equal ones that which stands first.
    fn cmp(&self, other: &Self) -> Ordering {
        (self.without.total_cmp(&other.without)).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl Levels {
    /// Chooses nodes with at most `most` points in all. `apart` says how far the points of a node appear to
    /// be apart, in any unit, `None` where it is out of sight; where that is at most `fine`, the nodes below
    /// would add nothing.
    pub fn choose(
        &self,
        most: usize,
        fine: f64,
        apart: impl Fn(&LevelNode) -> Option<f64>,
    ) -> Chosen {
        let mut chosen = Chosen {
            is_whole: true,
            ..Chosen::default()
        };
        let mut waiting = BinaryHeap::from([Waiting {
            without: f64::INFINITY,
            node: 0,
        }]);
        while let Some(Waiting { node: index, .. }) = waiting.pop() {
            let Some(node) = self.nodes.get(index) else {
                continue;
            };
            chosen.looked_at += 1;
            let Some(apart) = apart(node) else {
                continue;
            };
            if chosen.points + node.count > most {
                chosen.is_whole = false;
                break;
            }
            chosen.points += node.count;
            chosen.nodes.push(index);
            if apart > fine {
                let below = node.children.clone();
                waiting.extend(below.map(|node| Waiting {
                    without: apart,
                    node,
                }));
            }
        }
        chosen
    }
}
