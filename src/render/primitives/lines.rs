//! Strokes and dots (`shaders/lines.wgsl`).

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use wgpu::{
    BindGroupLayout, Buffer, BufferUsages, CompareFunction, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, VertexStepMode, vertex_attr_array,
};

use super::frame;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{Recipe, buffer, count, module, pipeline};
use crate::scene::{narrow, narrow_number};

pub(crate) const SHADER: Shader = (
    "lines",
    &[frame::WGSL, include_str!("../../../shaders/lines.wgsl")],
);

/// How much is seen of strokes behind something.
const TRACE: f64 = 0.16;

/// A stroke for the graphics card.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Stroke {
    from: [f32; 3],
    along: f32,
    to: [f32; 3],
    dash: f32,
    color: [u8; 4],
    width: f32,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pen {
    /// Red, green, blue, opacity.
    pub(crate) color: [u8; 4],
    /// In points of the user interface.
    pub(crate) width: f64,
    /// Length of a dash with its gap, in units of the line; 0 for none.
    pub(crate) dash: f64,
}

impl Pen {
    /// A whole line.
    pub(crate) fn new([r, g, b]: [u8; 3], width: f64) -> Self {
        Self {
            color: [r, g, b, 255],
            width,
            dash: 0.0,
        }
    }

    pub(crate) fn dashed(self, dash: f64) -> Self {
        Self { dash, ..self }
    }

    /// `opacity` from 0 to 1, of what it is already.
    pub(crate) fn pale(self, opacity: f64) -> Self {
        let [r, g, b, before] = self.color;
        Self {
            color: [r, g, b, (f64::from(before) * opacity).round() as u8],
            ..self
        }
    }

    /// A stroke that begins `along` its line.
    pub(crate) fn stroke(self, from: DVec3, to: DVec3, along: f64) -> Stroke {
        Stroke {
            from: narrow(from).to_array(),
            along: narrow_number(along),
            to: narrow(to).to_array(),
            dash: narrow_number(self.dash),
            color: self.color,
            width: narrow_number(self.width),
        }
    }

    /// A line of its own.
    pub(crate) fn line(self, from: DVec3, to: DVec3) -> Stroke {
        self.stroke(from, to, 0.0)
    }

    /// A dot as wide as the pen.
    pub(crate) fn dot(self, at: DVec3) -> Stroke {
        self.stroke(at, at, 0.0)
    }
}

#[derive(Debug)]
pub(crate) struct Lines {
    /// What is in front.
    front: RenderPipeline,
    /// A trace of what is behind something.
    behind: RenderPipeline,
    /// Over everything.
    over: RenderPipeline,
}

/// Strokes on the graphics card.
#[derive(Debug, Default)]
pub(crate) struct StrokeBuffer {
    buffer: Option<Buffer>,
    count: u32,
}

impl StrokeBuffer {
    pub(crate) fn new(device: &Device, strokes: &[Stroke]) -> Self {
        Self {
            buffer: (!strokes.is_empty())
                .then(|| buffer(device, "strokes", BufferUsages::VERTEX, strokes)),
            count: count(strokes),
        }
    }
}

impl Lines {
    pub(crate) fn new(device: &Device, frame: &BindGroupLayout) -> Self {
        let module = module(device, SHADER);
        let buffers = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Stroke>() as u64,
            step_mode: VertexStepMode::Instance,
            attributes: &vertex_attr_array![
                0 => Float32x4, 1 => Float32x4, 2 => Unorm8x4, 3 => Float32
            ],
        }];
        let recipe = Recipe {
            module: &module,
            vertex: "vertex",
            fragment: Some("fragment"),
            groups: &[frame],
            buffers: &buffers,
            topology: PrimitiveTopology::TriangleStrip,
            cull: None,
            depth: Some((CompareFunction::GreaterEqual, false)),
            translucent: true,
            constants: &[],
        };
        Self {
            front: pipeline(device, &recipe),
            behind: pipeline(
                device,
                &Recipe {
                    depth: Some((CompareFunction::Less, false)),
                    constants: &[("opacity", TRACE)],
                    ..recipe
                },
            ),
            over: pipeline(
                device,
                &Recipe {
                    depth: Some((CompareFunction::Always, false)),
                    ..recipe
                },
            ),
        }
    }

    /// Draws strokes among the surface, with a trace of what it hides.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, strokes: &StrokeBuffer) {
        for pipeline in [&self.behind, &self.front] {
            Self::draw_with(pipeline, pass, strokes);
        }
    }

    /// Draws strokes among the surface, without what it hides.
    pub(crate) fn draw_front(&self, pass: &mut RenderPass<'_>, strokes: &StrokeBuffer) {
        Self::draw_with(&self.front, pass, strokes);
    }

    /// Draws strokes over everything.
    pub(crate) fn draw_over(&self, pass: &mut RenderPass<'_>, strokes: &StrokeBuffer) {
        Self::draw_with(&self.over, pass, strokes);
    }

    fn draw_with(pipeline: &RenderPipeline, pass: &mut RenderPass<'_>, strokes: &StrokeBuffer) {
        if let Some(buffer) = &strokes.buffer {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, buffer.slice(..));
            pass.draw(0..4, 0..strokes.count);
        }
    }
}
