//! Passes over every texel of the picture, which read what earlier ones drew.

use wgpu::{
    BindGroup, BindGroupLayout, CompareFunction, Device, PrimitiveTopology, RenderPass,
    RenderPipeline, TextureView,
};

use crate::device::pipeline::Shader;
use crate::device::pipeline::{Recipe, group_layout, module, pipeline, texel_group, texels};

/// A pass over every texel of the picture, which reads others.
#[derive(Debug)]
pub(crate) struct Cover {
    pipeline: RenderPipeline,
    layout: BindGroupLayout,
}

impl Cover {
    /// A pass that reads this many textures, and writes depths or not.
    pub(crate) fn new(
        device: &Device,
        frame: &BindGroupLayout,
        shader: Shader,
        textures: u32,
        writes_depth: bool,
    ) -> Self {
        let entries: Vec<_> = (0..textures).map(texels).collect();
        let layout = group_layout(device, shader.0, &entries);
        let pipeline = pipeline(
            device,
            &Recipe {
                module: &module(device, shader),
                vertex: "vertex",
                fragment: Some("fragment"),
                groups: &[frame, &layout],
                buffers: &[],
                topology: PrimitiveTopology::TriangleList,
                cull: None,
                depth: writes_depth.then_some((CompareFunction::Always, true)),
                translucent: false,
                constants: &[],
            },
        );
        Self { pipeline, layout }
    }

    pub(crate) fn group(&self, device: &Device, textures: &[&TextureView]) -> BindGroup {
        texel_group(device, &self.layout, textures)
    }

    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, textures: &BindGroup) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, textures, &[]);
        pass.draw(0..3, 0..1);
    }
}
