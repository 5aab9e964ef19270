//! The mouse over the viewport, as commands.

use glam::DVec2;

use super::Scene;
use crate::clicks::clicked_places;
use crate::command::{Command, ViewChange};
use crate::linked::PointFrom;
use crate::open_flight::OpenFlight;
use crate::panels::linked;

pub(super) fn mouse(
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
            commands.push(Command::View(ViewChange::Pan(delta, size)));
        } else if response.dragged_by(egui::PointerButton::Primary) {
            // The same turn for the same way of the hand, whatever the screen's density.
            commands.push(Command::View(ViewChange::Orbit(
                delta / scene.pixels_per_point,
            )));
        }
    }
    let ray_at = |at| scene.view.ray(scene.pixel(at), size);
    let mut clicks = clicked_places(ui, response);
    let last = match response.double_clicked() {
        true => clicks.pop(),
        false => None,
    };
    let is_clicked = last.is_some() || !clicks.is_empty();
    commands.extend(clicks.into_iter().map(|at| Command::Click(ray_at(at))));
    commands.extend(last.map(|at| Command::DoubleClick(ray_at(at))));
    // A handle that lies over the surface takes the mouse, but not the wheel.
    let over = response.contains_pointer();
    let over = over.then(|| ui.input(|input| input.pointer.hover_pos()));
    if let Some(at) = over.flatten() {
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
    let Some(at) = response.hover_pos() else {
        if open.pointer.from == Some(PointFrom::Pile) && !response.context_menu_opened() {
            commands.push(Command::Hover(PointFrom::Pile, None));
        }
        return;
    };
    if !is_clicked && !response.dragged() && !response.context_menu_opened() {
        linked::hover(open, PointFrom::Pile, Some(ray_at(at)), commands);
    }
}
