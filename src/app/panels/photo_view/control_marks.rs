//! Control points on the photo: their marks, which the mouse sets and moves, and where the chosen point can be.

use egui::{Color32, Pos2, Stroke, Vec2, vec2};
use glam::DVec2;

use super::PhotoPlace;
use crate::clicks::{apart, clicked_places};
use crate::command::Command;
use crate::control_points::ControlStep;
use crate::open_flight::OpenFlight;

/// Within this distance the mouse means a mark, screen points.
const REACH: f32 = 9.0;

/// Of the chosen point: bright on rock.
const CHOSEN: Color32 = Color32::from_rgb(255, 220, 40);

/// Of the other points.
const OTHER: Color32 = Color32::from_rgb(120, 220, 255);

/// Of the lines and the ring that say where it can be.
const PREDICTED: Color32 = Color32::from_rgb(255, 120, 220);

/// Under all of them.
const SHADE: Color32 = Color32::from_black_alpha(190);

/// A mark that is being moved: whose, and where to, in pixels as shot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DraggedMark {
    point: usize,
    to: DVec2,
    /// From the mouse to the mark: what is taken at its rim does not jump.
    grip: Vec2,
}

/// Sets and moves marks. Returns whether the mouse is taken, so that it does not move the photo.
pub(super) fn mouse(
    open: &OpenFlight,
    photo: usize,
    place: &PhotoPlace<'_>,
    dragged: &mut Option<DraggedMark>,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) -> bool {
    if !open.control.is_on || open.objects.tracing.is_some() {
        *dragged = None;
        return false;
    }
    let name = open.name(photo);
    let mark_at = |at: Pos2| {
        let points = open.control_list().points.iter().enumerate();
        let near = points.filter_map(|(point, marked)| {
            let to = marked.mark_in(name)?;
            let grip = place.screen_of_shot(to)? - at;
            (grip.length() <= REACH).then_some(DraggedMark { point, to, grip })
        });
        near.min_by(|a, b| a.grip.length().total_cmp(&b.grip.length()))
    };
    let mut send = |step: ControlStep| commands.push(Command::Control(step));
    if response.drag_started() && response.dragged_by(egui::PointerButton::Primary) {
        let origin = ui.input(|input| input.pointer.press_origin());
        *dragged = origin.and_then(mark_at);
    }
    let at = response.interact_pointer_pos();
    if let (Some(moved), Some(at)) = (dragged.as_mut(), at)
        && let Some(pixel) = place.shot_under(at + moved.grip)
    {
        let camera = place.camera;
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        moved.to = pixel.clamp(DVec2::ZERO, size);
    }
    if response.drag_stopped()
        && let Some(moved) = dragged.take()
    {
        send(ControlStep::Choose(Some(moved.point)));
        send(ControlStep::Mark {
            point: moved.point,
            photo,
            pixel: Some(moved.to),
        });
        return true;
    }
    if response.hovered() && open.control.chosen.is_some() {
        ui.set_cursor_icon(egui::CursorIcon::Crosshair);
    }
    for at in apart(clicked_places(ui, response), REACH) {
        match (mark_at(at), open.control.chosen) {
            (Some(mark), chosen) if Some(mark.point) != chosen => {
                send(ControlStep::Choose(Some(mark.point)));
            }
            // A click on its own mark is none: it would move it by the width of a hand's tremble.
            (Some(_), _) | (None, None) => {}
            (None, Some(point)) => {
                // Beside the photo there is nothing to mark.
                let pixel = place.shot_under(at);
                let pixel = pixel.filter(|&pixel| place.camera.contains(pixel));
                if pixel.is_some() {
                    send(ControlStep::Mark {
                        point,
                        photo,
                        pixel,
                    });
                }
            }
        }
    }
    dragged.is_some() || response.double_clicked() && open.control.chosen.is_some()
}

/// Delete takes the chosen point's mark away.
pub(super) fn keys(open: &OpenFlight, photo: usize, ui: &egui::Ui, commands: &mut Vec<Command>) {
    let Some(point) = open.control.chosen.filter(|_| open.control.is_on) else {
        return;
    };
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let deletes = ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Delete));
    if deletes {
        commands.push(Command::Control(ControlStep::Mark {
            point,
            photo,
            pixel: None,
        }));
    }
}

/// Draws them.
pub(super) fn draw(
    open: &OpenFlight,
    photo: usize,
    place: &PhotoPlace<'_>,
    dragged: Option<DraggedMark>,
    painter: &egui::Painter,
) {
    if !open.control.is_on {
        return;
    }
    let found = &open.control.found;
    let inside = painter.with_clip_rect(place.rect.intersect(painter.clip_rect()));
    for run in &found.lines {
        let points: Vec<Pos2> = run.iter().map(|pixel| place.to_screen(*pixel)).collect();
        for stroke in [Stroke::new(3.0, SHADE), Stroke::new(1.2, PREDICTED)] {
            inside.add(egui::Shape::line(points.clone(), stroke));
        }
    }
    if let Some(pixel) = found.predicted {
        let at = place.to_screen(pixel);
        painter.circle_stroke(at, 9.0, Stroke::new(4.0, SHADE));
        painter.circle_stroke(at, 9.0, Stroke::new(2.0, PREDICTED));
    }
    let name = open.name(photo);
    for (point, marked) in open.control_list().points.iter().enumerate() {
        let moved = dragged.filter(|moved| moved.point == point);
        let pixel = moved.map(|moved| moved.to).or_else(|| marked.mark_in(name));
        let Some(at) = pixel.and_then(|pixel| place.screen_of_shot(pixel)) else {
            continue;
        };
        let color = match open.control.chosen == Some(point) {
            true => CHOSEN,
            false => OTHER,
        };
        cross(painter, at, color);
        let font = egui::FontId::proportional(13.0);
        let galley = painter.layout_no_wrap(marked.name.clone(), font, color);
        let words = egui::Rect::from_min_size(at + vec2(9.0, -22.0), galley.size());
        painter.rect_filled(words.expand(2.0), 2.0, SHADE);
        painter.galley(words.min, galley, color);
    }
}

/// Open in its middle: the pixel itself is seen.
fn cross(painter: &egui::Painter, at: Pos2, color: Color32) {
    for stroke in [Stroke::new(4.0, SHADE), Stroke::new(1.6, color)] {
        for arm in [
            vec2(1.0, 0.0),
            vec2(-1.0, 0.0),
            vec2(0.0, 1.0),
            vec2(0.0, -1.0),
        ] {
            painter.line_segment([at + arm * 3.0, at + arm * 11.0], stroke);
        }
    }
}
