//! The cloud's points (`shaders/points.wgsl`).

use wgpu::{
    BindGroupLayout, Buffer, BufferUsages, CompareFunction, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, VertexStepMode, vertex_attr_array,
};

use super::pipeline::{Recipe, buffer, count, module, pipeline};
use super::scene::{CloudGeometry, Extent, Vertex};
use super::shaders;

#[derive(Debug)]
pub(super) struct Points {
    pipeline: RenderPipeline,
    tiles: Vec<Tile>,
    pub(super) spacing: f64,
    pub(super) elevation: [f64; 2],
}

#[derive(Debug)]
struct Tile {
    points: Buffer,
    count: u32,
    extent: Extent,
}

impl Points {
    pub(super) fn new(device: &Device, groups: &[&BindGroupLayout]) -> Self {
        let buffers = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: VertexStepMode::Instance,
            attributes: &vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Snorm8x4],
        }];
        let pipeline = pipeline(
            device,
            &Recipe {
                module: &module(device, shaders::POINTS),
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
            tiles: Vec::new(),
            spacing: 0.0,
            elevation: [0.0; 2],
        }
    }

    pub(super) fn set(&mut self, device: &Device, cloud: Option<&CloudGeometry>) {
        self.tiles.clear();
        let Some(cloud) = cloud else { return };
        self.spacing = cloud.spacing;
        self.elevation = cloud.elevation;
        self.tiles.extend(cloud.tiles.iter().map(|tile| Tile {
            points: buffer(device, "points", BufferUsages::VERTEX, &tile.points),
            count: count(&tile.points),
            extent: tile.extent,
        }));
    }

    pub(super) fn extent(&self) -> Option<Extent> {
        self.tiles
            .iter()
            .map(|tile| tile.extent)
            .reduce(Extent::with)
    }

    /// Which share of the points in sight is drawn when at most `most` are.
    pub(super) fn share(&self, most: Option<usize>, in_sight: &impl Fn(&Extent) -> bool) -> f64 {
        let tiles = self.tiles.iter().filter(|tile| in_sight(&tile.extent));
        let all: u64 = tiles.map(|tile| u64::from(tile.count)).sum();
        match most {
            Some(most) if (most as u64) < all => most as f64 / all as f64,
            _ => 1.0,
        }
    }

    /// Draws this share of the points in sight, and says how many they were.
    pub(super) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        share: f64,
        in_sight: &impl Fn(&Extent) -> bool,
    ) -> usize {
        pass.set_pipeline(&self.pipeline);
        let mut drawn = 0;
        for tile in self.tiles.iter().filter(|tile| in_sight(&tile.extent)) {
            // `as` saturates.
            let count = (f64::from(tile.count) * share).floor() as u32;
            pass.set_vertex_buffer(0, tile.points.slice(..));
            pass.draw(0..4, 0..count);
            drawn += count as usize;
        }
        drawn
    }
}
