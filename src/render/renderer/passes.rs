//! The passes that a frame is drawn in (see [`super`]).

use glam::{DMat4, DVec2, DVec3, DVec4};
use wgpu::CommandEncoder;

use super::Renderer;
use super::part::{Most, Part, pair};
use super::pass::{depth, is_in_sight, opaque, pass};
use super::sight::Sight;
use super::targets::{SurfaceTarget, Targets};
use crate::furniture;
use crate::furniture::crowd::{LEAST_PLANE, presence};
use crate::furniture::photo_lines::{camera_depth, fill_colors, ink, photo_lines};
use crate::geometry::LocalFrame;
use crate::picture::VIRIDIS_STOPS;
use crate::primitives::fill::{CellCorner, Pyramid};
use crate::primitives::frame::FrameUniform;
use crate::primitives::images::Place;
use crate::primitives::lines::StrokeBuffer;
use crate::scene::photo_geometry::PhotoGeometry;
use crate::scene::{Extent, narrow, narrow_matrix, narrow_number};
use crate::show::{Background, ColorBy, Show};
use crate::streamed::Looking;
use crate::view::{Projection, View};

impl Renderer {
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

    /// Draws a part of a picture, of the surface about as much as `most` says where that will do.
    /// Returns whether the surface is whole, and whether points of it are on their way.
    pub(crate) fn draw_part(
        &mut self,
        targets: &mut Targets,
        view: &View,
        show: &Show,
        part: Part,
        most: Most,
    ) -> [bool; 2] {
        let (middle, radius) = self.sphere();
        let whole = pair(part.of);
        let samples = f64::from(targets.samples);
        let eye = self.frame.local_from_world(view.eye);
        let axis = view.world_from_view.z_axis;
        let (near, far) = if view.is_parallel() {
            let distance = (middle - eye).dot(axis);
            (distance - 2.0 * radius, distance + 2.0 * radius)
        } else {
            // Vulkan's depths are exact however near this is; OpenGL's, from -1 to 1, are not.
            let outside = eye.distance(middle) - radius;
            ((view.focus * 0.01).max(outside * 0.5), f64::INFINITY)
        };
        let view_from_world = view.world_from_view.transpose();
        let view_from_local = DMat4::from_cols(
            view_from_world.x_axis.extend(0.0),
            view_from_world.y_axis.extend(0.0),
            view_from_world.z_axis.extend(0.0),
            (-(view_from_world * eye)).extend(1.0),
        );
        let clip_of_whole = view.clip_from_view(whole, near, far) * view_from_local;
        let clip_from_local = part.crop() * clip_of_whole;
        let sight = narrow_matrix(clip_from_local);
        let in_sight = |extent: &Extent| is_in_sight(&sight, extent);

        let texel = 1.0 / (view.pixels_per_unit(whole, 1.0) * samples);
        // The same points for all parts, so that there are no seams.
        let sight_of_whole = narrow_matrix(clip_of_whole);
        let looking = Looking {
            eye,
            ahead: axis,
            parallel: view.is_parallel(),
            texel,
            // Half a pixel.
            fine: 0.5 * samples,
            nearest: near.max(radius * 1e-6),
            in_sight: &|extent| is_in_sight(&sight_of_whole, extent),
            clip: show.clip,
        };
        let present = self.points.look(&looking, show.max_points, most);
        let share = self.points.share(show.max_points, &in_sight);
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
        let nearest_seen = selected.and_then(|photo| photo.depth_of_share(0.0));
        let photo_near = nearest_seen.unwrap_or(radius) * 0.05;
        let background = match show.background {
            Background::Color(color) => opaque(color),
            Background::Transparent => [0.0; 4],
        };
        let image_from_local = selected.map_or(DMat4::ZERO, PhotoGeometry::image_from_local);
        let [box_middle, box_half, box_turn] = clip_box(show, &self.frame);
        let main = FrameUniform {
            clip_from_local: sight.to_cols_array_2d(),
            local_from_clip: narrow_matrix(clip_from_local.inverse()).to_cols_array_2d(),
            image_from_local: narrow_matrix(image_from_local).to_cols_array_2d(),
            background,
            ink: opaque(ink(show)),
            eye: if view.is_parallel() {
                narrow(-axis).extend(0.0)
            } else {
                narrow(eye).extend(1.0)
            }
            .to_array(),
            box_middle,
            box_half,
            box_turn,
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
                narrow_number(near)
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
            least: narrow_number(present.least.min(40.0 * samples)),
            viridis: VIRIDIS_STOPS.map(opaque),
        };
        let queue = &self.gpu.queue;
        self.main_frame.write(queue, &main);
        self.write_beside(&main, show);
        let pixels = part.crop()
            * DMat4::from_cols(
                DVec4::new(2.0 / whole.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, -2.0 / whole.y, 0.0, 0.0),
                DVec4::Z,
                DVec4::new(-1.0, 1.0, 0.0, 1.0),
            );
        let screen = FrameUniform {
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
        let stands_for_mesh = too_many || (show.mesh && self.points.is_streamed());
        let shapes = [show.mesh && !too_many, show.cloud || stands_for_mesh];
        // 0 is for nothing of that kind.
        let version = [
            self.version,
            if project { self.photo_version } else { 0 },
            if show.beside {
                self.beside.version + 1
            } else {
                0
            },
        ];
        let sight = Sight::new(&main, show.color_by, version, shapes, (share, present.key));
        let shown = targets.surface.sight.as_ref();
        let mut complete = shown == Some(&sight);
        if !complete {
            let stands_in = shown.is_some_and(|shown| shown.same_view(&sight));
            if targets.next.sight.as_ref() != Some(&sight) {
                targets.next.begin(sight);
            }
            let most = match most {
                Most::Portion(most) if stands_in => most,
                _ => usize::MAX,
            };
            self.draw_surface(&mut encoder, &mut targets.next, most, show, &in_sight);
            complete = targets.next.is_whole();
            if complete {
                std::mem::swap(&mut targets.surface, &mut targets.next);
            }
        }
        self.draw_relief(&mut encoder, targets);
        self.draw_fills(&mut encoder, targets, show, looked_through);
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
        [complete, present.awaited]
    }

    /// How deep the selected photo sees, where that is not known yet.
    fn draw_photo_depth(
        &mut self,
        encoder: &mut CommandEncoder,
        selected: Option<usize>,
        main: &FrameUniform,
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
        let frame = FrameUniform {
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
        show: &Show,
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
        if show.beside && target.is_whole() {
            self.draw_beside(&mut pass, show.max_points, in_sight);
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

    /// The photos that have their fill drawn: not the one that is laid over, whose own colours count.
    fn filled<'a>(
        &'a self,
        show: &'a Show,
        looked_through: Option<usize>,
    ) -> impl Iterator<Item = (&'a PhotoGeometry, [[u8; 4]; 2])> {
        let is_laid_over = show.project_photo && self.surface_photo.index == show.selected
            || show.photo_blend > 0.0 && self.surface_photo.index == looked_through;
        let laid_over = self.surface_photo.index.filter(|_| is_laid_over);
        let photos = self.photos.iter().zip(&self.looks).enumerate();
        photos
            .filter(move |(index, _)| laid_over != Some(*index))
            .filter(|(index, (_, look))| look.visible && show.fills.holds(*index, show))
            .map(|(index, (photo, look))| (photo, fill_colors(*look, show.selected == Some(index))))
    }

    /// Tints what is inside footprints, on the surface.
    fn draw_fills(
        &self,
        encoder: &mut CommandEncoder,
        targets: &Targets,
        show: &Show,
        looked_through: Option<usize>,
    ) {
        let pyramids: Vec<Pyramid> = self
            .filled(show, looked_through)
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
        // What is measured follows the mouse; the photos' lines do not depend on it.
        let wanted = (show.without_marks(), looked_through);
        if self.strokes_for.as_ref() != Some(&wanted) {
            let strokes = photo_lines(
                &self.photos,
                &self.line,
                &self.looks,
                show,
                cameras,
                looked_through,
            );
            self.strokes = StrokeBuffer::new(device, &strokes);
            self.strokes_for = Some(wanted);
        }
        let grid = show.ground.map_or_else(Vec::new, |ground| {
            let (middle, radius) = self.bulk.unwrap_or((overlay.middle, overlay.radius));
            furniture::ground_grid(
                ground - self.frame.origin().z,
                middle,
                radius,
                self.frame.origin(),
                show,
            )
        });
        let grid = StrokeBuffer::new(device, &grid);
        let mut on_screen = furniture::on_screen(view, show, overlay.whole);
        if let Some(photo) = looked_through.and_then(|index| self.photos.get(index)) {
            let edge = furniture::image_edge::strokes(view, photo, overlay.whole, show);
            on_screen.splice(0..0, edge);
        }
        let on_screen = StrokeBuffer::new(device, &on_screen);
        let presence = presence(&self.photos, show);
        let planes: Vec<(u32, [DVec3; 4])> = self
            .photos
            .iter()
            .zip(&self.looks)
            .enumerate()
            .filter(|(index, (_, look))| {
                let is_wanted = look.visible && show.images.holds(*index, show);
                is_wanted && looked_through != Some(*index) && presence[*index] >= LEAST_PLANE
            })
            .filter_map(|(index, (photo, _))| {
                Some((self.images.number(index)?, photo.image_plane(cameras)))
            })
            .collect();
        let cells: Vec<CellCorner> = self
            .filled(show, looked_through)
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

/// The clipping box for the shaders: its middle, half of its edges, its turn and whether it is on.
fn clip_box(show: &Show, frame: &LocalFrame) -> [[f32; 4]; 3] {
    show.clip.map_or([[0.0; 4]; 3], |clip| {
        let (sin, cos) = clip.turn.sin_cos();
        [
            narrow(frame.local_from_world(clip.middle())).extend(0.0),
            narrow(clip.half()).extend(0.0),
            narrow(DVec3::new(cos, sin, 1.0)).extend(0.0),
        ]
        .map(|row| row.to_array())
    })
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
