//! The vertices of a surface: all of them, those in some part of the world, their colours, and the boxes around them.

mod blocks;
mod bulk;

use std::ops::Range;

use glam::DVec3;

pub use blocks::VertexBlock;
pub use bulk::bulk_of;

use super::{Shape, Surface, part};
use crate::geometry::Bounds;

impl Surface {
    /// The vertices in the world: of a cloud one for each (x, y), of a mesh all of the file. Those
    /// that only long triangles use are among them.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = DVec3> {
        self.want_all("a look at all of its points");
        self.vertices_here()
    }

    /// The same of what is in memory.
    fn vertices_here(&self) -> impl ExactSizeIterator<Item = DVec3> {
        let frame = &self.whole.frame;
        self.points().iter().map(|&p| frame.world_from_local(p))
    }

    /// Says that all of a cloud is needed of which a part is in memory, and for what.
    fn want_all(&self, why: &'static str) {
        if let Shape::Cloud(sites) = &self.whole.shape {
            sites.want_all(why);
        }
    }

    /// Some of [`Self::vertices`], by their indices; none where there are no such indices.
    pub fn vertices_in(&self, range: Range<usize>) -> impl Iterator<Item = DVec3> {
        let frame = &self.whole.frame;
        let points = self.points().get(range).unwrap_or_default();
        points.iter().map(|&p| frame.world_from_local(p))
    }

    /// All vertices in blocks of neighbours. The first call makes them.
    pub(super) fn vertex_blocks(&self) -> &[VertexBlock] {
        let blocks = &self.whole.blocks;
        blocks.get_or_init(|| blocks::blocks(self.vertices_here()))
    }

    /// The vertices that lie in boxes (world) which `misses` does not miss: boxes only shrink the answer. Their
    /// order says nothing. The first call makes the blocks.
    pub fn vertices_seen(&self, misses: impl Fn(&Bounds) -> bool) -> impl Iterator<Item = DVec3> {
        if let Shape::Cloud(sites) = &self.whole.shape
            && sites.is_part()
        {
            part::want_seen(sites, &self.whole.frame, &misses);
        }
        let blocks = self.vertex_blocks().iter();
        let seen = blocks.filter(move |block| !misses(&block.bounds));
        seen.flat_map(|block| self.vertices_in(block.range.clone()))
    }

    /// The heights (world) below and above which the lowest and the highest hundredth of it lie, by a sample of some
    /// thousand points from all over it: beyond them is most often noise. `None` without points.
    pub fn usual_heights(&self) -> Option<[f64; 2]> {
        let mut heights = self.whole.heights.clone();
        heights.sort_by(f64::total_cmp);
        let hundredth = heights.len() / 100;
        let high = heights.len().checked_sub(hundredth + 1)?;
        Some([*heights.get(hundredth)?, *heights.get(high)?])
    }

    /// The box around all points of it, in the world.
    pub fn bounds(&self) -> Bounds {
        if let Shape::Cloud(sites) = &self.whole.shape {
            let (frame, bounds) = (&self.whole.frame, sites.bounds());
            return Bounds {
                min: frame.world_from_local(bounds.min),
                max: frame.world_from_local(bounds.max),
            };
        }
        // A surface has vertices, so the box that nothing is in does not stay.
        let nothing = Bounds {
            min: DVec3::INFINITY,
            max: DVec3::NEG_INFINITY,
        };
        let blocks = self.vertex_blocks().iter();
        blocks.fold(nothing, |all, block| Bounds {
            min: all.min.min(block.bounds.min),
            max: all.max.max(block.bounds.max),
        })
    }

    /// The box around its bulk: [`Self::bounds`] without the few vertices far away that sparse clouds
    /// have. Without such it is [`Self::bounds`].
    pub fn bulk_bounds(&self) -> Bounds {
        self.want_all("finding out where its bulk lies");
        bulk::bulk(self.vertices_here(), self.bounds())
    }

    /// The colour of each vertex (red, green, blue), in the order of [`Self::vertices`]; empty where
    /// the file has none.
    pub fn colors(&self) -> &[[u8; 3]] {
        match &self.whole.shape {
            Shape::Cloud(sites) => sites.colors(),
            Shape::Mesh(mesh) => mesh.colors(),
        }
    }
}
