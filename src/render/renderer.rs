//! Drawing a frame.

use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, Vec3};
use image::RgbaImage;
use wgpu::{
    CommandEncoder, RenderPassColorAttachment, RenderPassDepthStencilAttachment, TextureView,
};

use super::colormap::STOPS;
use super::cover::Cover;
use super::edl::edl;
use super::fill::{CellCorner, Fill, Pyramid};
use super::frame::{Frame, FrameBinding, frame_layout};
use super::furniture;
use super::gpu::Gpu;
use super::images::{Images, Place};
use super::labels::{Label, Legend, ScaleBar};
use super::lines::{Lines, StrokeBuffer};
use super::mesh::{Mesh, MeshBuffers};
use super::photo_image::PhotoImage;
use super::photo_lines::{camera_depth, fill_colors, ink, photo_lines};
use super::points::{CloudBuffers, Points};
use super::readback::read_back;
use super::resolve::resolve;
use super::scene::{
    CloudGeometry, Extent, MeshGeometry, PhotoGeometry, narrow, narrow_matrix, narrow_number,
};
use super::show::{Background, ColorBy, PhotoLook, Show};
use super::sight::{Sight, SurfaceTarget};
use super::surface::{LargePhoto, SurfacePhoto};
use super::targets::Targets;
use super::view::{Projection, View};
use super::words::write_words;
use crate::fault::Fault;
use crate::geometry::{Bounds, LocalFrame};

/// More texels than this are too many to draw again and again: then a pixel has one sample.
const MOST_SAMPLED_TEXELS: u64 = 1 << 24;
/// Pixels that parts of a large picture overlap by, so that relief has no seams.
const OVERLAP: u32 = 16;

/// Draws a flight. Holds what was uploaded and the textures of the last frame.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    frame: LocalFrame,
    points: Points,
    mesh: Mesh,
    photos: Vec<PhotoGeometry>,
    looks: Vec<PhotoLook>,
    surface_photo: SurfacePhoto,
    images: Images,
    lines: Lines,
    fill: Fill,
    edl: Cover,
    resolve: Cover,
    main_frame: FrameBinding,
    screen_frame: FrameBinding,
    photo_frame: FrameBinding,
    /// The photos' lines, and what they were made for.
    strokes: StrokeBuffer,
    strokes_for: Option<(Show, Option<usize>)>,
    /// Which photo the depths in `surface_photo` are of.
    depth_of: Option<usize>,
    /// Counts what was uploaded of the surface.
    version: u64,
    /// Counts the photos to lay on it.
    photo_version: u64,
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
    /// Whether the surface is whole; else an earlier picture of it still stands in.
    pub whole: bool,
}

/// A part of a picture, in pixels of the whole.
#[derive(Debug, Clone, Copy)]
struct Part {
    origin: [u32; 2],
    size: [u32; 2],
    of: [u32; 2],
}

impl Part {
    fn whole(size: [u32; 2]) -> Self {
        Self {
            origin: [0, 0],
            size,
            of: size,
        }
    }

    /// Clip space of the whole to that of the part.
    fn crop(&self) -> DMat4 {
        let of = pair(self.of) / pair(self.size);
        let shift = pair(self.origin) * 2.0 / pair(self.size);
        DMat4::from_cols(
            DVec4::new(of.x, 0.0, 0.0, 0.0),
            DVec4::new(0.0, of.y, 0.0, 0.0),
            DVec4::Z,
            DVec4::new(of.x - shift.x - 1.0, 1.0 - of.y + shift.y, 0.0, 1.0),
        )
    }
}

