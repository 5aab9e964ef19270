//! The viewport: shows the renderer's picture, turns the mouse into commands, writes the words.
//!
//! The picture is drawn into a texture of its own, and only when something of it has changed; every
//! other frame of the window shows the same texture again.

mod clip_handles;
mod crops;
mod drawn;
mod graphics;
mod mouse;
mod planned;
mod preview;
mod words;

use eframe::egui_wgpu::RenderState;
use egui::{Align2, FontId, Pos2, Rect, Sense, vec2};
use glam::DVec2;

use crate::command::{Command, PictureRequest, ViewChange};
use crate::frame_times::{FrameTimes, Phase};
use crate::linked::PointFrom;
use crate::open_flight::OpenFlight;
use crate::panels::{described, linked};
use crate::render::{Background, Gpu, Renderer, Show, View};
use crate::size_distributions::Page;
use crate::state::State;
use crate::tasks::Task;
use clip_handles::clip_handles;
use drawn::{show_drawn, show_picked};
use graphics::{Graphics, Uploaded};
use mouse::mouse;
use words::{legend, write};

/// The viewport with what it has uploaded.
pub struct Viewport {
    graphics: Option<Graphics>,
    crops: crops::Drawn,
}

impl Viewport {
    /// With eframe's graphics device; without one it says so.
    pub fn new(state: Option<&RenderState>) -> Self {
        Self {
            crops: crops::Drawn::default(),
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
            && (graphics.uploaded.flight.is_some() || graphics.uploaded.preview.is_some())
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
        described(&response, || in_words(state, open));
        let pixels_per_point = f64::from(ui.ctx().pixels_per_point());
        let size = [place.width(), place.height()]
            .map(|side| ((f64::from(side) * pixels_per_point).round() as u32).max(1));
        let scene = Scene {
            place,
            pixels_per_point,
            size,
            view: state.view(open),
        };
        if open.looking.size != Some(scene.size()) {
            commands.push(Command::View(ViewChange::Resized(scene.size())));
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
                if graphics.gpu.take_lost_frame() {
                    ui.ctx().request_repaint();
                }
                times.end(Phase::Panels);
                graphics.upload(state, open, ui.visuals());
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
        match state.page {
            Page::Plan => {
                planned::frame(open, &scene, ui);
                planned::handles(open, &scene, ui, commands);
            }
            _ => clip_handles(open, &scene, ui, commands),
        }
        point(state, open, &scene, ui, &response, commands);
        if open.geometry.is_none() && state.work.is_running(Task::GEOMETRY) {
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
            to,
            size,
            transparent,
            corner_rays,
        } = request;
        let mut layers = state.preferences.layers;
        if corner_rays {
            layers = layers.corner_ray_figure();
        }
        let mut show = layers.show(Some(open.ground()));
        show.unit = open.flight().parts().unit;
        show.lengths_in = open.flight().parts().unit_of_lengths();
        show.scale_unit = Some(state.preferences.unit());
        show.color_limits = open.colors.limits(show.color_by);
        show.clip = open.clip.clipping();
        show.beside = true;
        if !corner_rays {
            show.measured = open.pointer.measure.points(open.pointer.hover);
            show_picked(open, &mut show);
            show_drawn(open, &mut show);
        }
        show.selected = if corner_rays { None } else { open.selected };
        show.photo_blend = blend(open);
        if state.page == Page::Plan {
            planned::show_planned(open, &mut show);
        }
        // Lines as thick as in a report's figure, whatever the size.
        show.pixels_per_point = (f64::from(size[0].max(size[1])) / 1280.0).max(1.0);
        show.background = if transparent {
            Background::Transparent
        } else {
            Background::Color([255, 255, 255])
        };
        graphics.upload(state, open, &egui::Visuals::light());
        graphics.uploaded.looks.clear();
        let mut view = state.view(open);
        if let Some(seen) = open.looking.size {
            view = view.reframed(seen, DVec2::from(size.map(f64::from)));
        }
        let drawn = graphics.renderer.picture_with_words(&view, &show, size);
        graphics.drawn = None;
        state.start_writing_picture(to, drawn);
    }
}

/// What the picture is of, for who does not see it.
fn in_words(state: &State, open: &OpenFlight) -> String {
    let parts = open.flight().parts();
    let photos = match parts.photos.len() {
        0 => "no photos".to_owned(),
        1 => "1 photo".to_owned(),
        many => format!("{many} photos"),
    };
    let shown = match state.page {
        Page::Plan => "the planned flight over the surface",
        _ if open.looking.through.is_some() => "the surface through a photo's camera",
        _ => "the surface with its photos",
    };
    let selected = open.selected.map_or_else(
        || "no photo is selected".to_owned(),
        |photo| format!("{} is selected", open.name(photo)),
    );
    format!("{}: {shown}, {photos}; {selected}", parts.name)
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

/// The place that the mouse points at, from wherever it does.
fn point(
    state: &State,
    open: &OpenFlight,
    scene: &Scene,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) {
    if let Some(linked) = &open.pointer.linked {
        let painter = ui.painter().with_clip_rect(scene.place);
        let to_screen = |point| Some(scene.screen(scene.view.project(point, scene.size())?));
        let at = linked::glow(&painter, linked, to_screen);
        // What the flight's own photos see of it is beside the matter where others are planned.
        if open.pointer.from == Some(PointFrom::Pile) && state.page == Page::Pile {
            linked::beside(state, open, linked, &painter, scene.place, at);
        }
    }
    if state.page == Page::Pile {
        linked::menu(open, response, commands);
    }
    linked::copy(open, ui, response, commands);
}

fn blend(open: &OpenFlight) -> f64 {
    match open.looking.through {
        Some(_) => open.looking.blend,
        None => 0.0,
    }
}

fn show(state: &State, open: &OpenFlight, ui: &egui::Ui, pixels_per_point: f64) -> Show {
    let mut show = state.preferences.layers.show(Some(open.ground()));
    show.unit = open.flight().parts().unit;
    show.lengths_in = open.flight().parts().unit_of_lengths();
    show.scale_unit = Some(state.preferences.unit());
    show.measured = open.pointer.measure.points(open.pointer.hover);
    show_picked(open, &mut show);
    show.color_limits = open.colors.limits(show.color_by);
    show.clip = open.clip.clipping();
    show.beside = true;
    show_drawn(open, &mut show);
    show.selected = open.selected;
    show.hovered = open.table.hovered;
    show.photo_blend = blend(open);
    show.pixels_per_point = pixels_per_point;
    let [red, green, blue, _] = ui.visuals().extreme_bg_color.to_array();
    show.background = Background::Color([red, green, blue]);
    if state.page == Page::Plan {
        planned::show_planned(open, &mut show);
    }
    show
}
