//! Drawing a frame.

use glam::DVec3;
use image::RgbaImage;

use super::gpu::Gpu;
use super::labels::{Label, Legend};
use super::photo_image::PhotoImage;
use super::scene::{CloudGeometry, MeshGeometry, PhotoGeometry};
use super::show::{PhotoLook, Show};
use super::targets::Targets;
use super::view::View;
use crate::fault::Fault;
use crate::geometry::{Bounds, LocalFrame};

/// Draws a flight. Holds what was uploaded and the textures of the last frame.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    frame: LocalFrame,
    photos: Vec<PhotoGeometry>,
    looks: Vec<PhotoLook>,
    targets: Option<Targets>,
}

/// What a frame was made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drawn {
    /// Whether [`Renderer::color_view`] is another texture than before.
    pub new_texture: bool,
    /// Points drawn.
    pub points: usize,
    /// Triangles of the mesh drawn.
    pub triangles: usize,
}

impl Renderer {
    /// Prepares the pipelines; nothing is there to be drawn yet.
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            frame: LocalFrame::near(&Bounds {
                min: DVec3::ZERO,
                max: DVec3::ZERO,
            }),
            photos: Vec::new(),
            looks: Vec::new(),
            targets: None,
        }
    }

    /// Begins another flight: takes everything away. All geometry must be made in this frame.
    pub fn start(&mut self, frame: &LocalFrame) {
        self.frame = *frame;
        self.photos.clear();
        self.looks.clear();
    }

    /// Uploads the cloud, or takes it away.
    pub fn set_cloud(&mut self, _cloud: Option<&CloudGeometry>) {}

    /// Uploads the mesh, or takes it away.
    pub fn set_mesh(&mut self, _mesh: Option<&MeshGeometry>) {}

    /// The photos of the flight, in its order. Their looks become the default, their images stay.
    pub fn set_photos(&mut self, photos: Vec<PhotoGeometry>) {
        self.looks = vec![PhotoLook::default(); photos.len()];
        self.photos = photos;
    }

    /// How the photos look, in their order.
    pub fn set_looks(&mut self, looks: &[PhotoLook]) {
        self.looks = looks.to_vec();
    }

    /// Uploads the reduced, undistorted photo with this index.
    pub fn set_photo_image(&mut self, _index: usize, _image: &PhotoImage) {}

    /// The undistorted photo with this index, larger: to be laid on the surface
    /// ([`Show::project_photo`]) or over the look through its camera ([`Show::photo_blend`]).
    pub fn set_projected_photo(&mut self, _photo: Option<(usize, &RgbaImage)>) {}

    /// Draws a frame of `size` pixels; see it through [`Self::color_view`].
    pub fn draw(&mut self, _view: &View, _show: &Show, size: [u32; 2]) -> Drawn {
        let size = size.map(|edge| edge.max(1));
        let new_texture = self.targets.as_ref().is_none_or(|t| t.size != size);
        if new_texture {
            let samples = if self.gpu.software { 1 } else { 2 };
            self.targets = Some(Targets::new(&self.gpu.device, size, samples));
        }
        Drawn {
            new_texture,
            points: 0,
            triangles: 0,
        }
    }

    /// The last frame: Rgba8Unorm with gamma-space values, to be shown as a texture. `None` before
    /// the first frame.
    pub fn color_view(&self) -> Option<&wgpu::TextureView> {
        self.targets.as_ref().map(|targets| &targets.picture_view)
    }

    /// Draws into an image, without labels. Pictures larger than a texture are put together from
    /// parts.
    ///
    /// # Errors
    /// Where the graphics device refuses.
    pub fn picture(
        &mut self,
        _view: &View,
        _show: &Show,
        size: [u32; 2],
    ) -> Result<RgbaImage, Fault> {
        self.gpu.check()?;
        Ok(RgbaImage::new(size[0], size[1]))
    }

    /// The words on a frame: the scale bar's length, the letters of the axes.
    pub fn labels(&self, _view: &View, _show: &Show, _size: [u32; 2]) -> Vec<Label> {
        Vec::new()
    }

    /// What the colours mean, where they mean a number.
    pub fn legend(&self, _show: &Show) -> Option<Legend> {
        None
    }
}