fn pair([x, y]: [u32; 2]) -> DVec2 {
    DVec2::new(f64::from(x), f64::from(y))
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
            photos: Vec::new(),
            looks: Vec::new(),
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
        self.set_cloud(None);
        self.set_mesh(None);
        self.set_photos(Vec::new());
        self.images.clear();
        self.set_projected_photo(None);
    }

    /// Uploads the cloud, or takes it away.
    pub fn set_cloud(&mut self, cloud: Option<&CloudGeometry>) {
        self.set_cloud_buffers(cloud.map(|cloud| CloudBuffers::new(&self.gpu, cloud)));
    }

    /// Takes a cloud that is uploaded already, or takes it away.
    pub fn set_cloud_buffers(&mut self, cloud: Option<CloudBuffers>) {
        self.points.cloud = cloud.unwrap_or_default();
        self.version += 1;
    }

    /// Uploads the mesh, or takes it away.
    pub fn set_mesh(&mut self, mesh: Option<&MeshGeometry>) {
        self.set_mesh_buffers(mesh.map(|mesh| MeshBuffers::new(&self.gpu, mesh)));
    }

    /// Takes a mesh that is uploaded already, or takes it away.
    pub fn set_mesh_buffers(&mut self, mesh: Option<MeshBuffers>) {
        self.mesh.mesh = mesh.unwrap_or_default();
        self.version += 1;
        self.depth_of = None;
    }

    /// The photos of the flight, in its order. Their looks become the default, their images stay.
    pub fn set_photos(&mut self, photos: Vec<PhotoGeometry>) {
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
        let whole = self.draw_part(&mut targets, view, show, Part::whole(size), most);
        let [triangles, points] = targets.surface.drawn;
        self.targets = Some(targets);
        Drawn {
            new_texture,
            points,
            triangles,
            whole,
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
                self.draw_part(&mut targets, view, show, part, usize::MAX);
                let pixels = read_back(&self.gpu, &targets.picture)?;
                self.gpu.check()?;
                image::imageops::replace(
                    &mut picture,
                    &pixels_from(&pixels, x - origin[0], y - origin[1]),
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
        let unit = show.unit.symbol();
        let title = match show.color_by {
            ColorBy::Rgb => return None,
            ColorBy::Elevation => format!("elevation ({unit})"),
            ColorBy::Slope => "slope (°)".to_owned(),
            ColorBy::Scale => format!("scale (px/{unit})"),
        };
        let range = self.range(show)?;
        Some(Legend { title, range })
    }

    /// The values at the colour map's ends.
    fn range(&self, show: &Show) -> Option<[f64; 2]> {
        let range = match show.color_by {
            ColorBy::Rgb => return None,
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
    fn sphere(&self) -> (DVec3, f64) {
        let photos = self.photos.iter().flat_map(|photo| {
            let corners = photo.corners.iter().flatten().map(|met| met.point);
            corners.chain([photo.center])
        });
        let photos = Extent::of(photos.map(narrow));
        let extent = [self.points.extent(), self.mesh.extent(), photos]
            .into_iter()
            .flatten()
            .reduce(Extent::with);
        match extent {
            Some(Extent { min, max }) => {
                let radius = f64::from((max - min).length()) * 0.5;
                (((min + max) * 0.5).as_dvec3(), radius.max(1e-6))
            }
            None => (DVec3::ZERO, 1.0),
        }
    }

    /// The photo whose camera is the eye.
    fn looked_through(&self, view: &View, radius: f64) -> Option<usize> {
        if !matches!(view.projection, Projection::Photo { .. }) {
            return None;
        }
        let eye = self.frame.local_from_world(view.eye);
        let distance = |photo: &PhotoGeometry| photo.center.distance(eye);
        let nearest = (0..self.photos.len())
            .min_by(|&a, &b| distance(&self.photos[a]).total_cmp(&distance(&self.photos[b])))?;
        (distance(&self.photos[nearest]) < radius * 1e-9).then_some(nearest)
    }

    /// Draws a part of a picture, of the surface about `most` triangles or points where that will do.
    /// Returns whether the surface is whole.
    fn draw_part(
        &mut self,
        targets: &mut Targets,
        view: &View,
        show: &Show,
        part: Part,
        most: usize,
    ) -> bool {
        let (middle, radius) = self.sphere();
        let whole = pair(part.of);
        let samples = f64::from(targets.samples);
        let eye = self.frame.local_from_world(view.eye);
        let axis = view.world_from_view.z_axis;
        let (near, far) = if view.is_parallel() {
            let distance = (middle - eye).dot(axis);
            (distance - 2.0 * radius, distance + 2.0 * radius)
        } else {
            (radius * 1e-6, f64::INFINITY)
        };
        let view_from_world = view.world_from_view.transpose();
        let view_from_local = DMat4::from_cols(
            view_from_world.x_axis.extend(0.0),
            view_from_world.y_axis.extend(0.0),
            view_from_world.z_axis.extend(0.0),
            (-(view_from_world * eye)).extend(1.0),
        );
        let clip_from_local = part.crop() * view.clip_from_view(whole, near, far) * view_from_local;
        let sight = narrow_matrix(clip_from_local);
        let in_sight = |extent: &Extent| is_in_sight(&sight, extent);

        let share = self.points.share(show.max_points, &in_sight);
        let texel = 1.0 / (view.pixels_per_unit(whole, 1.0) * samples);
        // Strokes are lifted off the surface by a few texels.
        let lift = if view.is_parallel() {
            [1.0, 3.0 * texel / (far - near)]
        } else {
            [1.0 + 3.0 * texel, 0.0]
        };
        let looked_through = self.looked_through(view, radius);
        let selected = show.selected.and_then(|index| self.photos.get(index));
        let project =
            show.project_photo && selected.is_some() && self.surface_photo.index == show.selected;
        let color_by = match show.color_by {
            ColorBy::Rgb => 0,
            ColorBy::Elevation => 1,
            ColorBy::Slope => 2,
            ColorBy::Scale => 3,
        };
        let photo_near = radius * 1e-6;
        let background = match show.background {
            Background::Color(color) => opaque(color),
            Background::Transparent => [0.0; 4],
        };
        let image_from_local = selected.map_or(DMat4::ZERO, PhotoGeometry::image_from_local);
        let main = Frame {
            clip_from_local: sight.to_cols_array_2d(),
            local_from_clip: narrow_matrix(clip_from_local.inverse()).to_cols_array_2d(),
            image_from_local: narrow_matrix(image_from_local).to_cols_array_2d(),
            background,
            ink: opaque(ink(show)),
            size: targets.sampled_size().map(|edge| edge as f32),
            depths: if view.is_parallel() {
                [narrow_number(far), narrow_number(far - near)]
            } else {
                [narrow_number(near), 0.0]
            },
            texel: narrow_number(texel),
            parallel: if view.is_parallel() { 1.0 } else { 0.0 },
            point: narrow_number(show.pixels_per_point * samples),
            nearest: if view.is_parallel() {
                0.5
            } else {
                narrow_number(near.max(view.focus * 1e-4))
            },
            lift: lift.map(narrow_number),
            range: self.range(show).unwrap_or([0.0, 1.0]).map(narrow_number),
            // On a square grid discs of 0.71 of the distance meet in the middle between diagonal
            // neighbours; clouds are less even. A sample of the points has larger gaps.
            radius: narrow_number(
                0.85 * self.points.cloud.spacing * show.point_size / share.max(0.04).sqrt(),
            ),
            photo_near: narrow_number(photo_near),
            photo_scale: selected.map_or(0.0, |photo| narrow_number(photo.scale_at(1.0))),
            elevation: narrow_number(self.frame.origin().z),
            color_by,
            project: u32::from(project),
            relief: if show.eye_dome { 0.8 } else { 0.0 },
            spare: 0.0,
            viridis: STOPS.map(opaque),
        };
        let queue = &self.gpu.queue;
        self.main_frame.write(queue, &main);
        let pixels = part.crop()
            * DMat4::from_cols(
                DVec4::new(2.0 / whole.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, -2.0 / whole.y, 0.0, 0.0),
                DVec4::Z,
                DVec4::new(-1.0, 1.0, 0.0, 1.0),
            );
        let screen = Frame {
            clip_from_local: narrow_matrix(pixels).to_cols_array_2d(),
            nearest: 0.5,
            lift: [1.0, 0.0],
            ..main
        };
        self.screen_frame.write(queue, &screen);

        let device = self.gpu.device.clone();
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("frame"),
        });
        if project || (show.color_by == ColorBy::Scale && selected.is_some()) {
            self.draw_photo_depth(&mut encoder, show.selected, &main, photo_near);
        }
        let too_many = show.max_points.is_some_and(|most| {
            show.mesh && !self.points.is_empty() && self.mesh.count(&in_sight) > 2 * most
        });
        let shapes = [show.mesh && !too_many, show.cloud || too_many];
        let version = (self.version, if project { self.photo_version } else { 0 });
        let sight = Sight::new(&main, show.color_by, version, shapes, share);
        let shown = targets.surface.sight.as_ref();
        let mut complete = shown == Some(&sight);
        if !complete {
            let stands_in = shown.is_some_and(|shown| shown.same_view(&sight));
            if targets.next.sight.as_ref() != Some(&sight) {
                targets.next.begin(sight);
            }
            let most = if stands_in { most } else { usize::MAX };
            self.draw_surface(&mut encoder, &mut targets.next, most, &in_sight);
            complete = targets.next.is_whole();
            if complete {
                std::mem::swap(&mut targets.surface, &mut targets.next);
            }
        }
        self.draw_relief(&mut encoder, targets);
        self.draw_fills(&mut encoder, targets, show);
        self.draw_overlay(
            &mut encoder,
            targets,
            &Overlay {
                view,
                show,
                whole,
                middle,
                radius,
                looked_through,
            },
            &in_sight,
        );
        if targets.samples > 1 {
            let group = self.resolve.group(&device, &[&targets.sampled]);
            let mut pass = pass(
                &mut encoder,
                "resolve",
                &targets.picture_view,
                Some(wgpu::Color::TRANSPARENT),
                None,
            );
            pass.set_bind_group(0, &self.main_frame.group, &[]);
            self.resolve.draw(&mut pass, &group);
        }
        self.gpu.queue.submit([encoder.finish()]);
        complete
    }

    /// How deep the selected photo sees, where that is not known yet.
    fn draw_photo_depth(
        &mut self,
        encoder: &mut CommandEncoder,
        selected: Option<usize>,
        main: &Frame,
        near: f64,
    ) {
        if self.depth_of == selected {
            return;
        }
        let Some(photo) = selected.and_then(|index| self.photos.get(index)) else {
            return;
        };
        self.depth_of = selected;
        let camera = &photo.camera;
        self.surface_photo
            .renew_depth(&self.gpu.device, [camera.width, camera.height]);
        // Shares of the image times depth, to clip space.
        let clip_from_image = DMat4::from_cols(
            DVec4::new(2.0, 0.0, 0.0, 0.0),
            DVec4::new(0.0, -2.0, 0.0, 0.0),
            DVec4::new(-1.0, 1.0, 0.0, 1.0),
            DVec4::new(0.0, 0.0, near, 0.0),
        );
        let clip_from_local = clip_from_image * photo.image_from_local();
        let frame = Frame {
            clip_from_local: narrow_matrix(clip_from_local).to_cols_array_2d(),
            ..*main
        };
        self.photo_frame.write(&self.gpu.queue, &frame);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("how deep the photo sees"),
            depth_stencil_attachment: Some(depth(&self.surface_photo.depth, true)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.photo_frame.group, &[]);
        self.mesh.draw_depth(&mut pass);
    }

    /// Draws the surface, or goes on with it: about `most` triangles and points.
    fn draw_surface(
        &self,
        encoder: &mut CommandEncoder,
        target: &mut SurfaceTarget,
        most: usize,
        in_sight: &impl Fn(&Extent) -> bool,
    ) {
        let begins = target.drawn == [0; 2];
        let mut pass = pass(
            encoder,
            "surface",
            &target.color,
            begins.then_some(wgpu::Color::TRANSPARENT),
            Some(depth(&target.depth, begins)),
        );
        pass.set_bind_group(0, &self.main_frame.group, &[]);
        pass.set_bind_group(1, &self.surface_photo.group, &[]);
        let share = target.sight.as_ref().map_or(1.0, |sight| sight.share);
        let mut left = most;
        if let Some(from) = target.next[0] {
            let (drawn, next) = self.mesh.draw(&mut pass, from, left, in_sight);
            target.next[0] = next;
            target.drawn[0] += drawn;
            left = left.saturating_sub(drawn);
        }
        if let Some(from) = target.next[1] {
            let (drawn, next) = self.points.draw(&mut pass, share, from, left, in_sight);
            target.next[1] = next;
            target.drawn[1] += drawn;
        }
    }

    fn draw_relief(&self, encoder: &mut CommandEncoder, targets: &Targets) {
        let group = self.edl.group(
            &self.gpu.device,
            &[&targets.surface.color, &targets.surface.depth],
        );
        let mut pass = pass(
            encoder,
            "edl",
            &targets.sampled,
            Some(wgpu::Color::TRANSPARENT),
            Some(depth(&targets.depth, true)),
        );
        pass.set_bind_group(0, &self.main_frame.group, &[]);
        self.edl.draw(&mut pass, &group);
    }

    /// The photos that have their fill drawn.
    fn filled<'a>(
        &'a self,
        show: &'a Show,
    ) -> impl Iterator<Item = (&'a PhotoGeometry, [[u8; 4]; 2])> {
        let photos = self.photos.iter().zip(&self.looks).enumerate();
        photos
            .filter(|(index, (_, look))| look.visible && show.fills.holds(*index, show))
            .map(|(index, (photo, look))| (photo, fill_colors(*look, show.selected == Some(index))))
    }

    /// Tints what is inside footprints, on the surface.
    fn draw_fills(&self, encoder: &mut CommandEncoder, targets: &Targets, show: &Show) {
        let pyramids: Vec<Pyramid> = self
            .filled(show)
            .filter_map(|(photo, [color, _])| Pyramid::new(photo, color))
            .collect();
        if pyramids.is_empty() {
            return;
        }
        let group = self.fill.group(&self.gpu.device, &targets.surface.depth);
        let mut pass = pass(encoder, "fill", &targets.sampled, None, None);
        pass.set_bind_group(0, &self.main_frame.group, &[]);
        self.fill
            .draw(&self.gpu.device, &mut pass, &group, &pyramids);
    }

    fn draw_overlay(
        &mut self,
        encoder: &mut CommandEncoder,
        targets: &Targets,
        overlay: &Overlay<'_>,
        in_sight: &impl Fn(&Extent) -> bool,
    ) {
        let Overlay {
            view,
            show,
            looked_through,
            ..
        } = *overlay;
        let device = &self.gpu.device;
        let cameras = camera_depth(&self.photos, overlay.radius) * show.frustum_size;
        let wanted = (show.clone(), looked_through);
        if self.strokes_for.as_ref() != Some(&wanted) {
            let strokes = photo_lines(&self.photos, &self.looks, show, cameras, looked_through);
            self.strokes = StrokeBuffer::new(device, &strokes);
            self.strokes_for = Some(wanted);
        }
        let grid = show.ground.map_or_else(Vec::new, |ground| {
            furniture::ground_grid(
                ground - self.frame.origin().z,
                overlay.middle,
                overlay.radius,
                self.frame.origin(),
                show,
            )
        });
        let grid = StrokeBuffer::new(device, &grid);
        let on_screen = furniture::on_screen(view, show, overlay.whole);
        let on_screen = StrokeBuffer::new(device, &on_screen);
        let planes: Vec<(u32, [DVec3; 4])> = self
            .photos
            .iter()
            .zip(&self.looks)
            .enumerate()
            .filter(|(index, (_, look))| {
                look.visible && show.images.holds(*index, show) && looked_through != Some(*index)
            })
            .filter_map(|(index, (photo, _))| {
                Some((self.images.number(index)?, photo.image_plane(cameras)))
            })
            .collect();
        let cells: Vec<CellCorner> = self
            .filled(show)
            .flat_map(|(photo, [_, color])| {
                let corners = photo.ground_cells.iter().flatten();
                corners.map(move |corner| CellCorner {
                    local: narrow(*corner).to_array(),
                    color,
                })
            })
            .collect();

        let mut pass = pass(
            encoder,
            "overlay",
            &targets.sampled,
            None,
            Some(depth(&targets.depth, false)),
        );
        pass.set_bind_group(0, &self.main_frame.group, &[]);
        if show.wireframe {
            self.mesh.draw_edges(&mut pass, in_sight);
        }
        self.lines.draw_front(&mut pass, &grid);
        self.fill.draw_cells(device, &mut pass, &cells);
        if show.photo_blend > 0.0
            && looked_through.is_some()
            && looked_through == self.surface_photo.index
            && let Some(photo) = looked_through.and_then(|index| self.photos.get(index))
        {
            // At any depth: it fills the photo's part of the viewport.
            let plane = photo.image_plane(view.focus);
            let group = self.images.group(device, &self.surface_photo.picture);
            let place = Place::new(plane, 0, show.photo_blend.min(1.0));
            self.images.draw_over(device, &mut pass, &group, place);
        }
        self.images.draw(device, &mut pass, &planes);
        self.lines.draw(&mut pass, &self.strokes);
        pass.set_bind_group(0, &self.screen_frame.group, &[]);
        self.lines.draw_over(&mut pass, &on_screen);
    }
}

