//! Photos on planes in the world (`shaders/images.wgsl`).

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use image::RgbaImage;
use wgpu::{
    BindGroup, BindGroupLayout, BufferUsages, CompareFunction, Device, Extent3d, PrimitiveTopology,
    Queue, RenderPass, RenderPipeline, Sampler, Texture, TextureUsages, VertexStepMode,
    vertex_attr_array,
};

use super::frame;
use crate::device::pipeline::COLOR;
use crate::device::pipeline::Shader;
use crate::device::pipeline::{
    Recipe, buffer, count, group_layout, module, pictures, pipeline, sampler,
};
use crate::scene::photo_image::{EDGE, LEVELS, PhotoImage};
use crate::scene::{narrow, narrow_number};

pub(crate) const SHADER: Shader = (
    "images",
    &[frame::WGSL, include_str!("../../../shaders/images.wgsl")],
);

/// Photos in one texture: 64 take 22 MB.
const LAYERS: u32 = 64;

/// A photo's place for the graphics card.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Place {
    top_left: [f32; 3],
    across: [f32; 3],
    down: [f32; 3],
    layer: u32,
    opacity: f32,
}

impl Place {
    /// A plane with its corners in the contract's order, in the local frame.
    pub(crate) fn new(corners: [DVec3; 4], layer: u32, opacity: f64) -> Self {
        let [top_left, top_right, _, bottom_left] = corners;
        Self {
            top_left: narrow(top_left).to_array(),
            across: narrow(top_right - top_left).to_array(),
            down: narrow(bottom_left - top_left).to_array(),
            layer,
            opacity: narrow_number(opacity),
        }
    }
}

#[derive(Debug)]
pub(crate) struct Images {
    /// Among the surface.
    among: RenderPipeline,
    /// Over everything so far.
    over: RenderPipeline,
    layout: BindGroupLayout,
    sampler: Sampler,
    pages: Vec<Page>,
    /// The number of each photo's image: page and layer.
    numbers: HashMap<usize, u32>,
}

#[derive(Debug)]
struct Page {
    texture: Texture,
    group: BindGroup,
}

impl Images {
    pub(crate) fn new(device: &Device, frame: &BindGroupLayout) -> Self {
        let module = module(device, SHADER);
        let layout = group_layout(device, "images", &[pictures(0), sampler(1)]);
        let buffers = [wgpu::VertexBufferLayout {
            array_stride: size_of::<Place>() as u64,
            step_mode: VertexStepMode::Instance,
            attributes: &vertex_attr_array![
                0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Uint32, 4 => Float32
            ],
        }];
        let recipe = Recipe {
            module: &module,
            vertex: "vertex",
            fragment: Some("fragment"),
            groups: &[frame, &layout],
            buffers: &buffers,
            topology: PrimitiveTopology::TriangleStrip,
            cull: None,
            depth: Some((CompareFunction::GreaterEqual, true)),
            translucent: true,
            constants: &[],
        };
        Self {
            among: pipeline(device, &recipe),
            over: pipeline(
                device,
                &Recipe {
                    depth: Some((CompareFunction::Always, false)),
                    ..recipe
                },
            ),
            sampler: trilinear(device),
            layout,
            pages: Vec::new(),
            numbers: HashMap::new(),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.pages.clear();
        self.numbers.clear();
    }

    /// Uploads a photo's image, in place of an earlier one.
    pub(crate) fn set(&mut self, device: &Device, queue: &Queue, index: usize, image: &PhotoImage) {
        let next = u32::try_from(self.numbers.len()).unwrap_or(u32::MAX);
        let number = *self.numbers.entry(index).or_insert(next);
        let page = (number / LAYERS) as usize;
        if page == self.pages.len() {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("photos"),
                size: Extent3d {
                    width: EDGE,
                    height: EDGE,
                    depth_or_array_layers: LAYERS,
                },
                mip_level_count: LEVELS,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: COLOR,
                usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let group = self.group(device, &array_view(&texture));
            self.pages.push(Page { texture, group });
        }
        if let Some(page) = self.pages.get(page) {
            write_levels(queue, &page.texture, number % LAYERS, &image.levels);
        }
    }

    /// The layer of a photo's image in [`Self::draw`]'s numbering, where it has one.
    pub(crate) fn number(&self, index: usize) -> Option<u32> {
        self.numbers.get(&index).copied()
    }

    /// The binding of a single picture for [`Self::draw_over`].
    pub(crate) fn group(&self, device: &Device, view: &wgpu::TextureView) -> BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("images"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: wgpu::BindingResource::TextureView(view),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::Sampler(&self.sampler),
                },
            ],
        })
    }

    /// Draws photos among the surface. `places` come with their image's number and the corners of
    /// the plane.
    pub(crate) fn draw(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        planes: &[(u32, [DVec3; 4])],
    ) {
        for (page, number) in self.pages.iter().zip(0_u32..) {
            let places: Vec<Place> = planes
                .iter()
                .filter(|(own, _)| own / LAYERS == number)
                .map(|(own, corners)| Place::new(*corners, own % LAYERS, 1.0))
                .collect();
            if !places.is_empty() {
                let instances = buffer(device, "image planes", BufferUsages::VERTEX, &places);
                pass.set_pipeline(&self.among);
                pass.set_bind_group(1, &page.group, &[]);
                pass.set_vertex_buffer(0, instances.slice(..));
                pass.draw(0..4, 0..count(&places));
            }
        }
    }

    /// Draws a picture over everything so far.
    pub(crate) fn draw_over(
        &self,
        device: &Device,
        pass: &mut RenderPass<'_>,
        picture: &BindGroup,
        place: Place,
    ) {
        let instances = buffer(device, "photo in front", BufferUsages::VERTEX, &[place]);
        pass.set_pipeline(&self.over);
        pass.set_bind_group(1, picture, &[]);
        pass.set_vertex_buffer(0, instances.slice(..));
        pass.draw(0..4, 0..1);
    }
}

/// All layers of a texture.
pub(crate) fn array_view(texture: &Texture) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    })
}

pub(crate) fn trilinear(device: &Device) -> Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("trilinear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// Writes a picture and its halvings into a layer.
pub(crate) fn write_levels(queue: &Queue, texture: &Texture, layer: u32, levels: &[RgbaImage]) {
    for (level, mip_level) in levels.iter().zip(0_u32..) {
        let (width, height) = level.dimensions();
        queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture,
                mip_level,
                origin: wgpu::Origin3d {
                    x: 0,
                    y: 0,
                    z: layer,
                },
                aspect: wgpu::TextureAspect::All,
            },
            level,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: Some(height),
            },
            Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            },
        );
    }
}
