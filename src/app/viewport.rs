//! The viewport: shows the renderer's picture, turns the mouse into commands, writes the words.
//!
//! The picture is drawn into a texture of its own, and only when something of it has changed; every
//! other frame of the window shows the same texture again.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::DVec2;

use super::command::{Command, Look};
use super::frame_times::{FrameTimes, Phase};
use super::open_flight::{Measure, OpenFlight};
use super::panels::verdict_color;
use super::state::{PictureRequest, State};
use super::work::{Done, Geometry, Task};
use crate::exports;
use crate::flight::Outcome;
use crate::picture::{Anchor, significant_digits};
use crate::render::{
    Background, Gpu, Label, PhotoGeometry, PhotoLook, Renderer, Show, View, viridis,
};
use crate::scale::ViewFacts;

/// How long the view must rest before everything is drawn.
const REST: Duration = Duration::from_millis(250);

/// Points drawn while the view moves, on a graphics card and without one. They stand for the
/// triangles too where those are more than twice as many.
const MOVING_POINTS: [usize; 2] = [2_000_000, 100_000];

/// Triangles or points drawn in one frame when the view has come to rest, likewise: the window
/// answers meanwhile.
const PORTION: [usize; 2] = [usize::MAX, 400_000];

/// The viewport with what it has uploaded.
pub struct Viewport {
    graphics: Option<Graphics>,
}

struct Graphics {
    state: RenderState,
    gpu: Gpu,
    renderer: Renderer,
    texture: Option<egui::TextureId>,
    uploaded: Uploaded,
    drawn: Option<(View, Show, [u32; 2])>,
    /// What was looked at last, and since when; `None` where that is new.
    moved: Option<(View, [u32; 2], Instant)>,
}

/// What the renderer has, to see what is new.
#[derive(Default)]
struct Uploaded {
    flight: Option<u64>,
    geometry: Option<Arc<Geometry>>,
    /// The scales and views that the photos' lines were made of.
    photos: Option<(Arc<Vec<Outcome>>, Option<Arc<Vec<Option<ViewFacts>>>>)>,
    images: Vec<bool>,
    projected: Option<(usize, u64)>,
    looks: Vec<PhotoLook>,
}

impl Viewport {
    /// With eframe's graphics device; without one it says so.
    pub fn new(state: Option<&RenderState>) -> Self {
        Self {
            graphics: state.map(|state| {
                let info = state.adapter.get_info();
                let gpu = Gpu::of_window(state.device.clone(), state.queue.clone(), &info);
                Graphics {
                    renderer: Renderer::new(&gpu),
                    state: state.clone(),
                    gpu,
                    texture: None,
                    uploaded: Uploaded::default(),
                    drawn: None,
                    moved: None,
                }
            }),
        }
    }

    /// The graphics device, for jobs to upload to.
    pub fn gpu(&self) -> Option<&Gpu> {
        self.graphics.as_ref().map(|graphics| &graphics.gpu)
    }

    /// Lets go of what was uploaded of a flight that is closed.
    pub fn clear(&mut self) {
        if let Some(graphics) = &mut self.graphics
            && graphics.uploaded.flight.is_some()
        {
            graphics.uploaded = Uploaded::default();
            graphics.renderer.clear();
            (graphics.drawn, graphics.moved) = (None, None);
        }
    }

