//! What every shader knows of the frame (`shaders/frame.wgsl`).

use bytemuck::{Pod, Zeroable};
use wgpu::{BindGroup, BindGroupLayout, Buffer, BufferUsages, Device, Queue, ShaderStages};

use super::pipeline::{buffer, group_layout};

/// The uniform; its fields are explained in the shader.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Frame {
    pub(super) clip_from_local: [[f32; 4]; 4],
    pub(super) local_from_clip: [[f32; 4]; 4],
    pub(super) image_from_local: [[f32; 4]; 4],
    pub(super) background: [f32; 4],
    pub(super) ink: [f32; 4],
    pub(super) eye: [f32; 4],
    pub(super) size: [f32; 2],
    pub(super) depths: [f32; 2],
    pub(super) texel: f32,
    pub(super) parallel: f32,
    pub(super) point: f32,
    pub(super) nearest: f32,
    pub(super) lift: [f32; 2],
    pub(super) range: [f32; 2],
    pub(super) radius: f32,
    pub(super) photo_near: f32,
    pub(super) photo_scale: f32,
    pub(super) elevation: f32,
    pub(super) color_by: u32,
    pub(super) project: u32,
    pub(super) relief: f32,
    pub(super) spare: f32,
    pub(super) viridis: [[f32; 4]; 17],
}

/// A frame on the graphics card.
#[derive(Debug)]
pub(super) struct FrameBinding {
    buffer: Buffer,
    pub(super) group: BindGroup,
}

/// The layout of group 0.
pub(super) fn frame_layout(device: &Device) -> BindGroupLayout {
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
    pub(super) fn new(device: &Device, layout: &BindGroupLayout) -> Self {
        let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
        let buffer = buffer(device, "frame", usage, &[Frame::zeroed()]);
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

    pub(super) fn write(&self, queue: &Queue, frame: &Frame) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(frame));
    }
}
