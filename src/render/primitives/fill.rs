//! The insides of footprints (`shaders/fill.wgsl`).

use bytemuck::{Pod, Zeroable};
use wgpu::{
    BindGroup, BindGroupLayout, BufferUsages, CompareFunction, Device, Face, PrimitiveTopology,
    RenderPass, RenderPipeline, TextureView, VertexStepMode, vertex_attr_array,
};

use super::frame;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{
    Recipe, buffer, count, group_layout, module, pipeline, texel_group, texels,
};
use crate::scene::photo_geometry::PhotoGeometry;
use crate::scene::{narrow, narrow_matrix, narrow_number};

pub(crate) const SHADER: Shader = (
    "fill",
    &[frame::WGSL, include_str!("../../../shaders/fill.wgsl")],
);

/// The pyramid of a photo for the graphics card.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Pyramid {
    apex: [f32; 3],
    corners: [[f32; 3]; 4],
    rows: [[f32; 4]; 3],
    image_corners: [[f32; 2]; 4],
    color: [u8; 4],
    reach: f32,
}

impl Pyramid {
    /// Of a photo whose corners all have rays and whose footprint is known.
    pub(crate) fn new(photo: &PhotoGeometry, color: [u8; 4]) -> Option<Self> {
        let corners = photo.image_corners?;
        let deepest = photo.depth_of_share(1.0)?;
        // A little more than the footprint's samples saw: between them stones may be deeper.
        let reach = deepest * 1.05;
        let matrix = narrow_matrix(photo.image_from_local());
        Some(Self {
            apex: narrow(photo.center).to_array(),
            corners: corners.map(|share| narrow(photo.point_at(share, reach)).to_array()),
            rows: [0, 1, 2].map(|row| matrix.row(row).to_array()),
            image_corners: corners.map(|share| share.as_vec2().to_array()),
            color,
            reach: narrow_number(reach),
        })
    }
}

/// A corner of a cell on the ground, for the graphics card.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CellCorner {
    pub(crate) local: [f32; 3],
    pub(crate) color: [u8; 4],
}

#[derive(Debug)]
pub(crate) struct Fill {
    pyramids: RenderPipeline,
    cells: RenderPipeline,
    layout: BindGroupLayout,
}

impl Fill {
    pub(crate) fn new(device: &Device, frame: &BindGroupLayout) -> Self {
        let module = module(device, SHADER);
        let layout = group_layout(device, "depth", &[texels(0)]);
        let recipe = Recipe {
            module: &module,
            vertex: "vertex",
            fragment: Some("fragment"),
            groups: &[frame, &layout],
            buffers: &[wgpu::VertexBufferLayout {
                array_stride: size_of::<Pyramid>() as u64,
                step_mode: VertexStepMode::Instance,
                attributes: &vertex_attr_array![
                    0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3, 4 => Float32x3,
                    5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4, 9 => Float32x4,
                    10 => Unorm8x4, 11 => Float32
                ],
            }],
            topology: PrimitiveTopology::TriangleList,
            // The far sides: they are in sight from inside of the pyramid too.
            cull: Some(Face::Front),
            depth: None,
            translucent: true,
            constants: &[],
        };
        Self {
            pyramids: pipeline(device, &recipe),
            cells: pipeline(
                device,
                &Recipe {
                    vertex: "cell_vertex",
                    fragment: Some("cell_fragment"),
                    groups: &[frame],
                    buffers: &[wgpu::VertexBufferLayout {
                        array_stride: size_of::<CellCorner>() as u64,
                        step_mode: VertexStepMode::Vertex,
                        attributes: &vertex_attr_array![0 => Float32x3, 1 => Unorm8x4],
                    }],
                    cull: None,
                    depth: Some((CompareFunction::GreaterEqual, false)),
                    ..recipe
                },
            ),
            layout,
        }
    }

    pub(crate) fn group(&self, device: &Device, depth: &TextureView) -> BindGroup {
        texel_group(device, &self.layout, &[depth])
    }

    /// Tints what the pyramids enclose. The pass must not have the depth texture attached.
    pub(crate) fn draw(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        depth: &BindGroup,
        pyramids: &[Pyramid],
    ) {
        if !pyramids.is_empty() {
            let instances = buffer(device, "pyramids", BufferUsages::VERTEX, pyramids);
            pass.set_pipeline(&self.pyramids);
            pass.set_bind_group(1, depth, &[]);
            pass.set_vertex_buffer(0, instances.slice(..));
            pass.draw(0..18, 0..count(pyramids));
        }
    }

    /// Draws cells on the ground, three corners a triangle.
    pub(crate) fn draw_cells(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        corners: &[CellCorner],
    ) {
        if !corners.is_empty() {
            let vertices = buffer(device, "ground cells", BufferUsages::VERTEX, corners);
            pass.set_pipeline(&self.cells);
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.draw(0..count(corners), 0..1);
        }
    }
}