    /// Draws the viewport and what lies on it.
    pub fn show(
        &mut self,
        state: &State,
        ui: &mut egui::Ui,
        commands: &mut Vec<Command>,
        times: &mut FrameTimes,
    ) {
        let Some(open) = &state.open else {
            return;
        };
        let place = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(place, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Viewport"));
        let pixels_per_point = f64::from(ui.ctx().pixels_per_point());
        let size = [place.width(), place.height()]
            .map(|side| ((f64::from(side) * pixels_per_point).round() as u32).max(1));
        let scene = Scene {
            place,
            pixels_per_point,
            size,
            view: view(open),
        };
        if open.looking.size != Some(scene.size()) {
            commands.push(Command::Look(Look::Resized(scene.size())));
        }
        mouse(&scene, open, ui, &response, commands);
        let show = show(state, open, ui, pixels_per_point);
        match &mut self.graphics {
            None => {
                let text = "No graphics device: install a Vulkan or OpenGL driver (on Debian mesa-vulkan-drivers)";
                let font = FontId::proportional(14.0);
                let color = ui.visuals().warn_fg_color;
                ui.painter()
                    .text(place.center(), Align2::CENTER_CENTER, text, font, color);
            }
            Some(graphics) => {
                if let Some(error) = graphics.gpu.take_error() {
                    commands.push(Command::Report(format!("graphics: {error}")));
                }
                times.end(Phase::Panels);
                graphics.upload(open, ui.visuals());
                times.end(Phase::Upload);
                graphics.draw(&scene, &show, ui);
                times.end(Phase::Draw);
                let labels = graphics.renderer.labels(&scene.view, &show, size);
                for label in &labels {
                    write(&scene, label, ui);
                }
                legend(&scene, graphics.renderer.legend(&show).as_ref(), ui);
            }
        }
        distance(&scene, open, ui);
        if open.geometry.is_none() && state.work.is_running(Task::Geometry) {
            let text = "Preparing the surface…";
            let font = FontId::proportional(14.0);
            let color = ui.visuals().weak_text_color();
            ui.painter()
                .text(place.center(), Align2::CENTER_CENTER, text, font, color);
        }
    }

    /// Draws a picture that was asked for, and has it written.
    pub fn take_picture(&mut self, state: &mut State) {
        let Some(request) = state.picture.take() else {
            return;
        };
        let (Some(graphics), Some(open)) = (&mut self.graphics, &state.open) else {
            state.apply(Command::Report(
                "no picture: there is no graphics device".to_owned(),
            ));
            return;
        };
        let PictureRequest {
            path,
            size,
            transparent,
            corner_rays,
        } = request;
        let mut layers = state.preferences.layers;
        if corner_rays {
            layers = layers.corner_ray_figure();
        }
        let mut show = layers.show(Some(open.ground()));
        show.unit = open.flight.parts().unit;
        show.selected = if corner_rays { None } else { open.selected };
        show.photo_blend = blend(open);
        // Lines as thick as in a report's figure, whatever the size.
        show.pixels_per_point = (f64::from(size[0].max(size[1])) / 1280.0).max(1.0);
        show.background = if transparent {
            Background::Transparent
        } else {
            Background::Color([255, 255, 255])
        };
        graphics.upload(open, &egui::Visuals::light());
        graphics.uploaded.looks.clear();
        let mut view = view(open);
        if let Some(seen) = open.looking.size {
            view = view.reframed(seen, DVec2::from(size.map(f64::from)));
        }
        let drawn = graphics.renderer.picture_with_words(&view, &show, size);
        graphics.drawn = None;
        let written = state.work.start(Task::Picture, move |progress| {
            progress.stage("writing the picture");
            let write = || -> Result<(), String> {
                let picture = drawn.map_err(|fault| fault.to_string())?;
                let mut bytes = std::io::Cursor::new(Vec::new());
                picture
                    .write_to(&mut bytes, image::ImageFormat::Png)
                    .map_err(|error| error.to_string())?;
                exports::write_whole(&path, bytes.get_ref()).map_err(|error| {
                    format!("it cannot be written ({error}); choose another place")
                })
            };
            let written = write().map_err(|what| format!("{}: {what}", path.display()));
            Done::Picture(written.map(|()| path))
        });
        if let Err(fault) = written {
            state.apply(Command::Report(fault.to_string()));
        }
    }
}

/// What a frame looks at.
struct Scene {
    place: Rect,
    pixels_per_point: f64,
    size: [u32; 2],
    view: View,
}

impl Scene {
    fn size(&self) -> DVec2 {
        DVec2::new(f64::from(self.size[0]), f64::from(self.size[1]))
    }

    /// A place on the screen in the viewport's own pixels.
    fn pixel(&self, at: Pos2) -> DVec2 {
        let offset = at - self.place.min;
        DVec2::new(f64::from(offset.x), f64::from(offset.y)) * self.pixels_per_point
    }