/// What [`Renderer::draw_overlay`] goes by.
struct Overlay<'a> {
    view: &'a View,
    show: &'a Show,
    /// The whole picture's size.
    whole: DVec2,
    /// Of everything.
    middle: DVec3,
    /// Of everything.
    radius: f64,
    looked_through: Option<usize>,
}

/// Cuts away what is left of and above a place.
fn pixels_from(pixels: &RgbaImage, x: u32, y: u32) -> RgbaImage {
    let (width, height) = (pixels.width() - x, pixels.height() - y);
    image::imageops::crop_imm(pixels, x, y, width, height).to_image()
}

fn opaque([r, g, b]: [u8; 3]) -> [f32; 4] {
    [
        f32::from(r) / 255.0,
        f32::from(g) / 255.0,
        f32::from(b) / 255.0,
        1.0,
    ]
}

/// Whether any of a box may be in the picture: not where all of its corners are beyond one side.
fn is_in_sight(clip_from_local: &Mat4, extent: &Extent) -> bool {
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| {
        let pick = |bit: i32, low: f32, high: f32| if i & bit == 0 { low } else { high };
        let (min, max) = (extent.min, extent.max);
        let corner = Vec3::new(
            pick(1, min.x, max.x),
            pick(2, min.y, max.y),
            pick(4, min.z, max.z),
        );
        *clip_from_local * corner.extend(1.0)
    });
    // A point of a cloud is wider than its place: a tenth of the picture more on each side.
    let beyond = [
        corners.iter().all(|c| c.x < -1.1 * c.w),
        corners.iter().all(|c| c.x > 1.1 * c.w),
        corners.iter().all(|c| c.y < -1.1 * c.w),
        corners.iter().all(|c| c.y > 1.1 * c.w),
        corners.iter().all(|c| c.w <= 0.0),
    ];
    !beyond.contains(&true)
}

