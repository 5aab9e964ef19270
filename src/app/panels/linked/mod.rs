//! The linked cursor as it is drawn: a glowing point with its ring, the words beside it, the menu of the
//! photos that see it.

use egui::{Color32, FontId, Pos2, Rect, Stroke, vec2};
use glam::DVec3;

use super::inspector::traced_photo::PhotoPlace;
use crate::command::Command;
use crate::geometry::Ray;
use crate::linked::{LinkedPoint, PointFrom};
use crate::names::unbroken;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::scale::Sighting;
use crate::state::State;

/// Of point and ring: seen on any rock.
const GLOW: Color32 = Color32::from_rgb(255, 236, 90);

/// Draws the ring and the point; returns where the point is.
pub(crate) fn glow(
    painter: &egui::Painter,
    linked: &LinkedPoint,
    to_screen: impl Fn(DVec3) -> Option<Pos2>,
) -> Option<Pos2> {
    let chords: Vec<[Pos2; 2]> = linked
        .ring
        .iter()
        .filter_map(|[from, to]| Some([to_screen(*from)?, to_screen(*to)?]))
        .collect();
    for (width, color) in [(4.0, Color32::from_black_alpha(150)), (1.8, GLOW)] {
        for &chord in &chords {
            painter.line_segment(chord, Stroke::new(width, color));
        }
    }
    let at = to_screen(linked.point)?;
    painter.circle_filled(at, 8.0, Color32::from_rgba_unmultiplied(255, 236, 90, 60));
    let rim = Stroke::new(1.5, Color32::from_black_alpha(200));
    painter.circle(at, 3.0, GLOW, rim);
    Some(at)
}

/// How many photos see it, in words.
fn seen_in(linked: &LinkedPoint) -> String {
    match linked.seen.len() {
        0 => "seen in no photo".to_owned(),
        1 => "seen in 1 photo".to_owned(),
        many => format!("seen in {many} photos"),
    }
}

/// A local scale in the unit that scales are shown in.
fn scale(state: &State, open: &OpenFlight, seen: Sighting) -> String {
    let (per, factor) = super::shown_per(state, open);
    format!("{} {per}", significant_digits(seen.scale * factor, 4))
}

/// What is said of the point.
fn words(state: &State, open: &OpenFlight, linked: &LinkedPoint) -> Vec<String> {
    let unit = open.flight().parts().unit;
    let mut words = Vec::new();
    let selected = open.selected.and_then(|photo| linked.in_photo(photo));
    match selected {
        Some(seen) => words.push(scale(state, open, seen)),
        None => words.push("not seen in the selected photo".to_owned()),
    }
    let DVec3 { x, y, z } = linked.point;
    words.push(match linked.is_ten_centimetres {
        true => format!("{x:.3}  {y:.3}  {z:.3} {unit}"),
        false => format!("{x:.3}  {y:.3}  {z:.3}"),
    });
    words.push(seen_in(linked));
    if !linked.is_ten_centimetres {
        words.push("ring: 1 % of the footprint, the unit is not known".to_owned());
    }
    words
}

/// Writes the words beside the point, inside of the frame.
pub(crate) fn beside(
    state: &State,
    open: &OpenFlight,
    linked: &LinkedPoint,
    painter: &egui::Painter,
    frame: Rect,
    at: Option<Pos2>,
) {
    let Some(at) = at else {
        return;
    };
    let words = words(state, open, linked);
    let words: Vec<String> = words.iter().map(|line| unbroken(line)).collect();
    let words = words.join("\n");
    // In a narrow frame in more lines: a number with its first digits cut off is another one.
    let room = frame.shrink(6.0);
    let font = FontId::proportional(12.0);
    let galley = painter.layout(words, font, Color32::WHITE, room.width());
    let mut place = Rect::from_min_size(at + vec2(16.0, 14.0), galley.size());
    if place.right() > room.right() {
        place = place.translate(vec2(-32.0 - place.width(), 0.0));
    }
    if place.bottom() > room.bottom() {
        place = place.translate(vec2(0.0, -28.0 - place.height()));
    }
    let held = |low: f32, high: f32, least: f32, most: f32| {
        (most - high).min(0.0) + (least - low).max(0.0)
    };
    let into = vec2(
        held(place.left(), place.right(), room.left(), room.right()),
        held(place.top(), place.bottom(), room.top(), room.bottom()),
    );
    let place = place.translate(into);
    painter.rect_filled(place.expand(4.0), 3.0, Color32::from_black_alpha(170));
    painter.galley(place.min, galley, Color32::WHITE);
}