    fn screen(&self, pixel: DVec2) -> Pos2 {
        let points = pixel / self.pixels_per_point;
        self.place.min + vec2(points.x as f32, points.y as f32)
    }
}

fn view(open: &OpenFlight) -> View {
    let through = open
        .looking
        .through
        .and_then(|photo| Some((photo, open.flight.parts().photos.get(photo)?)));
    match through {
        None => open.looking.orbit.view(),
        Some((index, photo)) => {
            // The scale bar is true where the photo looks.
            let focus = open
                .view(index)
                .and_then(|view| view.height)
                .unwrap_or(open.looking.orbit.distance);
            View::of_photo(
                open.flight.camera(photo),
                &photo.pose,
                focus.abs().max(1e-6),
            )
        }
    }
}

fn blend(open: &OpenFlight) -> f64 {
    match open.looking.through {
        Some(_) => open.looking.blend,
        None => 0.0,
    }
}

fn show(state: &State, open: &OpenFlight, ui: &egui::Ui, pixels_per_point: f64) -> Show {
    let mut show = state.preferences.layers.show(Some(open.ground()));
    show.unit = open.flight.parts().unit;
    show.selected = open.selected;
    show.hovered = open.hovered_photo;
    show.photo_blend = blend(open);
    show.pixels_per_point = pixels_per_point;
    let [red, green, blue, _] = ui.visuals().extreme_bg_color.to_array();
    show.background = Background::Color([red, green, blue]);
    show
}

fn mouse(
    scene: &Scene,
    open: &OpenFlight,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) {
    let size = scene.size();
    let delta = response.drag_delta();
    let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y)) * scene.pixels_per_point;
    let shift = ui.input(|input| input.modifiers.shift);
    let moves = response.dragged_by(egui::PointerButton::Secondary)
        || response.dragged_by(egui::PointerButton::Middle)
        || (shift && response.dragged_by(egui::PointerButton::Primary));
    if delta != DVec2::ZERO {
        if moves {
            commands.push(Command::Look(Look::Pan(delta, size)));
        } else if response.dragged_by(egui::PointerButton::Primary) {
            // The same turn for the same way of the hand, whatever the screen's density.
            commands.push(Command::Look(Look::Orbit(delta / scene.pixels_per_point)));
        }
    }
    let Some(at) = response.hover_pos() else {
        if open.hover.is_some() {
            commands.push(Command::Hover(None));
        }
        return;
    };
    let cursor = scene.pixel(at);
    let ray = scene.view.ray(cursor, size);
    let (scroll, pinch, still) = ui.input(|input| {
        (
            input.smooth_scroll_delta().y,
            input.zoom_delta(),
            input.pointer.delta() == egui::Vec2::ZERO,
        )
    });
    let factor = (-f64::from(scroll) * 0.004).exp() / f64::from(pinch);
    if factor != 1.0 {
        commands.push(Command::Look(Look::Zoom {
            cursor,
            size,
            factor,
        }));
    }
    if response.double_clicked() {
        commands.push(Command::DoubleClick(ray));
    } else if response.clicked() {
        commands.push(Command::Click(ray));
    } else if !still && !response.dragged() {
        commands.push(Command::Hover(Some(ray)));
    }
}

