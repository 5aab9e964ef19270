//! What every shader knows of the frame (`shaders/frame.wgsl`).

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, Device, Queue, ShaderStages};

use crate::device::pipeline::{buffer, group_layout};

/// The shared frame uniform.
pub(crate) const WGSL: &str = include_str!("../../../shaders/frame.wgsl");

/// The uniform; its fields are explained in the shader.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct FrameUniform {
    pub(crate) clip_from_local: [[f32; 4]; 4],
    pub(crate) local_from_clip: [[f32; 4]; 4],
    pub(crate) image_from_local: [[f32; 4]; 4],
    pub(crate) background: [f32; 4],
    pub(crate) ink: [f32; 4],
    pub(crate) eye: [f32; 4],
    pub(crate) box_middle: [f32; 4],
    pub(crate) box_half: [f32; 4],
    pub(crate) box_turn: [f32; 4],
    pub(crate) size: [f32; 2],
    pub(crate) depths: [f32; 2],
    pub(crate) texel: f32,
    pub(crate) parallel: f32,
    pub(crate) point: f32,
    pub(crate) nearest: f32,
    pub(crate) lift: [f32; 2],
    pub(crate) range: [f32; 2],
    pub(crate) radius: f32,
    pub(crate) photo_near: f32,
    pub(crate) photo_scale: f32,
    pub(crate) elevation: f32,
    pub(crate) color_by: u32,
    pub(crate) project: u32,
    pub(crate) relief: f32,
    pub(crate) least: f32,
    pub(crate) viridis: [[f32; 4]; 17],
}

/// A frame on the graphics card.
#[derive(Debug)]
pub(crate) struct FrameBinding {
    buffer: Buffer,
    pub(crate) group: BindGroup,
}

/// The layout of group 0.
pub(crate) fn frame_layout(device: &Device) -> BindGroupLayout {
    let entry = wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    group_layout(device, "frame", &[entry])
}

impl FrameBinding {
    pub(crate) fn new(device: &Device, layout: &BindGroupLayout) -> Self {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let buffer = buffer(device, "frame", usage, &[FrameUniform::zeroed()]);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: buffer.as_entire_binding(),
            }],
        });
        Self { buffer, group }
    }

    pub(crate) fn write(&self, queue: &Queue, frame: &FrameUniform) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(frame));
    }
}
