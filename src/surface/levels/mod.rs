//! Levels of detail of a cloud, for whoever shows it: a tree of nodes, each with a share of the points.
//!
//! The tree is additive, as that of COPC: a node's points lie among those of the nodes above it, and the
//! node with all below it holds every vertex in its part of the world, each in exactly one node. So a
//! picture is made of some nodes from the top, finer where it looks closer, and no point is held twice.
//!
//! A cloud is a surface over (x, y), and its sites are sorted into a grid already. So the tree needs no
//! sorting of its own: a node is a block of the grid's cells with the box around its sites, halved along
//! both axes until [`LEAF`] sites are left. An inner node takes one site from each of
//! [`GROUPS`] x [`GROUPS`] groups of cells in which none above it has one, near the group's middle; a leaf
//! has the rest. What is held beside the sites: four bytes for each site of an inner node (about every
//! eighth), and a bit for each site. 100 million points need 80 MB and about two seconds on one core
//! (`cargo bench --bench pipeline levels`).

mod choice;
mod part;

use std::collections::VecDeque;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

pub use choice::Chosen;
use part::{Part, Picked};

use super::sites::Sites;
use super::{Shape, Surface};
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::jobs::Progress;

/// Most sites of a leaf: half a megabyte for the graphics card.
const LEAF: usize = 1 << 15;

/// Groups of cells along an inner node's sides: it has at most the square of it, half a leaf.
const GROUPS: usize = 128;

/// A node of [`Levels`].
#[derive(Debug, Clone, PartialEq)]
pub struct LevelNode {
    /// Around its points and those of the nodes below it, in the world.
    pub bounds: Bounds,
    /// About how far its points are apart over (x, y), those of nodes above it among them; world units.
    pub spacing: f64,
    /// How many points are its own.
    pub count: usize,
    /// The nodes below it: indices into [`Levels::nodes`], all larger than its own.
    pub children: Range<usize>,
    own: Own,
}

/// Which sites are a node's own.
#[derive(Debug, Clone, PartialEq)]
enum Own {
    /// Those in this range of [`Levels::picked`].
    Picked(Range<usize>),
    /// Those of the part that no node above has.
    Rest(Part),
}

/// The levels of detail of a cloud.
#[derive(Debug, Clone)]
pub struct Levels {
    surface: Surface,
    /// From the top: the root first, parents before their children.
    nodes: Vec<LevelNode>,
    /// The sites of inner nodes, node by node.
    picked: Vec<u32>,
    /// Which sites these are.
    is_picked: Picked,
}

impl Levels {
    /// Of a cloud; `None` of a mesh, which is shown by its faces.
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn new(surface: &Surface, progress: &Progress) -> Result<Option<Self>, Fault> {
        let Shape::Cloud(sites) = &surface.whole.shape else {
            return Ok(None);
        };
        let mut is_picked = Picked::none(sites.points().len());
        let mut picked: Vec<u32> = Vec::new();
        let mut nodes: Vec<LevelNode> = Vec::new();
        let mut waiting: VecDeque<Part> = VecDeque::from([Part::whole(sites)]);
        // Of each node: its part, to find the box around it.
        let mut parts: Vec<Part> = Vec::new();
        let mut in_leaves = 0;
        while let Some(part) = waiting.pop_front() {
            progress.advance(in_leaves as u64, sites.points().len() as u64)?;
            let below = match part.len(sites) > LEAF {
                true => part.split(sites),
                false => Vec::new(),
            };
            // Parents before children, in the order in which they wait.
            let first = nodes.len() + 1 + waiting.len();
            let (own, count) = if below.is_empty() {
                in_leaves += part.len(sites);
                let count = part.len(sites) - is_picked.count(part.ranges(sites));
                (Own::Rest(part.clone()), count)
            } else {
                let from = picked.len();
                part.pick(sites, &mut is_picked, &mut picked);
                (Own::Picked(from..picked.len()), picked.len() - from)
            };
            nodes.push(LevelNode {
                bounds: *sites.bounds(),
                spacing: 0.0,
                count,
                children: first..first + below.len(),
                own,
            });
            waiting.extend(below);
            parts.push(part);
        }
        find_boxes(surface, sites, &mut nodes, &parts);
        for (node, part) in nodes.iter_mut().zip(&parts) {
            let size = node.bounds.size();
            let points = match node.own {
                Own::Picked(_) => part.groups(sites),
                Own::Rest(_) => part.len(sites),
            };
            node.spacing = (size.x * size.y / points.max(1) as f64).sqrt();
        }
        Ok(Some(Self {
            surface: surface.clone(),
            nodes,
            picked,
            is_picked,
        }))
    }

    /// All nodes, the root first.
    pub fn nodes(&self) -> &[LevelNode] {
        &self.nodes
    }

    /// The cloud that they are of.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The points of a node's own, in the world, each with its index in [`Surface::vertices`].
    pub fn points_of(&self, node: &LevelNode) -> Vec<(usize, DVec3)> {
        let Shape::Cloud(sites) = &self.surface.whole.shape else {
            return Vec::new();
        };
        let frame = self.surface.frame();
        let place = |site: usize| (site, frame.world_from_local(sites.points()[site]));
        match &node.own {
            Own::Picked(range) => {
                let picked = self.picked[range.clone()].iter();
                picked.map(|&site| place(site as usize)).collect()
            }
            Own::Rest(part) => {
                let mut points = Vec::with_capacity(node.count);
                let all = part.ranges(sites).flatten();
                points.extend(all.filter(|&site| !self.is_picked.has(site)).map(place));
                points
            }
        }
    }

    /// About how far neighbouring points are apart where nothing is left out, world units.
    pub fn spacing(&self) -> f64 {
        let leaves = self.nodes.iter().filter(|node| node.children.is_empty());
        let mut spacings: Vec<f64> = leaves.map(|node| node.spacing).collect();
        crate::geometry::median(&mut spacings).unwrap_or_default()
    }
}

/// The box around each node, those of leaves from their sites, on all cores.
fn find_boxes(surface: &Surface, sites: &Sites, nodes: &mut [LevelNode], parts: &[Part]) {
    let frame = surface.frame();
    let nothing = Bounds {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };
    let around = |a: Bounds, b: Bounds| Bounds {
        min: a.min.min(b.min),
        max: a.max.max(b.max),
    };
    nodes.par_iter_mut().zip(parts).for_each(|(node, part)| {
        if node.children.is_empty() {
            let points = part.ranges(sites).flat_map(|range| &sites.points()[range]);
            let local = points.fold(nothing, |bounds, &point| Bounds {
                min: bounds.min.min(point),
                max: bounds.max.max(point),
            });
            node.bounds = Bounds {
                min: frame.world_from_local(local.min),
                max: frame.world_from_local(local.max),
            };
        }
    });
    for index in (0..nodes.len()).rev() {
        let below = nodes[index].children.clone();
        if !below.is_empty() {
            // They stand behind it, so theirs are found.
            nodes[index].bounds = nodes[below]
                .iter()
                .fold(nothing, |bounds, child| around(bounds, child.bounds));
        }
    }
}

#[cfg(test)]
mod tests;