impl Graphics {
    /// Uploads what is new.
    fn upload(&mut self, open: &OpenFlight, visuals: &egui::Visuals) {
        let uploaded = &mut self.uploaded;
        if uploaded.flight != Some(open.number) {
            *uploaded = Uploaded {
                flight: Some(open.number),
                images: vec![false; open.images.len()],
                ..Uploaded::default()
            };
            self.renderer.start(&open.frame);
            self.drawn = None;
        }
        let same_geometry = match (&uploaded.geometry, &open.geometry) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        if !same_geometry {
            uploaded.geometry.clone_from(&open.geometry);
            let geometry = open.geometry.as_deref();
            let cloud = geometry.map(|geometry| geometry.cloud.clone());
            self.renderer.set_cloud_buffers(cloud);
            let mesh = geometry.map(|geometry| geometry.mesh.clone());
            self.renderer.set_mesh_buffers(mesh);
            (self.drawn, self.moved) = (None, None);
        }
        let same_photos = uploaded.photos.as_ref().is_some_and(|(outcomes, views)| {
            Arc::ptr_eq(outcomes, &open.outcomes)
                && match (views, &open.views) {
                    (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                    (None, None) => true,
                    _ => false,
                }
        });
        if !same_photos {
            uploaded.photos = Some((open.outcomes.clone(), open.views.clone()));
            let photos = open.flight.parts().photos.iter().enumerate();
            let photos = photos.map(|(index, photo)| {
                PhotoGeometry::new(
                    &open.frame,
                    open.flight.camera(photo),
                    &photo.pose,
                    open.scale(index),
                    open.view(index),
                )
            });
            self.renderer.set_photos(photos.collect());
            uploaded.looks.clear();
            (self.drawn, self.moved) = (None, None);
        }
        let looks: Vec<PhotoLook> = open
            .judged
            .iter()
            .enumerate()
            .map(|(photo, _)| {
                let color = match open.verdict(photo) {
                    Some(verdict) => verdict_color(verdict, visuals),
                    None => visuals.text_color(),
                };
                let [red, green, blue, _] = color.to_array();
                PhotoLook {
                    visible: true,
                    color: [red, green, blue],
                }
            })
            .collect();
        if uploaded.looks != looks {
            self.renderer.set_looks(&looks);
            uploaded.looks = looks;
            self.drawn = None;
        }
        for (index, image) in open.images.iter().enumerate() {
            if let Some(image) = image
                && !uploaded.images[index]
            {
                self.renderer.set_photo_image(index, image);
                uploaded.images[index] = true;
                self.drawn = None;
            }
        }
        let preview = open
            .preview
            .as_ref()
            .filter(|preview| Some(preview.photo) == open.selected);
        let projected = preview.map(|preview| (preview.photo, preview.number));
        if uploaded.projected != projected {
            uploaded.projected = projected;
            let picture = preview.and_then(|preview| {
                let picture = preview.picture.as_ref().ok()?;
                Some((preview.photo, picture.projected.clone()?))
            });
            self.renderer.set_uploaded_photo(picture);
            self.drawn = None;
        }
    }

    /// Draws the scene where it has changed, and shows it.
    fn draw(&mut self, scene: &Scene, show: &Show, ui: &egui::Ui) {
        let mut show = show.clone();
        let now = Instant::now();
        let rests_since = match self.moved {
            Some((view, size, since)) if view == scene.view && size == scene.size => since,
            _ => now,
        };
        self.moved = Some((scene.view, scene.size, rests_since));
        let software = usize::from(self.gpu.software);
        let points = self.uploaded.geometry.as_deref();
        let points = points.map_or(0, |geometry| geometry.points);
        let many = points > MOVING_POINTS[software];
        if many && now.duration_since(rests_since) < REST {
            show.max_points = Some(MOVING_POINTS[software]);
            show.wireframe = false;
            ui.ctx().request_repaint_after(REST);
        }
        let wanted = (scene.view, show, scene.size);
        if self.drawn.as_ref() != Some(&wanted) {
            let portion = PORTION[software];
            let drawn = self
                .renderer
                .draw_portion(&wanted.0, &wanted.1, scene.size, portion);
            if !drawn.whole {
                ui.ctx().request_repaint();
            }
            if let Some(view) = self.renderer.color_view() {
                let mut renderer = self.state.renderer.write();
                let device = &self.state.device;
                let nearest = eframe::wgpu::FilterMode::Nearest;
                match self.texture {
                    None => {
                        self.texture =
                            Some(renderer.register_native_texture(device, view, nearest));
                    }
                    Some(texture) if drawn.new_texture => {
                        renderer
                            .update_egui_texture_from_wgpu_texture(device, view, nearest, texture);
                    }
                    Some(_) => {}
                }
            }
            self.drawn = drawn.whole.then_some(wanted);
        }
        if let Some(texture) = self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            ui.painter()
                .image(texture, scene.place, whole, Color32::WHITE);
        }
    }
}

