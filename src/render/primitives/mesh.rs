//! The surface's triangles and their edges (`shaders/mesh.wgsl`).

use wgpu::{
    BindGroupLayout, Buffer, BufferUsages, CompareFunction, Device, IndexFormat, PrimitiveTopology,
    RenderPass, RenderPipeline, VertexStepMode, vertex_attr_array,
};

use super::frame;
use super::surface;
use crate::device::gpu::Gpu;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{Recipe, buffer, count, module, pipeline};
use crate::scene::{Extent, MeshGeometry, MeshTile, Vertex};

pub(crate) const SHADER: Shader = (
    "mesh",
    &[
        frame::WGSL,
        surface::WGSL,
        include_str!("../../../shaders/mesh.wgsl"),
    ],
);

/// A mesh on the graphics card. Uploading can be done on a worker thread; clones share the buffers.
#[derive(Debug, Clone, Default)]
pub struct MeshBuffers {
    tiles: Vec<Tile>,
    /// See [`MeshGeometry`].
    pub(crate) elevation: [f64; 2],
}

impl MeshBuffers {
    /// Uploads a mesh.
    pub fn new(gpu: &Gpu, mesh: &MeshGeometry) -> Self {
        let device = &gpu.device;
        let upload = |tile: &MeshTile| Tile {
            vertices: buffer(device, "vertices", BufferUsages::VERTEX, &tile.vertices),
            triangles: buffer(device, "triangles", BufferUsages::INDEX, &tile.triangles),
            corners: 3 * count(&tile.triangles),
            edges: buffer(device, "edges", BufferUsages::INDEX, &tile.edges),
            ends: 2 * count(&tile.edges),
            extent: tile.extent,
        };
        let tiles = mesh.tiles.iter().map(upload).collect();
        gpu.hand_over();
        Self {
            tiles,
            elevation: mesh.elevation,
        }
    }
}

#[derive(Debug)]
pub(crate) struct Mesh {
    faces: RenderPipeline,
    edges: RenderPipeline,
    depth_alone: RenderPipeline,
    pub(crate) mesh: MeshBuffers,
}

#[derive(Debug, Clone)]
struct Tile {
    vertices: Buffer,
    triangles: Buffer,
    corners: u32,
    edges: Buffer,
    ends: u32,
    extent: Extent,
}

impl Mesh {
    /// `photo` is the layout of the group that the surface's colours need besides the frame.
    pub(crate) fn new(device: &Device, frame: &BindGroupLayout, photo: &BindGroupLayout) -> Self {
        let module = module(device, SHADER);
        let buffers = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: VertexStepMode::Vertex,
            attributes: &vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Snorm8x4],
        }];
        let recipe = Recipe {
            module: &module,
            vertex: "vertex",
            fragment: Some("fragment"),
            groups: &[frame, photo],
            buffers: &buffers,
            topology: PrimitiveTopology::TriangleList,
            cull: None,
            depth: Some((CompareFunction::GreaterEqual, true)),
            translucent: false,
            constants: &[],
        };
        Self {
            faces: pipeline(device, &recipe),
            edges: pipeline(
                device,
                &Recipe {
                    vertex: "edge_vertex",
                    fragment: Some("edge_fragment"),
                    groups: &[frame],
                    topology: PrimitiveTopology::LineList,
                    depth: Some((CompareFunction::GreaterEqual, false)),
                    translucent: true,
                    ..recipe
                },
            ),
            depth_alone: pipeline(
                device,
                &Recipe {
                    fragment: None,
                    groups: &[frame],
                    ..recipe
                },
            ),
            mesh: MeshBuffers::default(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.mesh.tiles.is_empty()
    }

    pub(crate) fn extent(&self) -> Option<Extent> {
        self.mesh
            .tiles
            .iter()
            .map(|tile| tile.extent)
            .reduce(Extent::with)
    }

    /// How many triangles are in sight.
    pub(crate) fn count(&self, in_sight: &impl Fn(&Extent) -> bool) -> usize {
        let tiles = self.mesh.tiles.iter();
        tiles
            .filter(|tile| in_sight(&tile.extent))
            .map(|tile| tile.corners as usize / 3)
            .sum()
    }

    /// Draws triangles in sight from the tile `from` on, about `most` of them. Says how many they
    /// were, and the tile to go on with where some are left.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        from: usize,
        most: usize,
        in_sight: &impl Fn(&Extent) -> bool,
    ) -> (usize, Option<usize>) {
        pass.set_pipeline(&self.faces);
        self.draw_triangles(pass, from, most, in_sight)
    }

    /// Draws their depths alone.
    pub(crate) fn draw_depth(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.depth_alone);
        self.draw_triangles(pass, 0, usize::MAX, &|_| true);
    }

    /// Draws the edges of the triangles in sight.
    pub(crate) fn draw_edges(
        &self,
        pass: &mut RenderPass<'_>,
        in_sight: &impl Fn(&Extent) -> bool,
    ) {
        pass.set_pipeline(&self.edges);
        for tile in self.mesh.tiles.iter().filter(|tile| in_sight(&tile.extent)) {
            pass.set_vertex_buffer(0, tile.vertices.slice(..));
            pass.set_index_buffer(tile.edges.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..tile.ends, 0, 0..1);
        }
    }

    fn draw_triangles(
        &self,
        pass: &mut RenderPass<'_>,
        from: usize,
        most: usize,
        in_sight: &impl Fn(&Extent) -> bool,
    ) -> (usize, Option<usize>) {
        let mut drawn = 0;
        for (place, tile) in self.mesh.tiles.iter().enumerate().skip(from) {
            if !in_sight(&tile.extent) {
                continue;
            }
            if drawn >= most {
                return (drawn, Some(place));
            }
            pass.set_vertex_buffer(0, tile.vertices.slice(..));
            pass.set_index_buffer(tile.triangles.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..tile.corners, 0, 0..1);
            drawn += tile.corners as usize / 3;
        }
        (drawn, None)
    }
}
