//! What is drawn, frame by frame or into a picture; how is in `passes`.

mod aside;
mod beside;
pub(crate) mod part;
mod pass;
mod passes;
mod sight;
mod targets;
#[cfg(test)]
mod tests;

use glam::DVec3;
use image::RgbaImage;
use wgpu::TextureView;

use crate::device::gpu::Gpu;
use crate::device::readback::read_back;
use crate::fault::Fault;
use crate::furniture;
use crate::furniture::labels::{Label, Legend, ScaleBar};
use crate::furniture::words::write_words;
use crate::geometry::{Bounds, LocalFrame};
use crate::primitives::cover::Cover;
use crate::primitives::edl::edl;
use crate::primitives::fill::Fill;
use crate::primitives::frame::{FrameBinding, frame_layout};
use crate::primitives::images::Images;
use crate::primitives::lines::{Lines, StrokeBuffer};
use crate::primitives::mesh::{Mesh, MeshBuffers};
use crate::primitives::points::{CloudBuffers, Points};
use crate::primitives::resolve::resolve;
use crate::primitives::surface::{LargePhoto, SurfacePhoto};
use crate::scene::photo_geometry::PhotoGeometry;
use crate::scene::photo_image::PhotoImage;
use crate::scene::{CloudGeometry, Extent, MeshGeometry, narrow};
use crate::show::{ColorBy, PhotoLook, Show};
use crate::surface_buffers::SurfaceBuffers;
use crate::view::View;
pub use aside::Aside;
pub use beside::BesideCloud;
use part::{Most, Part, pair};
use targets::Targets;

/// More texels than this are too many to draw again and again: then a pixel has one sample.
const MOST_SAMPLED_TEXELS: u64 = 1 << 24;
/// Pixels that parts of a large picture overlap by, so that relief has no seams.
const OVERLAP: u32 = 16;

/// The largest picture, in pixels: 0.8 GB in memory.
pub const MOST_PIXELS: u64 = 200_000_000;

/// Draws a flight. Holds what was uploaded and the textures of the last frame.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) frame: LocalFrame,
    pub(crate) points: Points,
    pub(crate) mesh: Mesh,
    pub(crate) beside: beside::Beside,
    pub(crate) photos: Vec<PhotoGeometry>,
    pub(crate) looks: Vec<PhotoLook>,
    /// The photos in the order of the flight line.
    pub(crate) line: Vec<usize>,
    /// Around what there is to be seen, without outliers: its middle in the local frame, and its radius.
    pub(crate) bulk: Option<(DVec3, f64)>,
    pub(crate) surface_photo: SurfacePhoto,
    pub(crate) images: Images,
    pub(crate) lines: Lines,
    pub(crate) fill: Fill,
    pub(crate) edl: Cover,
    pub(crate) resolve: Cover,
    pub(crate) main_frame: FrameBinding,
    pub(crate) screen_frame: FrameBinding,
    pub(crate) photo_frame: FrameBinding,
    /// The photos' lines, and what they were made for.
    pub(crate) strokes: StrokeBuffer,
    pub(crate) strokes_for: Option<(Show, Option<usize>)>,
    /// Which photo the depths in `surface_photo` are of.
    pub(crate) depth_of: Option<usize>,
    /// Counts what was uploaded of the surface.
    pub(crate) version: u64,
    /// Counts the photos to lay on it.
    pub(crate) photo_version: u64,
    pub(crate) targets: Option<Targets>,
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
    /// Whether the surface is whole; else an earlier picture of it still stands in.
    pub whole: bool,
    /// Whether finer points of a large cloud are on their way: draw again in a moment.
    pub awaited: bool,
}

