//! A piece of a cloud on the graphics card.

use wgpu::{Buffer, BufferUsages};

use crate::device::gpu::Gpu;
use crate::device::pipeline::{buffer, count};
use crate::scene::{Extent, Vertex};

/// Points near each other on the graphics card; clones share them.
#[derive(Debug, Clone)]
pub(crate) struct Tile {
    pub(crate) points: Buffer,
    pub(crate) count: u32,
    pub(crate) extent: Extent,
}

impl Tile {
    pub(crate) fn new(gpu: &Gpu, points: &[Vertex], extent: Extent) -> Self {
        Self {
            points: buffer(&gpu.device, "points", BufferUsages::VERTEX, points),
            count: count(points),
            extent,
        }
    }

    /// How much memory it takes.
    pub(crate) fn bytes(&self) -> u64 {
        self.points.size()
    }
}
