//! The textures that a frame is drawn into.

use wgpu::{Device, Extent3d, TextureUsages, TextureView};

use super::sight::Sight;
use crate::device::pipeline::{COLOR, DEPTH};

/// One picture's textures.
#[derive(Debug)]
pub(crate) struct Targets {
    /// Of the picture, in pixels.
    pub(crate) size: [u32; 2],
    /// Samples along each edge of a pixel, 1 or 2.
    pub(crate) samples: u32,
    /// The surface that is seen.
    pub(crate) surface: SurfaceTarget,
    /// The one under way, which takes its place when it is whole.
    pub(crate) next: SurfaceTarget,
    /// Of the surface, later of photos and lines too.
    pub(crate) depth: TextureView,
    /// Everything, with all samples; the picture itself where there is one sample.
    pub(crate) sampled: TextureView,
    /// The picture.
    pub(crate) picture: wgpu::Texture,
    /// All of the picture.
    pub(crate) picture_view: TextureView,
}

impl Targets {
    pub(crate) fn new(device: &Device, size: [u32; 2], samples: u32) -> Self {
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
    pub(crate) fn sampled_size(&self) -> [u32; 2] {
        self.size.map(|edge| edge * self.samples)
    }
}

/// Colours and depths of the surface alone.
#[derive(Debug)]
pub(crate) struct SurfaceTarget {
    pub(crate) color: TextureView,
    pub(crate) depth: TextureView,
    /// What it shows, or will show.
    pub(crate) sight: Option<Sight>,
    /// The tiles to go on with, of mesh and cloud; `None` where all are drawn.
    pub(crate) next: [Option<usize>; 2],
    /// Triangles and points drawn.
    pub(crate) drawn: [usize; 2],
}

impl SurfaceTarget {
    pub(crate) fn new(color: TextureView, depth: TextureView) -> Self {
        Self {
            color,
            depth,
            sight: None,
            next: [None; 2],
            drawn: [0; 2],
        }
    }

    /// Begins another sight.
    pub(crate) fn begin(&mut self, sight: Sight) {
        self.next = [sight.mesh, sight.cloud].map(|wanted| wanted.then_some(0));
        self.drawn = [0; 2];
        self.sight = Some(sight);
    }

    /// Whether nothing is missing.
    pub(crate) fn is_whole(&self) -> bool {
        self.next == [None; 2]
    }
}