fn write(scene: &Scene, label: &Label, ui: &egui::Ui) {
    let anchor = match label.anchor {
        Anchor::TopLeft => Align2::LEFT_TOP,
        Anchor::TopMiddle => Align2::CENTER_TOP,
        Anchor::TopRight => Align2::RIGHT_TOP,
        Anchor::MiddleLeft => Align2::LEFT_CENTER,
        Anchor::Middle => Align2::CENTER_CENTER,
        Anchor::MiddleRight => Align2::RIGHT_CENTER,
        Anchor::BottomLeft => Align2::LEFT_BOTTOM,
        Anchor::BottomMiddle => Align2::CENTER_BOTTOM,
        Anchor::BottomRight => Align2::RIGHT_BOTTOM,
    };
    let [red, green, blue] = label.color;
    let painter = ui.painter().with_clip_rect(scene.place);
    let (at, font) = (scene.screen(label.at), FontId::proportional(13.0));
    // A halo, because what lies behind may be of any colour.
    let bright = u16::from(red) + u16::from(green) + u16::from(blue) > 382;
    let halo = if bright {
        Color32::from_black_alpha(170)
    } else {
        Color32::from_white_alpha(190)
    };
    for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
        painter.text(at + vec2(x, y), anchor, &label.text, font.clone(), halo);
    }
    painter.text(
        at,
        anchor,
        &label.text,
        font,
        Color32::from_rgb(red, green, blue),
    );
}

/// What the colours mean.
fn legend(scene: &Scene, legend: Option<&crate::render::Legend>, ui: &egui::Ui) {
    let Some(legend) = legend else {
        return;
    };
    let (width, height) = (12.0, (scene.place.height() * 0.35).min(180.0));
    let foot = scene.place.right_center() + vec2(-width - 64.0, height / 2.0);
    let bar = Rect::from_min_size(foot - vec2(0.0, height), vec2(width, height));
    let painter = ui.painter().with_clip_rect(scene.place);
    const STEPS: u8 = 48;
    for step in 0..STEPS {
        let share = f32::from(step) / f32::from(STEPS);
        let y = bar.bottom() - share * height;
        let stripe = Rect::from_min_max(
            pos2(bar.left(), y - height / f32::from(STEPS) - 0.5),
            pos2(bar.right(), y),
        );
        let [red, green, blue] = viridis(f64::from(share));
        painter.rect_filled(stripe, 0.0, Color32::from_rgb(red, green, blue));
    }
    let color = ui.visuals().text_color();
    let font = FontId::proportional(12.0);
    for (value, y) in [
        (legend.range[1], bar.top()),
        (legend.range[0], bar.bottom()),
    ] {
        let text = significant_digits(value, 4);
        let at = pos2(bar.right() + 5.0, y);
        painter.text(at, Align2::LEFT_CENTER, text, font.clone(), color);
    }
    let at = pos2(bar.center().x, bar.top() - 8.0);
    painter.text(at, Align2::CENTER_BOTTOM, &legend.title, font, color);
}

/// The points and the line of the distance tool.
fn distance(scene: &Scene, open: &OpenFlight, ui: &egui::Ui) {
    let (first, second) = match open.measure {
        Measure::Off | Measure::First => return,
        Measure::Second(first) => (first, None),
        Measure::Both(first, second) => (first, Some(second)),
    };
    let size = scene.size();
    let painter = ui.painter().with_clip_rect(scene.place);
    let color = Color32::from_rgb(255, 90, 200);
    let places: Vec<Pos2> = [Some(first), second]
        .into_iter()
        .flatten()
        .filter_map(|point| scene.view.project(point, size))
        .map(|pixel| scene.screen(pixel))
        .collect();
    if let ([a, b], Some(second)) = (&places[..], second) {
        painter.line_segment([*a, *b], Stroke::new(2.0, color));
        let text = format!(
            "{} {}",
            significant_digits(first.distance(second), 4),
            open.flight.parts().unit
        );
        let at = a.lerp(*b, 0.5);
        let galley = painter.layout_no_wrap(text, FontId::proportional(14.0), Color32::WHITE);
        let back = Rect::from_center_size(at - vec2(0.0, 14.0), galley.size()).expand(3.0);
        painter.rect_filled(back, 3.0, Color32::from_black_alpha(180));
        painter.galley(back.shrink(3.0).min, galley, Color32::WHITE);
    }
    for place in places {
        painter.circle(place, 4.0, color, Stroke::new(1.0, Color32::WHITE));
    }
}
