//! All regions that may be a fragment, as a tree: small ones joined, the weakest seam first.
//!
//! The small ones are those of a watershed (`watershed.rs`). What lies between two of them is a seam; its
//! strength is the mean of the borders along it. Joining the two regions of the weakest seam, again and
//! again, makes a binary tree (a "binary partition tree": Salembier & Garrido 2000): its leaves are the
//! small regions, every other node is the two that were joined. Measures of a node add up from its
//! children's, so a tree of half a million nodes takes a second.

mod joining;
mod leaves;
mod watershed;

use glam::DVec2;

pub use joining::tree;
pub(crate) use watershed::{NOWHERE, around};

use crate::votes::VoteSums;

/// A tree of regions. Children stand before their parents, leaves first.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The leaf of each pixel; [`u32::MAX`] for pixels that belong to none.
    pub leaf_of: Vec<u32>,
    /// How many of the nodes are leaves.
    pub leaves: usize,
    /// All nodes.
    pub nodes: Vec<Node>,
}

/// A region of the photo.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The two that were joined; of a leaf none.
    pub children: Option<[u32; 2]>,
    /// What it is joined into; of a root none.
    pub parent: Option<u32>,
    /// How strong the seam was between its two children, 0 to 255; of a leaf 0.
    pub joined_at: f32,
    /// What adds up.
    pub sums: Sums,
    /// The corners of its convex hull, pixels.
    pub hull: Vec<[f32; 2]>,
}

/// What of two regions adds up when they are joined.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    /// Pixels.
    pub area: f64,
    /// Of their places.
    pub place: DVec2,
    /// Of x x, x y and y y.
    pub squares: [f64; 3],
    /// Of the evidence's borders, 0 to 255 each.
    pub border: f64,
    /// Of its rock.
    pub rock: f64,
    /// Of its middles.
    pub middle: f64,
    /// Of the grays.
    pub gray: f64,
    /// Of their squares.
    pub gray_squared: f64,
    /// The most of the middle, 0 to 255.
    pub most_middle: u8,
    /// The pixel sides of its outline.
    pub outline: f64,
    /// Those of them at the photo's edge.
    pub at_edge: f64,
    /// The strengths of the others, 0 to 255 each.
    pub strength: f64,
    /// How many of the others are weak.
    pub weak: f64,
    /// What its pixels vote for.
    pub votes: VoteSums,
}

impl Sums {
    /// Both together, where `shared` is the seam between them.
    fn and(&self, other: &Self, shared: Seam) -> Self {
        let mut sums = *self;
        sums.area += other.area;
        sums.place += other.place;
        for (sum, more) in sums.squares.iter_mut().zip(other.squares) {
            *sum += more;
        }
        sums.border += other.border;
        sums.rock += other.rock;
        sums.middle += other.middle;
        sums.gray += other.gray;
        sums.gray_squared += other.gray_squared;
        sums.most_middle = self.most_middle.max(other.most_middle);
        sums.at_edge += other.at_edge;
        // The shared seam was counted from both sides.
        sums.outline += other.outline - 2.0 * f64::from(shared.sides);
        sums.strength += other.strength - 2.0 * f64::from(shared.strength);
        sums.weak += other.weak - 2.0 * f64::from(shared.weak);
        sums.votes = self.votes.and(&other.votes);
        sums
    }
}

/// What lies between two regions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Seam {
    /// Pixel sides.
    sides: u32,
    /// The sum of their strengths, each 0 to 255.
    strength: u32,
    /// How many of them are weak.
    weak: u32,
}

impl Seam {
    fn and(self, other: Self) -> Self {
        Self {
            sides: self.sides + other.sides,
            strength: self.strength + other.strength,
            weak: self.weak + other.weak,
        }
    }

    fn mean(self) -> f32 {
        self.strength as f32 / self.sides.max(1) as f32
    }
}

#[cfg(test)]
mod tests;
