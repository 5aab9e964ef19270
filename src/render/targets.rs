//! The textures that a frame is drawn into.

use wgpu::{Device, Extent3d, TextureFormat, TextureUsages, TextureView};

use super::sight::SurfaceTarget;

/// Gamma-space colours, as egui wants them.
pub(super) const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Reverse-z needs floating point.
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// One picture's textures.
#[derive(Debug)]
pub(super) struct Targets {
    /// Of the picture, in pixels.
    pub(super) size: [u32; 2],
    /// Samples along each edge of a pixel, 1 or 2.
    pub(super) samples: u32,
    /// The surface that is seen.
    pub(super) surface: SurfaceTarget,
    /// The one under way, which takes its place when it is whole.
    pub(super) next: SurfaceTarget,
    /// Of the surface, later of photos and lines too.
    pub(super) depth: TextureView,
    /// Everything, with all samples; the picture itself where there is one sample.
    pub(super) sampled: TextureView,
    /// The picture.
    pub(super) picture: wgpu::Texture,
    /// All of the picture.
    pub(super) picture_view: TextureView,
}

impl Targets {
    pub(super) fn new(device: &Device, size: [u32; 2], samples: u32) -> Self {
        let make = |label, samples: u32, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: Extent3d {
                    width: size[0] * samples,
                    height: size[1] * samples,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let view =
            |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let surface = |label| {
            let [color, depth] = [COLOR, DEPTH]
                .map(|format| view(&make(label, samples, format, TextureUsages::empty())));
            SurfaceTarget::new(color, depth)
        };
        let picture = make("picture", 1, COLOR, TextureUsages::COPY_SRC);
        let picture_view = view(&picture);
        Self {
            size,
            samples,
            surface: surface("surface"),
            next: surface("next surface"),
            depth: view(&make("depth", samples, DEPTH, TextureUsages::empty())),
            sampled: if samples == 1 {
                picture_view.clone()
            } else {
                view(&make("sampled", samples, COLOR, TextureUsages::empty()))
            },
            picture,
            picture_view,
        }
    }

    /// With all samples, in texels.
    pub(super) fn sampled_size(&self) -> [u32; 2] {
        self.size.map(|edge| edge * self.samples)
    }
}
