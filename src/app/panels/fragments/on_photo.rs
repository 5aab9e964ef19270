//! Strokes and clicks on the photo, and what lies over it: outlines, the stroke, the brush.

use egui::{Color32, Key, Modifiers, PointerButton, Pos2, Rect, Stroke, TextureHandle};
use glam::DVec2;

use super::{picture, tools};
use crate::clicks::clicked_places;
use crate::command::Command;
use crate::fragments::{FragmentStep, FragmentTool};
use crate::open_flight::OpenFlight;
use crate::panels::inspector::traced_photo::PhotoPlace;

/// Of what is being drawn.
const DRAWN: Color32 = Color32::from_rgb(255, 80, 200);

/// Under it, so that it is seen on any photo.
const SHADE: Color32 = Color32::from_black_alpha(200);

/// The most pixels of the screen that outlines are drawn for; on larger ones two share one.
const MOST_PIXELS: f32 = 3e6;

/// What a picture of outlines is of: the flight, the photo and its revision, the selected fragment, the part of the photo,
/// the size.
#[derive(Debug, Clone, PartialEq)]
struct Of {
    flight: u64,
    photo: usize,
    revision: u64,
    selected: Option<u32>,
    part: [DVec2; 2],
    size: [usize; 2],
}

/// What is kept between frames.
#[derive(Default)]
pub(in crate::panels) struct OnPhoto {
    /// The stroke that is being drawn, pixels of the photo.
    stroke: Vec<DVec2>,
    drawn: Option<(Of, TextureHandle)>,
}

impl OnPhoto {
    /// Takes strokes, clicks and keys. Returns whether the mouse is taken, so that it does not move the photo.
    pub(in crate::panels) fn mouse(
        &mut self,
        open: &OpenFlight,
        place: &PhotoPlace<'_>,
        ui: &egui::Ui,
        response: &egui::Response,
        commands: &mut Vec<Command>,
    ) -> bool {
        tools::keys(ui, commands);
        let mut send = |step| commands.push(Command::Fragments(step));
        let tool = open.fragments.tool;
        let under = |at: Pos2| place.pixel_under(at);
        if let Some(at) = response.hover_pos()
            && !ui.ctx().egui_wants_keyboard_input()
        {
            let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
            if pressed(Key::Plus) || pressed(Key::Equals) {
                send(FragmentStep::Coarser(under(at)));
            }
            if pressed(Key::Minus) {
                send(FragmentStep::Finer(under(at)));
            }
        }
        let draws = !matches!(tool, FragmentTool::Select | FragmentTool::Grow);
        if response.hovered() && tool != FragmentTool::Select {
            ui.set_cursor_icon(egui::CursorIcon::Crosshair);
        }
        let by_hand = draws && response.dragged_by(PointerButton::Primary);
        if draws && response.drag_started_by(PointerButton::Primary) {
            let origin = ui.input(|input| input.pointer.press_origin());
            self.stroke = origin.map(under).into_iter().collect();
        }
        if by_hand && let Some(at) = response.interact_pointer_pos() {
            let at = under(at);
            let is_new = |last: &DVec2| last.distance(at) >= 0.5;
            if self.stroke.last().is_none_or(is_new) {
                self.stroke.push(at);
            }
        }
        if response.drag_stopped_by(PointerButton::Primary) {
            let stroke = std::mem::take(&mut self.stroke);
            if stroke.len() > 1 {
                send(FragmentStep::Stroke(stroke));
            }
        }
        let mut clicks = clicked_places(ui, response);
        let is_begun = !open.fragments.drawing.is_empty() || clicks.len() > 1;
        let ends = tool.outlines() && is_begun && response.double_clicked();
        if ends {
            // Its first click has put the corner, and the hand may have trembled since.
            clicks.pop();
        }
        for at in clicks {
            send(FragmentStep::Click(under(at)));
        }
        if ends {
            send(FragmentStep::Finish);
        }
        by_hand || (response.double_clicked() && tool != FragmentTool::Select)
    }

    /// Draws outlines, stroke and brush.
    pub(in crate::panels) fn draw(
        &mut self,
        open: &OpenFlight,
        photo: usize,
        place: &PhotoPlace<'_>,
        frame: Rect,
        ui: &egui::Ui,
    ) {
        let painter = ui.painter().with_clip_rect(frame);
        self.draw_outlines(open, photo, place, frame, ui, &painter);
        let fragments = &open.fragments;
        let line = |places: &[DVec2], closed: bool| {
            let mut points: Vec<Pos2> = places.iter().map(|at| place.to_screen(*at)).collect();
            if closed && points.len() > 2 {
                points.push(points[0]);
            }
            for stroke in [Stroke::new(4.0, SHADE), Stroke::new(2.0, DRAWN)] {
                painter.add(egui::Shape::line(points.clone(), stroke));
            }
        };
        line(&self.stroke, fragments.tool.outlines());
        line(&fragments.drawing, true);
        for corner in &fragments.drawing {
            painter.circle_filled(place.to_screen(*corner), 4.0, SHADE);
            painter.circle_filled(place.to_screen(*corner), 2.5, DRAWN);
        }
        if fragments.tool == FragmentTool::Brush
            && let Some(at) = ui.input(|input| input.pointer.hover_pos())
            && frame.contains(at)
        {
            let per_pixel = place.rect.width() / place.camera.width as f32;
            let radius = fragments.brush_radius() as f32 * per_pixel;
            painter.circle_stroke(at, radius, Stroke::new(3.0, SHADE));
            painter.circle_stroke(at, radius, Stroke::new(1.5, DRAWN));
        }
    }

    fn draw_outlines(
        &mut self,
        open: &OpenFlight,
        photo: usize,
        place: &PhotoPlace<'_>,
        frame: Rect,
        ui: &egui::Ui,
        painter: &egui::Painter,
    ) {
        let seen = place.rect.intersect(frame);
        let Some(of) = open.fragments.of(photo).filter(|_| seen.is_positive()) else {
            self.drawn = None;
            return;
        };
        let size = seen.size() * ui.ctx().pixels_per_point();
        let size = match size.x * size.y > MOST_PIXELS {
            true => size * 0.5,
            false => size,
        };
        let wanted = Of {
            flight: open.number,
            photo,
            revision: of.revision,
            selected: open.fragments.selected,
            part: [place.pixel_under(seen.min), place.pixel_under(seen.max)],
            size: [size.x, size.y].map(|side| side.round().max(1.0) as usize),
        };
        if self
            .drawn
            .as_ref()
            .is_none_or(|(drawn, _)| *drawn != wanted)
        {
            let picture = picture::picture(of.now(), wanted.selected, wanted.part, wanted.size);
            let options = egui::TextureOptions::NEAREST;
            let texture = ui.ctx().load_texture("outlines", picture, options);
            self.drawn = Some((wanted, texture));
        }
        if let Some((_, texture)) = &self.drawn {
            let whole = Rect::from_min_max(Pos2::ZERO, egui::pos2(1.0, 1.0));
            painter.image(texture.id(), seen, whole, Color32::WHITE);
        }
    }
}