impl Renderer {
    /// Prepares the pipelines; nothing is there to be drawn yet.
    pub fn new(gpu: &Gpu) -> Self {
        let device = &gpu.device;
        let frame = frame_layout(device);
        let surface_photo = SurfacePhoto::new(device);
        Self {
            frame: LocalFrame::near(&Bounds {
                min: DVec3::ZERO,
                max: DVec3::ZERO,
            }),
            points: Points::new(device, &[&frame, &surface_photo.layout]),
            mesh: Mesh::new(device, &frame, &surface_photo.layout),
            beside: beside::Beside::default(),
            photos: Vec::new(),
            looks: Vec::new(),
            line: Vec::new(),
            bulk: None,
            surface_photo,
            images: Images::new(device, &frame),
            lines: Lines::new(device, &frame),
            fill: Fill::new(device, &frame),
            edl: edl(device, &frame),
            resolve: resolve(device, &frame),
            main_frame: FrameBinding::new(device, &frame),
            screen_frame: FrameBinding::new(device, &frame),
            photo_frame: FrameBinding::new(device, &frame),
            strokes: StrokeBuffer::default(),
            strokes_for: None,
            depth_of: None,
            version: 0,
            photo_version: 0,
            targets: None,
            gpu: gpu.clone(),
        }
    }

    /// Begins another flight: takes everything away. All geometry must be made in this frame.
    pub fn start(&mut self, frame: &LocalFrame) {
        self.frame = *frame;
        self.clear();
    }

    /// Takes everything away.
    pub fn clear(&mut self) {
        self.set_cloud(None);
        self.set_mesh(None);
        self.set_beside([]);
        self.set_photos(Vec::new());
        self.bulk = None;
        self.images.clear();
        self.set_projected_photo(None);
    }

    /// Uploads the cloud, or takes it away.
    pub fn set_cloud(&mut self, cloud: Option<&CloudGeometry>) {
        self.set_cloud_buffers(cloud.map(|cloud| CloudBuffers::new(&self.gpu, cloud)));
    }

    fn set_cloud_buffers(&mut self, cloud: Option<CloudBuffers>) {
        self.points.set(&self.gpu, cloud.unwrap_or_default());
        self.version += 1;
    }

    /// Uploads the mesh, or takes it away.
    pub fn set_mesh(&mut self, mesh: Option<&MeshGeometry>) {
        self.set_mesh_buffers(mesh.map(|mesh| MeshBuffers::new(&self.gpu, mesh)));
    }

    fn set_mesh_buffers(&mut self, mesh: Option<MeshBuffers>) {
        self.mesh.mesh = mesh.unwrap_or_default();
        self.version += 1;
        self.depth_of = None;
    }

    /// Takes a surface that is uploaded already, or takes it away.
    pub fn set_surface(&mut self, surface: Option<&SurfaceBuffers>) {
        self.set_cloud_buffers(surface.and_then(|surface| surface.cloud.clone()));
        self.set_mesh_buffers(surface.and_then(|surface| surface.mesh.clone()));
    }

    /// The box around the bulk of the surface, in the world: the ground's grid lies under it. Without it
    /// that is everything, outliers too.
    pub fn set_bulk(&mut self, bulk: Option<&Bounds>) {
        self.bulk = bulk.map(|bulk| {
            let middle = self.frame.local_from_world(bulk.center());
            (middle, (bulk.size().length() * 0.5).max(1e-6))
        });
    }

    /// The order in which the flight line goes through the photos: their indices. [`Self::set_photos`]
    /// takes the photos' own order.
    pub fn set_flight_line(&mut self, line: Vec<usize>) {
        self.line = line;
        self.strokes_for = None;
    }

    /// The photos of the flight, in its order. Their looks become the default, their images stay.
    pub fn set_photos(&mut self, photos: Vec<PhotoGeometry>) {
        self.line = (0..photos.len()).collect();
        self.looks = vec![PhotoLook::default(); photos.len()];
        self.photos = photos;
        self.strokes_for = None;
        self.depth_of = None;
    }

    /// How the photos look, in their order; those that `looks` is too short for keep theirs.
    pub fn set_looks(&mut self, looks: &[PhotoLook]) {
        for (own, look) in self.looks.iter_mut().zip(looks) {
            *own = *look;
        }
        self.strokes_for = None;
    }

    /// Uploads the reduced, undistorted photo with this index.
    pub fn set_photo_image(&mut self, index: usize, image: &PhotoImage) {
        self.images
            .set(&self.gpu.device, &self.gpu.queue, index, image);
    }

