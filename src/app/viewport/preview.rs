//! The viewport while a large surface is read: a first look at it, which can be turned.

use egui::{Align2, FontId, Sense, vec2};
use glam::DVec2;

use super::{Scene, Viewport};
use crate::command::{Command, ViewChange};
use crate::frame_times::{FrameTimes, Phase};
use crate::opening_preview::OpeningPreview;
use crate::render::{Background, Scope, Show};
use crate::state::State;

impl Viewport {
    /// Draws it, and says what it is.
    pub fn show_preview(
        &mut self,
        state: &State,
        preview: &OpeningPreview,
        ui: &mut egui::Ui,
        commands: &mut Vec<Command>,
        times: &mut FrameTimes,
    ) {
        let place = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(place, Sense::click_and_drag());
        let words = preview.in_words();
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &words));
        let pixels_per_point = f64::from(ui.ctx().pixels_per_point());
        let size = [place.width(), place.height()]
            .map(|side| ((f64::from(side) * pixels_per_point).round() as u32).max(1));
        let scene = Scene {
            place,
            pixels_per_point,
            size,
            view: preview.orbit.view(),
        };
        if !preview.is_seen_in(scene.size()) {
            commands.push(Command::View(ViewChange::Resized(scene.size())));
        }
        turn(&scene, ui, &response, commands);
        if let Some(graphics) = &mut self.graphics {
            if let Some(error) = graphics.gpu.take_error() {
                commands.push(Command::Report(format!("graphics: {error}")));
            }
            times.end(Phase::Panels);
            graphics.upload_preview(preview);
            times.end(Phase::Upload);
            let [red, green, blue, _] = ui.visuals().extreme_bg_color.to_array();
            let show = Show {
                cloud: true,
                mesh: false,
                frusta: Scope::None,
                corner_rays: Scope::None,
                outlines: Scope::None,
                fills: Scope::None,
                axes: false,
                // Nobody knows the unit yet.
                scale_bar: false,
                background: Background::Color([red, green, blue]),
                pixels_per_point,
                point_size: state.preferences.layers.point_size,
                ..Show::default()
            };
            graphics.draw(&scene, &show, ui);
            times.end(Phase::Draw);
        }
        cameras(preview, &scene, ui);
        let font = FontId::proportional(14.0);
        let color = ui.visuals().strong_text_color();
        let at = place.left_top() + vec2(12.0, 10.0);
        let text = ui
            .painter()
            .layout(words, font, color, place.width() - 24.0);
        let behind = Align2::LEFT_TOP.anchor_size(at, text.size()).expand(5.0);
        let fill = ui.visuals().window_fill;
        ui.painter().rect_filled(behind, 4.0, fill);
        ui.painter().galley(at, text, color);
    }
}

/// The cameras found so far, as small pyramids.
fn cameras(preview: &OpeningPreview, scene: &Scene, ui: &egui::Ui) {
    let painter = ui.painter().with_clip_rect(scene.place);
    let stroke = egui::Stroke::new(1.2, ui.visuals().hyperlink_color);
    let to_screen = |point| Some(scene.screen(scene.view.project(point, scene.size())?));
    for camera in &preview.cameras {
        let ends = camera.map(to_screen);
        for (from, to) in [
            (0, 1),
            (0, 2),
            (0, 3),
            (0, 4),
            (1, 2),
            (2, 3),
            (3, 4),
            (4, 1),
        ] {
            if let (Some(from), Some(to)) = (ends[from], ends[to]) {
                painter.line_segment([from, to], stroke);
            }
        }
    }
}

/// The mouse as commands: as over a flight, without anything to point at.
fn turn(scene: &Scene, ui: &egui::Ui, response: &egui::Response, commands: &mut Vec<Command>) {
    let delta = response.drag_delta();
    let delta = DVec2::new(f64::from(delta.x), f64::from(delta.y));
    let size = scene.size();
    if delta != DVec2::ZERO {
        let turns = response.dragged_by(egui::PointerButton::Primary);
        commands.push(Command::View(match turns {
            true => ViewChange::Orbit(delta),
            false => ViewChange::Pan(delta * scene.pixels_per_point, size),
        }));
    }
    let Some(at) = response.hover_pos() else {
        return;
    };
    let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
    let factor = (-f64::from(scroll) * 0.004).exp() / f64::from(pinch);
    if factor != 1.0 {
        commands.push(Command::View(ViewChange::Zoom {
            cursor: scene.pixel(at),
            size,
            factor,
        }));
    }
}
