//! The leaves of the tree, measured, and the seams between them.
//!
//! Pixels are put in order of their leaves first (a counting sort), so that every leaf is measured on its own, on
//! all cores, and its seams are a short list to sort instead of a map of all. Sums are of whole and half numbers far
//! below 2^53: exact, in whatever order.

use glam::DVec2;
use rayon::prelude::*;

use super::watershed::{NOWHERE, around};
use super::{Node, Seam, Sums};
use crate::evidence::Evidence;
use crate::hull::hull;

/// Seams below this are weak, of 255.
const WEAK: u8 = 76;

/// A leaf, and its seams with leaves behind it.
type Measured = (Node, Vec<([u32; 2], Seam)>);

/// The leaves, and the seams between them in order of the leaves at their sides, the lesser first.
pub(super) fn leaves_and_seams(
    evidence: &Evidence,
    leaf_of: &[u32],
    leaves: usize,
) -> (Vec<Node>, Vec<([u32; 2], Seam)>) {
    let (pixels, starts) = by_leaf(leaf_of, leaves);
    let ends = starts.par_windows(2).enumerate();
    let measured: Vec<Measured> = ends
        .map(|(leaf, ends)| one(evidence, leaf_of, leaf as u32, &pixels[ends[0]..ends[1]]))
        .collect();
    let mut nodes = Vec::with_capacity(2 * leaves);
    let mut seams = Vec::with_capacity(measured.iter().map(|(_, seams)| seams.len()).sum());
    for (node, its) in measured {
        nodes.push(node);
        seams.extend(its);
    }
    (nodes, seams)
}

/// The pixels in order of their leaves, those of a leaf in order; and where each leaf's begin, and the last's end.
fn by_leaf(leaf_of: &[u32], leaves: usize) -> (Vec<u32>, Vec<usize>) {
    let mut starts = vec![0; leaves + 1];
    for leaf in leaf_of.iter().filter(|leaf| **leaf != NOWHERE) {
        starts[*leaf as usize + 1] += 1;
    }
    for leaf in 0..leaves {
        starts[leaf + 1] += starts[leaf];
    }
    let mut next = starts.clone();
    let mut pixels = vec![0; starts[leaves]];
    for (pixel, leaf) in (0..).zip(leaf_of) {
        if *leaf != NOWHERE {
            let place = &mut next[*leaf as usize];
            pixels[*place] = pixel;
            *place += 1;
        }
    }
    (pixels, starts)
}

/// A leaf, and its seams with leaves behind it.
fn one(evidence: &Evidence, leaf_of: &[u32], leaf: u32, pixels: &[u32]) -> Measured {
    let (width, height) = (evidence.width, evidence.height);
    let mut of = Sums::default();
    let mut corners: Vec<[f32; 2]> = Vec::new();
    let mut sides: Vec<(u32, u8)> = Vec::new();
    for pixel in pixels.iter().map(|pixel| *pixel as usize) {
        let (x, y) = (pixel % width, pixel / width);
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
        if let Some(votes) = &evidence.votes {
            of.votes.count(votes, pixel, place);
        }
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
                corners.extend([[x, y], [x, y + 1.0]]);
            }
        }
        for beside in around(width, height, pixel) {
            let other = leaf_of[beside];
            if other == leaf {
                continue;
            }
            let strength = evidence.border[pixel].max(evidence.border[beside]);
            of.outline += 1.0;
            of.strength += f64::from(if other == NOWHERE { 255 } else { strength });
            if other != NOWHERE && strength < WEAK {
                of.weak += 1.0;
            }
            if other != NOWHERE && leaf < other {
                sides.push((other, strength));
            }
        }
    }
    sides.sort_unstable();
    let seams = sides.chunk_by(|one, next| one.0 == next.0).map(|sides| {
        let strengths = sides.iter().map(|(_, strength)| *strength);
        let seam = Seam {
            sides: sides.len() as u32,
            strength: strengths.clone().map(u32::from).sum(),
            weak: strengths.filter(|strength| *strength < WEAK).count() as u32,
        };
        ([leaf, sides[0].0], seam)
    });
    let node = Node {
        children: None,
        parent: None,
        joined_at: 0.0,
        sums: of,
        hull: hull(&mut corners),
    };
    (node, seams.collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use fragscale_core::split_mix::SplitMix;

    use super::*;
    use crate::tree::watershed::basins;

    /// Seams as a walk over the pixels with a map has them, and the sums of a leaf in the order of the photo.
    #[test]
    fn as_from_pixel_to_pixel() {
        for seed in 0..6 {
            let mut random = SplitMix(seed);
            let (width, height) = (57, 41);
            let mut some = |most: u64| -> Vec<u8> {
                (0..width * height)
                    .map(|_| (random.next() % most) as u8)
                    .collect()
            };
            let evidence = Evidence {
                width,
                height,
                border: some(256),
                rock: some(256),
                middle: some(256),
                gray: some(256),
                votes: None,
            };
            let left_out: Vec<bool> = some(9).into_iter().map(|value| value == 0).collect();
            let (leaf_of, leaves) = basins(width, height, &some(12), &left_out);
            let mut sums = vec![Sums::default(); leaves];
            let mut seams: BTreeMap<[u32; 2], Seam> = BTreeMap::new();
            for (pixel, &leaf) in leaf_of.iter().enumerate() {
                if leaf == NOWHERE {
                    continue;
                }
                let of = &mut sums[leaf as usize];
                let place = DVec2::new((pixel % width) as f64, (pixel / width) as f64) + 0.5;
                of.area += 1.0;
                of.place += place;
                of.squares[1] += place.x * place.y;
                of.gray_squared += f64::from(evidence.gray[pixel]).powi(2);
                for beside in around(width, height, pixel) {
                    let other = leaf_of[beside];
                    let strength = evidence.border[pixel].max(evidence.border[beside]);
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
            let (nodes, found) = leaves_and_seams(&evidence, &leaf_of, leaves);
            assert_eq!(found, seams.into_iter().collect::<Vec<_>>());
            assert_eq!(nodes.len(), leaves);
            for (node, wanted) in nodes.iter().zip(sums) {
                let of = &node.sums;
                assert_eq!((of.area, of.place), (wanted.area, wanted.place));
                assert_eq!(of.squares[1].to_bits(), wanted.squares[1].to_bits());
                assert_eq!(of.gray_squared, wanted.gray_squared);
            }
        }
    }
}