    /// The undistorted photo with this index, larger: to be laid on the surface
    /// ([`Show::project_photo`]) or over the look through its camera ([`Show::photo_blend`]). Both
    /// are drawn only while it is the selected one.
    pub fn set_projected_photo(&mut self, photo: Option<(usize, &RgbaImage)>) {
        let upload = |(index, image)| (index, LargePhoto::new(&self.gpu, image));
        self.set_uploaded_photo(photo.map(upload));
    }

    /// [`Self::set_projected_photo`] with one that is uploaded already.
    pub fn set_uploaded_photo(&mut self, photo: Option<(usize, LargePhoto)>) {
        self.surface_photo.set_picture(&self.gpu.device, photo);
        self.photo_version += 1;
    }

    /// Draws a frame of `size` pixels; see it through [`Self::color_view`]. Errors of the device are
    /// kept in [`Gpu::take_error`].
    pub fn draw(&mut self, view: &View, show: &Show, size: [u32; 2]) -> Drawn {
        self.draw_portion(view, show, size, usize::MAX)
    }

    /// [`Self::draw`], which draws about `most` triangles or points of the surface in one call where
    /// an earlier picture of it from the same view can stand in. Call again until
    /// [`Drawn::whole`].
    pub fn draw_portion(&mut self, view: &View, show: &Show, size: [u32; 2], most: usize) -> Drawn {
        let edge = self.gpu.device.limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, edge));
        let texels = 4 * u64::from(size[0]) * u64::from(size[1]);
        let samples =
            if self.gpu.software || texels > MOST_SAMPLED_TEXELS || size[0].max(size[1]) * 2 > edge
            {
                1
            } else {
                2
            };
        let kept = self.targets.take().filter(|t| t.size == size);
        let new_texture = kept.is_none();
        let mut targets = kept.unwrap_or_else(|| Targets::new(&self.gpu.device, size, samples));
        let most = Most::Portion(most);
        let [whole, awaited] = self.draw_part(&mut targets, view, show, Part::whole(size), most);
        let [triangles, points] = targets.surface.drawn;
        self.targets = Some(targets);
        Drawn {
            new_texture,
            points,
            triangles,
            whole,
            awaited,
        }
    }

    /// The last frame: Rgba8Unorm with premultiplied gamma-space values, to be shown as a texture.
    /// `None` before the first frame.
    pub fn color_view(&self) -> Option<&TextureView> {
        self.targets.as_ref().map(|targets| &targets.picture_view)
    }

    /// Draws into an image with four samples a pixel, without labels; alpha is not premultiplied.
    /// Pictures larger than a texture are put together from parts.
    ///
    /// # Errors
    /// Where the graphics device refuses.
    pub fn picture(
        &mut self,
        view: &View,
        show: &Show,
        size: [u32; 2],
    ) -> Result<RgbaImage, Fault> {
        let most = self.gpu.device.limits().max_texture_dimension_2d / 2;
        self.picture_in_parts(view, show, size, most.min(4096))
    }

    /// [`Self::picture`] from parts with edges of at most `most` pixels.
    fn picture_in_parts(
        &mut self,
        view: &View,
        show: &Show,
        size: [u32; 2],
        most: u32,
    ) -> Result<RgbaImage, Fault> {
        self.gpu.check()?;
        let mut picture = RgbaImage::new(size[0], size[1]);
        let step = most.saturating_sub(2 * OVERLAP).max(1);
        let fits = size[0].max(size[1]) <= most;
        let starts = |edge: u32| (0..edge).step_by(if fits { edge.max(1) } else { step } as usize);
        for y in starts(size[1]) {
            for x in starts(size[0]) {
                let origin = if fits {
                    [0, 0]
                } else {
                    [x.saturating_sub(OVERLAP), y.saturating_sub(OVERLAP)]
                };
                let part = Part {
                    origin,
                    size: [0, 1].map(|i| most.min(size[i] - origin[i])),
                    of: size,
                };
                let mut targets = Targets::new(&self.gpu.device, part.size, 2);
                self.draw_part(&mut targets, view, show, part, Most::All);
                let pixels = read_back(&self.gpu, &targets.picture)?;
                self.gpu.check()?;
                image::imageops::replace(
                    &mut picture,
                    &without_margin(&pixels, x - origin[0], y - origin[1]),
                    i64::from(x),
                    i64::from(y),
                );
            }
        }
        Ok(picture)
    }

    /// [`Self::picture`] with its labels and the legend of its colours.
    ///
    /// # Errors
    /// Where the graphics device refuses.
    pub fn picture_with_words(
        &mut self,
        view: &View,
        show: &Show,
        size: [u32; 2],
    ) -> Result<RgbaImage, Fault> {
        let mut picture = self.picture(view, show, size)?;
        let labels = self.labels(view, show, size);
        write_words(&mut picture, &labels, self.legend(show).as_ref(), show);
        Ok(picture)
    }

    /// The words on a frame: the scale bar's length, the letters of the axes.
    pub fn labels(&self, view: &View, show: &Show, size: [u32; 2]) -> Vec<Label> {
        furniture::labels(view, show, pair(size))
    }

    /// The scale bar of a frame.
    pub fn scale_bar(&self, view: &View, size: [u32; 2]) -> Option<ScaleBar> {
        furniture::scale_bar(view, pair(size))
    }

    /// What the colours mean, where they mean a number.
    pub fn legend(&self, show: &Show) -> Option<Legend> {
        let unit = show.lengths_in;
        let scales = show.scale_unit.unwrap_or(show.unit);
        let title = match show.color_by {
            ColorBy::Rgb => return None,
            ColorBy::Elevation => format!("elevation ({unit})"),
            // A level of detail has points and no triangles, which a slope is of.
            ColorBy::Slope if self.mesh.is_empty() && self.points.is_streamed() => {
                "slope: not for streamed points".to_owned()
            }
            ColorBy::Slope => "slope (°)".to_owned(),
            ColorBy::Scale => format!("scale (px/{})", scales.symbol()),
        };
        let mut range = self.range(show)?;
        if show.color_by == ColorBy::Scale {
            range = range.map(|scale| scale * scales.in_units_of(show.unit));
        }
        Some(Legend { title, range })
    }

    /// The values at the colour map's ends.
    pub(crate) fn range(&self, show: &Show) -> Option<[f64; 2]> {
        let range = match show.color_by {
            ColorBy::Rgb => return None,
            ColorBy::Scale if show.selected.is_none() => return None,
            _ if let Some(limits) = show.color_limits => limits,
            ColorBy::Elevation if self.mesh.is_empty() => self.points.cloud.elevation,
            ColorBy::Elevation => self.mesh.mesh.elevation,
            ColorBy::Slope => [0.0, 90.0],
            ColorBy::Scale => {
                let photo = self.photos.get(show.selected?)?;
                // Single spikes of the cloud would take all the colours.
                let [near, far] = [0.02, 0.98].map(|share| photo.depth_of_share(share));
                [photo.scale_at(far?), photo.scale_at(near?)]
            }
        };
        // A level surface has one value, which then is in the middle.
        let [low, high] = range;
        let least = (low.abs() + high.abs()) * 1e-6 + 1e-12;
        Some(if high - low < least {
            [low - least, high + least]
        } else {
            range
        })
    }

    /// Around everything: its middle and radius in the local frame.
    pub(crate) fn sphere(&self) -> (DVec3, f64) {
        let photos = self.photos.iter().flat_map(|photo| {
            let corners = photo.corners.iter().flatten().map(|met| met.point);
            corners.chain([photo.center])
        });
        let photos = Extent::of(photos.map(narrow));
        let extent = [self.points.extent(), self.mesh.extent(), photos]
            .into_iter()
            .flatten()
            .chain(self.beside.extents())
            .reduce(Extent::with);
        match extent {
            Some(Extent { min, max }) => {
                let radius = f64::from((max - min).length()) * 0.5;
                (((min + max) * 0.5).as_dvec3(), radius.max(1e-6))
            }
            None => (DVec3::ZERO, 1.0),
        }
    }
}

/// Cuts away what is left of and above a place.
fn without_margin(pixels: &RgbaImage, x: u32, y: u32) -> RgbaImage {
    let (width, height) = (pixels.width() - x, pixels.height() - y);
    image::imageops::crop_imm(pixels, x, y, width, height).to_image()
}
