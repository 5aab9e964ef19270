//! Handles in the middle of the clipping box's faces: a drag moves a face along its axis.

use egui::{Color32, CursorIcon, Rect, Sense, Stroke, vec2};
use glam::DVec3;

use super::Scene;
use crate::command::Command;
use crate::geometry::{LevelBox, Ray};
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::clip::ClipStep;

/// Side of what the mouse takes hold of, points.
const HOLD: f32 = 20.0;
const RADIUS: f32 = 5.0;
const COLOR: Color32 = Color32::from_rgb(240, 190, 40);
const HOVERED: Color32 = Color32::from_rgb(255, 240, 150);

/// The thinnest box, in the diagonal of the surface.
const THINNEST: f64 = 1e-4;

/// Draws them over the viewport while the box's window is shown.
pub(super) fn clip_handles(
    open: &OpenFlight,
    scene: &Scene,
    ui: &egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(level) = open.clip.clipping().filter(|_| open.clip.is_open) else {
        return;
    };
    let painter = ui.painter().with_clip_rect(scene.place);
    let thinnest = open.extent.bulk.size().length() * THINNEST;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (is_high, end) in [(false, "from"), (true, "to")] {
            let (face, way) = face(&level, axis, is_high);
            let Some(pixel) = scene.view.project(face, scene.size()) else {
                continue;
            };
            let at = scene.screen(pixel);
            if !scene.place.contains(at) {
                continue;
            }
            let id = ui
                .scope_id()
                .with(("face of the clipping box", axis, is_high));
            let hold = Rect::from_center_size(at, vec2(HOLD, HOLD));
            let response = ui.interact(hold, id, Sense::drag());
            let label = format!("Face {name} {end}");
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &label));
            let is_held = response.hovered() || response.dragged();
            let (color, radius) = match is_held {
                true => (HOVERED, RADIUS + 2.0),
                false => (COLOR, RADIUS),
            };
            painter.circle(
                at,
                radius,
                color,
                Stroke::new(1.5, Color32::from_black_alpha(200)),
            );
            if is_held {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
            }
            let moved = response.drag_delta();
            if response.dragged()
                && moved != egui::Vec2::ZERO
                && let Some(now) = response.interact_pointer_pos()
            {
                let ray = |at| scene.view.ray(scene.pixel(at), scene.size());
                let along = |at| along(face, way, &ray(at));
                if let (Some(from), Some(to)) = (along(now - moved), along(now)) {
                    let next = moved_face(&level, axis, is_high, to - from, thinnest);
                    commands.push(Command::Clip(ClipStep::Set(next)));
                }
            }
            let hover = format!("Drag to move this face of the clipping box ({name} {end})");
            response.on_hover_text(hover);
        }
    }
}

/// The middle of a face and the way along its axis, in the world.
fn face(level: &LevelBox, axis: usize, is_high: bool) -> (DVec3, DVec3) {
    let mut middle = (level.low + level.high) * 0.5;
    middle[axis] = if is_high {
        level.high[axis]
    } else {
        level.low[axis]
    };
    let at = level.to_world(middle);
    (at, level.to_world(middle + DVec3::AXES[axis]) - at)
}

/// How far along a line through `face` its point nearest to a ray is; `None` where one looks along it.
fn along(face: DVec3, way: DVec3, ray: &Ray) -> Option<f64> {
    let off = face - ray.origin;
    let (a, b, c) = (
        way.dot(way),
        way.dot(ray.direction),
        ray.direction.dot(ray.direction),
    );
    let apart = a * c - b * b;
    // The sine of the angle between them, squared, times both lengths squared.
    (apart > 1e-4 * a * c).then(|| (b * ray.direction.dot(off) - c * way.dot(off)) / apart)
}

/// The box with one face moved, no thinner than so much.
fn moved_face(level: &LevelBox, axis: usize, is_high: bool, by: f64, thinnest: f64) -> LevelBox {
    let mut next = *level;
    match is_high {
        true => next.high[axis] = (next.high[axis] + by).max(next.low[axis] + thinnest),
        false => next.low[axis] = (next.low[axis] + by).min(next.high[axis] - thinnest),
    }
    next
}
