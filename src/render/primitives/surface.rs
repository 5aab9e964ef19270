//! What the surface's colours need of the selected photo (`shaders/surface.wgsl`): its picture, and
//! how deep it sees.

use image::RgbaImage;
use image::imageops::{FilterType, resize};
use wgpu::{
    BindGroup, BindGroupLayout, Device, Extent3d, Sampler, TextureFormat, TextureUsages,
    TextureView,
};

use super::images::{array_view, trilinear, write_levels};
use crate::device::gpu::Gpu;
use crate::device::pipeline::{COLOR, DEPTH};
use crate::device::pipeline::{group_layout, pictures, sampler, texels};

/// What points and mesh share.
pub(crate) const WGSL: &str = include_str!("../../../shaders/surface.wgsl");

/// Longer edge of the texture of how deep a photo sees.
const DEPTH_EDGE: f64 = 1024.0;

/// An undistorted photo on the graphics card, to be laid on the surface. Uploading can be done on a
/// worker thread; clones share the texture.
#[derive(Debug, Clone)]
pub struct LargePhoto(TextureView);

impl LargePhoto {
    /// Uploads a photo with its halvings, so that it does not glitter from afar.
    pub fn new(gpu: &Gpu, image: &RgbaImage) -> Self {
        let most = gpu.device.limits().max_texture_dimension_2d;
        let longest = image.width().max(image.height());
        let first = if longest > most {
            let shrunk = |edge: u32| {
                // Fits u32: it is less than before.
                let edge = u64::from(edge) * u64::from(most) / u64::from(longest);
                u32::try_from(edge).unwrap_or(most).max(1)
            };
            let (width, height) = (shrunk(image.width()), shrunk(image.height()));
            resize(image, width, height, FilterType::Triangle)
        } else {
            image.clone()
        };
        let mut levels = vec![first];
        while let Some(last) = levels.last()
            && last.width().max(last.height()) > 1
        {
            let (width, height) = ((last.width() / 2).max(1), (last.height() / 2).max(1));
            let halved = resize(last, width, height, FilterType::Triangle);
            levels.push(halved);
        }
        let size = [levels[0].width(), levels[0].height()];
        let count = u32::try_from(levels.len()).unwrap_or(1);
        let texture = texture(&gpu.device, COLOR, size, count);
        write_levels(&gpu.queue, &texture, 0, &levels);
        gpu.hand_over();
        Self(array_view(&texture))
    }
}

#[derive(Debug)]
pub(crate) struct SurfacePhoto {
    pub(crate) layout: BindGroupLayout,
    sampler: Sampler,
    pub(crate) picture: TextureView,
    /// Which photo the picture is of.
    pub(crate) index: Option<usize>,
    pub(crate) depth: TextureView,
    pub(crate) group: BindGroup,
}

impl SurfacePhoto {
    pub(crate) fn new(device: &Device) -> Self {
        let layout = group_layout(
            device,
            "photo on the surface",
            &[pictures(0), sampler(1), texels(2)],
        );
        let sampler = trilinear(device);
        let picture = array_view(&texture(device, COLOR, [1, 1], 1));
        let depth = view(&texture(device, DEPTH, [1, 1], 1));
        let group = bind(device, &layout, &sampler, &picture, &depth);
        Self {
            layout,
            sampler,
            picture,
            index: None,
            depth,
            group,
        }
    }

    /// Takes the picture of the photo with this index.
    pub(crate) fn set_picture(&mut self, device: &Device, photo: Option<(usize, LargePhoto)>) {
        self.index = photo.as_ref().map(|(index, _)| *index);
        if let Some((_, LargePhoto(picture))) = photo {
            self.picture = picture;
            self.bind(device);
        }
    }

    /// A new, empty texture for how deep a photo with this image size sees.
    pub(crate) fn renew_depth(&mut self, device: &Device, image: [u32; 2]) {
        let longest = f64::from(image[0].max(image[1]));
        // `as` saturates.
        let size = image.map(|edge| (f64::from(edge) / longest * DEPTH_EDGE).ceil() as u32);
        self.depth = view(&texture(device, DEPTH, size, 1));
        self.bind(device);
    }

    fn bind(&mut self, device: &Device) {
        self.group = bind(
            device,
            &self.layout,
            &self.sampler,
            &self.picture,
            &self.depth,
        );
    }
}

fn texture(
    device: &Device,
    format: TextureFormat,
    size: [u32; 2],
    mip_level_count: u32,
) -> wgpu::Texture {
    let usage = if format == DEPTH {
        TextureUsages::RENDER_ATTACHMENT
    } else {
        TextureUsages::COPY_DST
    };
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("photo on the surface"),
        size: Extent3d {
            width: size[0].max(1),
            height: size[1].max(1),
            // OpenGL takes a texture of one layer for none of a list, as which the shaders read it.
            depth_or_array_layers: if format == DEPTH { 1 } else { 2 },
        },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

fn view(texture: &wgpu::Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn bind(
    device: &Device,
    layout: &BindGroupLayout,
    sampler: &Sampler,
    picture: &TextureView,
    depth: &TextureView,
) -> BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("photo on the surface"),
        layout,
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(picture),
            },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::Sampler(sampler),
            },
            wgpu::BindGroupEntry {
                binding: 2,
                resource: wgpu::BindingResource::TextureView(depth),
            },
        ],
    })
}