fn depth(view: &TextureView, clear: bool) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            // Reverse-z: infinitely far.
            load: if clear {
                wgpu::LoadOp::Clear(0.0)
            } else {
                wgpu::LoadOp::Load
            },
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

fn pass<'a>(
    encoder: &'a mut CommandEncoder,
    label: &str,
    color: &TextureView,
    clear: Option<wgpu::Color>,
    depth: Option<RenderPassDepthStencilAttachment<'_>>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: depth,
        ..Default::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{Normals, Orbit};

    /// A heap of 20 units with a grid under it, which reach over every seam; `cells` along an edge.
    fn heap(gpu: &Gpu, cells: u32) -> (Renderer, Orbit) {
        let mut vertices = Vec::new();
        let mut triangles = Vec::new();
        for row in 0..=cells {
            for column in 0..=cells {
                let [x, y] = [column, row].map(|i| f64::from(i) * 20.0 / f64::from(cells) - 10.0);
                vertices.push(DVec3::new(x, y, 4.0 * (-(x * x + y * y) / 30.0).exp()));
                if row < cells && column < cells {
                    let at = row * (cells + 1) + column;
                    triangles.push([at, at + 1, at + cells + 2]);
                    triangles.push([at, at + cells + 2, at + cells + 1]);
                }
            }
        }
        let bounds = Bounds::of(&vertices).unwrap();
        let frame = LocalFrame::near(&bounds);
        let normals = Normals::of(&frame, vertices.iter().copied(), &triangles);
        let points = vertices.iter().copied();
        let mesh = MeshGeometry::new(&frame, points, &[], &normals, &triangles);
        let mut renderer = Renderer::new(gpu);
        renderer.start(&frame);
        renderer.set_mesh(Some(&mesh));
        (renderer, Orbit::new(&bounds))
    }

    /// A picture put together from parts has no seams: it is the one drawn at once.
    #[test]
    fn parts_make_the_whole() {
        let gpu = Gpu::headless().unwrap();
        let (mut renderer, mut orbit) = heap(&gpu, 40);
        let show = Show {
            ground: Some(0.0),
            wireframe: true,
            ..Show::default()
        };
        for orthographic in [false, true] {
            orbit.orthographic = orthographic;
            let view = orbit.view();
            let whole = renderer.picture(&view, &show, [301, 203]).unwrap();
            let parts = renderer
                .picture_in_parts(&view, &show, [301, 203], 100)
                .unwrap();
            let differ = whole
                .pixels()
                .zip(parts.pixels())
                .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 24));
            // A thin line's edge may be rounded to another texel.
            assert!(differ.count() < 30);
        }
        assert_eq!(gpu.take_error(), None);
    }

    /// The window's frame and a file's picture come from the same call: with one sample a pixel they
    /// show the same.
    #[test]
    fn a_frame_in_the_window_is_read_back_as_drawn() {
        let gpu = Gpu::headless().unwrap();
        let (mut renderer, orbit) = heap(&gpu, 40);
        let show = Show::default();
        renderer.draw(&orbit.view(), &show, [120, 80]);
        let frame = read_back(&gpu, &renderer.targets.as_ref().unwrap().picture).unwrap();
        let picture = renderer.picture(&orbit.view(), &show, [120, 80]).unwrap();
        let pairs = frame.pixels().zip(picture.pixels());
        let unlike = pairs.filter(|(a, b)| {
            a.0[..3]
                .iter()
                .zip(&b.0[..3])
                .any(|(a, b)| a.abs_diff(*b) > 60)
        });
        // Only edges differ, by their smoothness.
        assert!(unlike.count() < 400);
        // The heap is in the middle, the background in the corner.
        assert_eq!(frame.get_pixel(119, 0).0, [24, 26, 30, 255]);
        assert!(frame.get_pixel(60, 45)[0] > 90);
    }

    /// A large surface drawn in portions ends as the one drawn at once; until then the picture before
    /// it stands in.
    #[test]
    fn portions_make_the_whole() {
        let gpu = Gpu::headless().unwrap();
        let size = [160, 120];
        let frame = |renderer: &Renderer| {
            read_back(&gpu, &renderer.targets.as_ref().unwrap().picture).unwrap()
        };
        let (mut at_once, orbit) = heap(&gpu, 400);
        let view = orbit.view();
        let slope = Show {
            color_by: ColorBy::Slope,
            ..Show::default()
        };
        assert!(at_once.draw(&view, &slope, size).whole);
        let expected = frame(&at_once);

        let (mut renderer, _) = heap(&gpu, 400);
        renderer.draw(&view, &Show::default(), size);
        let before = frame(&renderer);
        assert!(before != expected);
        let mut calls = 1;
        while !renderer.draw_portion(&view, &slope, size, 1).whole {
            assert!(frame(&renderer) == before);
            calls += 1;
        }
        // 320 000 triangles in tiles of at most 65 536.
        assert!(calls >= 5, "{calls}");
        assert!(frame(&renderer) == expected);
        // From elsewhere nothing can stand in.
        let mut other = orbit;
        other.orbit(DVec2::new(100.0, 0.0));
        assert!(renderer.draw_portion(&other.view(), &slope, size, 1).whole);
        assert_eq!(gpu.take_error(), None);
    }
}
