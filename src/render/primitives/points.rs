//! The cloud's points (`shaders/points.wgsl`).

use wgpu::{
    BindGroupLayout, Buffer, BufferUsages, CompareFunction, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, VertexStepMode, vertex_attr_array,
};

use super::frame;
use super::surface;
use crate::device::gpu::Gpu;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{Recipe, buffer, count, module, pipeline};
use crate::scene::{CloudGeometry, CloudTile, Extent, Vertex};

pub(crate) const SHADER: Shader = (
    "points",
    &[
        frame::WGSL,
        surface::WGSL,
        include_str!("../../../shaders/points.wgsl"),
    ],
);

/// A cloud on the graphics card. Uploading can be done on a worker thread; clones share the buffers.
#[derive(Debug, Clone, Default)]
pub struct CloudBuffers {
    tiles: Vec<Tile>,
    /// See [`CloudGeometry`].
    pub(crate) spacing: f64,
    /// See [`CloudGeometry`].
    pub(crate) elevation: [f64; 2],
}

impl CloudBuffers {
    /// Uploads a cloud.
    pub fn new(gpu: &Gpu, cloud: &CloudGeometry) -> Self {
        let upload = |tile: &CloudTile| Tile {
            points: buffer(&gpu.device, "points", BufferUsages::VERTEX, &tile.points),
            count: count(&tile.points),
            extent: tile.extent,
        };
        let tiles = cloud.tiles.iter().map(upload).collect();
        gpu.hand_over();
        Self {
            tiles,
            spacing: cloud.spacing,
            elevation: cloud.elevation,
        }
    }
}

impl CloudBuffers {
    /// Around all of it.
    pub(crate) fn extent(&self) -> Option<Extent> {
        let extents = self.tiles.iter().map(|tile| tile.extent);
        extents.reduce(Extent::with)
    }
}

#[derive(Debug)]
pub(crate) struct Points {
    pipeline: RenderPipeline,
    pub(crate) cloud: CloudBuffers,
}

#[derive(Debug, Clone)]
struct Tile {
    points: Buffer,
    count: u32,
    extent: Extent,
}

impl Points {
    pub(crate) fn new(device: &Device, groups: &[&BindGroupLayout]) -> Self {
        let buffers = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: VertexStepMode::Instance,
            attributes: &vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Snorm8x4],
        }];
        let pipeline = pipeline(
            device,
            &Recipe {
                module: &module(device, SHADER),
                vertex: "vertex",
                fragment: Some("fragment"),
                groups,
                buffers: &buffers,
                topology: PrimitiveTopology::TriangleStrip,
                cull: None,
                depth: Some((CompareFunction::GreaterEqual, true)),
                translucent: false,
                constants: &[],
            },
        );
        Self {
            pipeline,
            cloud: CloudBuffers::default(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.cloud.tiles.is_empty()
    }

    pub(crate) fn extent(&self) -> Option<Extent> {
        self.cloud.extent()
    }

    /// Draws another cloud than its own: what is in sight of it, about `most` points of all.
    pub(crate) fn draw_cloud(
        &self,
        cloud: &CloudBuffers,
        pass: &mut RenderPass<'_>,
        most: Option<usize>,
        in_sight: &impl Fn(&Extent) -> bool,
    ) {
        let all: u64 = cloud.tiles.iter().map(|tile| u64::from(tile.count)).sum();
        let share = most.map_or(1.0, |most| (most as f64 / all.max(1) as f64).min(1.0));
        pass.set_pipeline(&self.pipeline);
        for tile in cloud.tiles.iter().filter(|tile| in_sight(&tile.extent)) {
            // `as` saturates.
            let count = (f64::from(tile.count) * share).ceil() as u32;
            pass.set_vertex_buffer(0, tile.points.slice(..));
            pass.draw(0..4, 0..count);
        }
    }

    /// Which share of the points in sight is drawn when at most `most` are.
    pub(crate) fn share(&self, most: Option<usize>, in_sight: &impl Fn(&Extent) -> bool) -> f64 {
        let tiles = self
            .cloud
            .tiles
            .iter()
            .filter(|tile| in_sight(&tile.extent));
        let all: u64 = tiles.map(|tile| u64::from(tile.count)).sum();
        match most {
            Some(most) if (most as u64) < all => most as f64 / all as f64,
            _ => 1.0,
        }
    }

    /// Draws this share of the points in sight from the tile `from` on, about `most` of them. Says
    /// how many they were, and the tile to go on with where some are left.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        share: f64,
        from: usize,
        most: usize,
        in_sight: &impl Fn(&Extent) -> bool,
    ) -> (usize, Option<usize>) {
        pass.set_pipeline(&self.pipeline);
        let mut drawn = 0;
        for (place, tile) in self.cloud.tiles.iter().enumerate().skip(from) {
            if !in_sight(&tile.extent) {
                continue;
            }
            if drawn >= most {
                return (drawn, Some(place));
            }
            // `as` saturates.
            let count = (f64::from(tile.count) * share).floor() as u32;
            pass.set_vertex_buffer(0, tile.points.slice(..));
            pass.draw(0..4, 0..count);
            drawn += count as usize;
        }
        (drawn, None)
    }
}