/// What a right click opens: the coordinates to copy, and the photos that see the point. The point stays
/// meanwhile.
pub(crate) fn menu(open: &OpenFlight, response: &egui::Response, commands: &mut Vec<Command>) {
    response.context_menu(|ui| {
        let Some(linked) = &open.pointer.linked else {
            ui.weak("no surface here");
            return;
        };
        if ui.button("Copy coordinates").clicked() {
            commands.push(Command::Copy(linked.coordinates()));
            ui.close();
        }
        ui.separator();
        ui.weak(seen_in(linked));
        egui::ScrollArea::vertical()
            .max_height(300.0)
            .show(ui, |ui| {
                for (photo, _) in &linked.seen {
                    let name = format!("Go to {}", open.name(*photo));
                    if ui.button(name).clicked() {
                        commands.push(Command::Select(Some(*photo)));
                        ui.close();
                    }
                }
            });
    });
}

/// Ctrl+C copies the coordinates under the mouse, or the distance that was measured.
pub(crate) fn copy(
    open: &OpenFlight,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) {
    // While points are picked, their table is copied.
    let picks = open.pointer.picked.is_on && !open.pointer.picked.list().is_empty();
    let Some(linked) = open.pointer.linked.as_ref().filter(|_| !picks) else {
        return;
    };
    let asks = |input: &egui::InputState| {
        // With Shift the scales are copied.
        input.events.contains(&egui::Event::Copy) && !input.modifiers.shift
    };
    if response.hovered() && !ui.ctx().text_edit_focused() && ui.input(asks) {
        // What was measured last goes before what the mouse is on.
        let measured = open.pointer.measure.copied();
        commands.push(Command::Copy(
            measured.unwrap_or_else(|| linked.coordinates()),
        ));
    }
}

/// What the mouse over a part of the window points at is looked for whenever its ray is another one: the mouse moved, or
/// a key changed the photo or the view under it. Beside a photo there is no ray.
pub(crate) fn hover(
    open: &OpenFlight,
    from: PointFrom,
    ray: Option<Ray>,
    commands: &mut Vec<Command>,
) {
    let is_other = match ray {
        Some(ray) => open.pointer.asked != Some((from, ray)),
        None => open.pointer.from.is_some(),
    };
    if is_other {
        commands.push(Command::Hover(from, ray));
    }
}

/// The linked cursor on a photo: the mouse over it points at the surface, and what is pointed at anywhere
/// glows on it.
#[expect(
    clippy::too_many_arguments,
    reason = "two callers, all of them different"
)]
pub(super) fn on_photo(
    state: &State,
    open: &OpenFlight,
    from: PointFrom,
    place: &PhotoPlace<'_>,
    frame: Rect,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) {
    let Some(reviewed) = open.selected.and_then(|photo| open.review.photo(photo)) else {
        return;
    };
    let pose = reviewed.photo.pose;
    let is_frozen = response.context_menu_opened();
    match response.hover_pos() {
        None if open.pointer.from == Some(from) && !is_frozen => {
            commands.push(Command::Hover(from, None));
        }
        Some(at) if !is_frozen && !response.dragged() => {
            let pixel = place.pixel_under(at);
            let direction = place.image.direction(place.camera, pixel).ok();
            let direction = direction.filter(|_| place.camera.contains(pixel));
            let ray = direction.map(|direction| Ray {
                origin: pose.center,
                direction: (pose.rotation * direction).normalize(),
            });
            hover(open, from, ray, commands);
        }
        _ => {}
    }
    let linked = open.pointer.linked.as_ref();
    let sees = |linked: &LinkedPoint| open.selected.and_then(|photo| linked.in_photo(photo));
    if let Some(linked) = linked.filter(|linked| sees(linked).is_some()) {
        let painter = ui.painter().with_clip_rect(frame);
        let to_screen = |point| {
            let pixel = place
                .image
                .pixel(place.camera, pose.camera_from_world(point))?;
            Some(place.to_screen(pixel))
        };
        let at = glow(&painter, linked, to_screen);
        if open.pointer.from == Some(from) {
            beside(state, open, linked, &painter, frame, at);
        }
    }
    menu(open, response, commands);
    copy(open, ui, response, commands);
}
