//! Blocks of neighbouring vertices with a box around each, so that whoever asks for the vertices in
//! some part of the world need not look at all of them.

use std::ops::Range;

use glam::DVec3;

use crate::geometry::Bounds;

/// How many vertices a block has. Of a cloud they are a strip of one row of its grid: more of them
/// would make the strips longer than a photo is wide.
const VERTICES_PER_BLOCK: usize = 256;

/// Vertices that follow each other, and the box around them.
#[derive(Debug, Clone, PartialEq)]
pub struct VertexBlock {
    /// In the world.
    pub bounds: Bounds,
    /// Indices into the order of [`Surface::vertices`](crate::surface::Surface::vertices).
    pub range: Range<usize>,
}

/// The blocks of these vertices (world), all of them in their order.
pub(super) fn blocks(vertices: impl ExactSizeIterator<Item = DVec3>) -> Vec<VertexBlock> {
    let mut blocks: Vec<VertexBlock> = Vec::with_capacity(vertices.len() / VERTICES_PER_BLOCK + 1);
    for (index, vertex) in vertices.enumerate() {
        match blocks.last_mut() {
            Some(block) if block.range.len() < VERTICES_PER_BLOCK => {
                block.bounds.min = block.bounds.min.min(vertex);
                block.bounds.max = block.bounds.max.max(vertex);
                block.range.end = index + 1;
            }
            _ => blocks.push(VertexBlock {
                bounds: Bounds {
                    min: vertex,
                    max: vertex,
                },
                range: index..index + 1,
            }),
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_is_in_one_block_and_in_its_box() {
        let vertices: Vec<DVec3> = (0..1000)
            .map(|i| {
                let i = f64::from(i);
                DVec3::new((i * 0.7).sin(), (i * 0.3).cos(), i)
            })
            .collect();
        let blocks = blocks(vertices.iter().copied());
        let mut next = 0;
        for block in &blocks {
            assert_eq!(block.range.start, next);
            next = block.range.end;
            assert_eq!(
                Some(block.bounds),
                Bounds::of(&vertices[block.range.clone()])
            );
        }
        assert_eq!((next, blocks.len()), (1000, 4));
    }
}
