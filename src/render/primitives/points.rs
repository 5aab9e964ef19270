//! The cloud's points (`shaders/points.wgsl`).

use wgpu::{
    BindGroupLayout, CompareFunction, Device, PrimitiveTopology, RenderPass, RenderPipeline,
    VertexStepMode, vertex_attr_array,
};

use super::frame;
use super::surface;
use super::tile::Tile;
use crate::device::gpu::Gpu;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{Recipe, module, pipeline};
use crate::renderer::part::Most;
use crate::scene::{CloudGeometry, CloudTile, Extent, Vertex};
use crate::streamed::{Looking, Present, StreamSource, Streamed};

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
    /// Of a cloud too large to be there whole: where the tiles come from.
    source: Option<StreamSource>,
    /// See [`CloudGeometry`].
    pub(crate) spacing: f64,
    /// See [`CloudGeometry`].
    pub(crate) elevation: [f64; 2],
}

impl CloudBuffers {
    /// Uploads a cloud.
    pub fn new(gpu: &Gpu, cloud: &CloudGeometry) -> Self {
        let upload = |tile: &CloudTile| Tile::new(gpu, &tile.points, tile.extent);
        let tiles = cloud.tiles.iter().map(upload).collect();
        gpu.hand_over();
        Self {
            tiles,
            source: None,
            spacing: cloud.spacing,
            elevation: cloud.elevation,
        }
    }

    /// Of a cloud that is streamed.
    pub(crate) fn streamed(source: StreamSource) -> Self {
        Self {
            tiles: Vec::new(),
            spacing: source.spacing,
            elevation: source.elevation,
            source: Some(source),
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
    /// What brings the cloud's tiles, where not all are there.
    streamed: Option<Streamed>,
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
            streamed: None,
        }
    }

    /// Takes another cloud, or none.
    pub(crate) fn set(&mut self, gpu: &Gpu, cloud: CloudBuffers) {
        let source = cloud.source.as_ref();
        self.streamed = source.map(|source| Streamed::new(gpu, source));
        self.cloud = cloud;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.cloud.tiles.is_empty() && self.streamed.is_none()
    }

    /// Whether the cloud is too large to be there whole; then it stands for the surface's triangles.
    pub(crate) fn is_streamed(&self) -> bool {
        self.streamed.is_some()
    }

    /// Has the tiles of a streamed cloud there that a picture of at most `most` points is made of, as far
    /// as they have come; see [`Streamed::present`].
    pub(crate) fn look(
        &mut self,
        looking: &Looking<'_>,
        most: Option<usize>,
        for_what: Most,
    ) -> Present {
        let Some(streamed) = &mut self.streamed else {
            return Present::default();
        };
        let mut present = streamed.present(looking, most.unwrap_or(usize::MAX), for_what);
        self.cloud.tiles = std::mem::take(&mut present.tiles);
        present
    }

    pub(crate) fn extent(&self) -> Option<Extent> {
        match &self.streamed {
            Some(streamed) => streamed.extent(),
            None => self.cloud.extent(),
        }
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
        if self.is_streamed() {
            // Chosen to be few enough.
            return 1.0;
        }
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
