//! The triangles of a patch in blocks of neighbours, each with a box around it: of tens of thousands of
//! triangles the rays of a coarse grid meet a few, and most blocks none.

use std::ops::Range;

use glam::{DVec2, DVec3};

use crate::geometry::Bounds;

/// Triangles in one block, about: a look at its box costs as much as one at a few of them.
const TRIANGLES: usize = 64;

/// A run of a patch's triangles.
#[derive(Debug, Clone)]
pub(super) struct TriangleBlock {
    pub(super) triangles: Range<usize>,
    /// Around them.
    pub(super) bounds: Bounds,
}

/// Sorts triangles into blocks by the squares that their first corners lie in.
pub(super) fn sort_into_blocks(triangles: &mut [[u32; 3]], points: &[DVec3]) -> Vec<TriangleBlock> {
    let first = |triangle: &[u32; 3]| points[triangle[0] as usize].truncate();
    let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for place in triangles.iter().map(first) {
        (min, max) = (min.min(place), max.max(place));
    }
    let squares = (triangles.len() as f64 / TRIANGLES as f64).sqrt().ceil();
    let density = DVec2::splat(squares) / (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
    let square = |triangle: &[u32; 3]| {
        // `as` saturates. What lies at the far side is a row of its own.
        let at = (first(triangle) - min) * density;
        [at.y as u32, at.x as u32]
    };
    triangles.sort_by_cached_key(square);
    let mut blocks = Vec::with_capacity(triangles.len() / TRIANGLES + 1);
    let mut from = 0;
    for run in triangles.chunk_by(|a, b| square(a) == square(b)) {
        let to = from + run.len();
        blocks.extend(block(from..to, run, points));
        from = to;
    }
    blocks
}

/// Blocks of triangles as they stand.
pub(super) fn blocks_of(triangles: &[[u32; 3]], points: &[DVec3]) -> Vec<TriangleBlock> {
    let runs = triangles.chunks(TRIANGLES).enumerate();
    runs.filter_map(|(number, run)| {
        let from = number * TRIANGLES;
        block(from..from + run.len(), run, points)
    })
    .collect()
}

fn block(triangles: Range<usize>, run: &[[u32; 3]], points: &[DVec3]) -> Option<TriangleBlock> {
    let corners = run.iter().flatten().map(|&index| points[index as usize]);
    let (min, max) = corners.fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(min, max), corner| (min.min(corner), max.max(corner)),
    );
    let bounds = Bounds { min, max };
    (!run.is_empty()).then_some(TriangleBlock { triangles, bounds })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every triangle is in one block, whose box holds its corners; of a lattice the boxes are small.
    #[test]
    fn every_triangle_is_in_a_block() {
        let points: Vec<DVec3> = (0..60 * 60)
            .map(|i| DVec3::new(f64::from(i % 60), f64::from(i / 60), f64::from(i % 7)))
            .collect();
        let square = |at: u32| [[at, at + 1, at + 61], [at, at + 61, at + 60]];
        let at = (0..59 * 60).filter(|at| at % 60 < 59);
        let mut triangles: Vec<[u32; 3]> = at.rev().flat_map(square).collect();
        let mut all = triangles.clone();
        let as_they_stand = blocks_of(&triangles, &points);
        assert_eq!(as_they_stand.len(), triangles.len().div_ceil(TRIANGLES));
        let sorted = sort_into_blocks(&mut triangles, &points);
        for blocks in [as_they_stand, sorted.clone()] {
            let mut next = 0;
            for block in &blocks {
                assert_eq!(block.triangles.start, next);
                next = block.triangles.end;
            }
            assert_eq!(next, triangles.len());
        }
        for block in sorted {
            for triangle in &triangles[block.triangles.clone()] {
                for corner in triangle.map(|index| points[index as usize]) {
                    assert!(block.bounds.min.cmple(corner).all());
                    assert!(block.bounds.max.cmpge(corner).all());
                }
            }
            // 64 triangles are 32 squares.
            assert!(block.bounds.size().truncate().max_element() <= 8.0);
        }
        all.sort_unstable();
        triangles.sort_unstable();
        assert_eq!(all, triangles);
    }
}
