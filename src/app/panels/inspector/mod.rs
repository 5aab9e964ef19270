//! The selected photo: its picture with the scale bars of the paper's figure, its numbers, and every
//! reason to doubt them.

mod decision;
mod points;
mod reason_picture;
mod reasons;
mod remedy;
mod scale_objects;
mod scales;
pub(super) mod tint;
pub(super) mod traced_photo;

use egui::{Color32, Pos2, Rect, Sense, Stroke, Vec2, pos2, vec2};
use glam::DVec2;

use crate::command::Command;
use crate::linked::PointFrom;
use crate::names;
use crate::open_flight::OpenFlight;
use crate::panels::Scrolled;
use crate::panels::corner_loupe::{self, Crops};
use crate::panels::corner_marks::{CORNER_ROOM, draw_corner, nearest_inside};
use crate::panels::linked;
use crate::panels::verdict::verdict_label;
use crate::picture::{BarEdge, ScaleBar, scale_bars};
use crate::scale::ImageKind;
use crate::state::State;
use decision::decision;
use reasons::reasons;
pub(super) use remedy::{Offer, remedy_button};
use scale_objects::scale_objects;
pub(super) use scales::SIZE_ERROR;
use scales::scales;
use tint::Tint;
use traced_photo::{Dragged, PhotoPlace};

/// The inspector keeps the photo's texture and how it is zoomed.
pub struct Inspector {
    /// Flight, photo and number of the preview that the texture shows.
    shown: Option<(u64, usize, u64)>,
    texture: Option<egui::TextureHandle>,
    /// How many times the photo is larger than fitted, at least 1.
    zoom: f32,
    /// The place of the photo (0 to 1 each way) in the middle of its frame.
    middle: Vec2,
    /// What tints the photo.
    tint: Tint,
    /// The surface at the photo's corners.
    pub(crate) crops: Option<Crops>,
    /// The point of a scale object that the mouse moves.
    dragged: Option<Dragged>,
}

impl Default for Inspector {
    fn default() -> Self {
        Self {
            shown: None,
            texture: None,
            // Fitted from the first frame on: without any size, the labels of top and bottom change places.
            zoom: 1.0,
            middle: vec2(0.5, 0.5),
            tint: Tint::default(),
            crops: None,
            dragged: None,
        }
    }
}

impl Inspector {
    /// Draws the page.
    pub fn show(&mut self, state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        let Some(open) = &state.open else {
            return;
        };
        let reviewed = open
            .selected
            .and_then(|photo| Some((photo, open.review.photo(photo)?)));
        let Some((photo, reviewed)) = reviewed else {
            ui.weak("Select a photo in the table or in the viewport.");
            return;
        };
        // From the right, so that a long name gives way.
        let right = egui::Layout::right_to_left(egui::Align::Center);
        let row = vec2(ui.available_width(), ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(row, right, |ui| {
            tint::switch(state, ui, commands);
            if let Some(verdict) = reviewed.settled() {
                verdict_label(state, verdict, ui);
            }
            if !open.is_computed() {
                ui.weak("computing…");
            }
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let body = egui::TextStyle::Body;
                names::styled(ui, reviewed.name(), body, egui::RichText::strong);
            });
        });
        self.take_texture(open, ui);
        self.picture(state, open, photo, ui, commands);
        egui::ScrollArea::vertical().show_focused(ui, |ui| {
            if reviewed.scale_to_type().is_some() {
                scales(state, open, reviewed, ui, commands);
            }
            reasons(state, reviewed, ui, commands);
            decision(open, photo, reviewed, ui, commands);
            let texture = self.texture.as_ref().map(egui::TextureHandle::id);
            corner_loupe::corner_loupe(state, open, reviewed, texture, self.crops, ui, commands);
            scale_objects(state, open, photo, ui, commands);
            let unit = open.flight().parts().unit_of_lengths();
            if let Some(scale) = reviewed.scale() {
                points::corners(unit, scale, ui, commands);
            }
            if let Some(view) = reviewed.view {
                points::facts(unit, view, ui);
            }
        });
    }

    fn take_texture(&mut self, open: &OpenFlight, ui: &egui::Ui) {
        let wanted = open
            .pictures
            .preview
            .as_ref()
            .filter(|preview| Some(preview.photo) == open.selected)
            .map(|preview| (open.number, preview.photo, preview.number));
        if wanted == self.shown {
            return;
        }
        self.shown = wanted;
        self.dragged = None;
        self.zoom = 1.0;
        self.middle = vec2(0.5, 0.5);
        self.texture = open
            .pictures
            .preview
            .as_ref()
            .filter(|_| wanted.is_some())
            .and_then(|preview| preview.picture.as_ref().ok())
            .map(|picture| {
                let pixels = egui::ImageData::Color(picture.large.clone());
                let options = egui::TextureOptions::LINEAR;
                ui.ctx().load_texture("photo", pixels, options)
            });
    }

    /// The photo, zoomed, with the bars of its scale.
    fn picture(
        &mut self,
        state: &State,
        open: &OpenFlight,
        photo: usize,
        ui: &mut egui::Ui,
        commands: &mut Vec<Command>,
    ) {
        let Some(reviewed) = open.review.photo(photo) else {
            return;
        };
        let tint = tint::wanted(state, open, reviewed);
        if let Some(tint) = tint {
            let unit = state.preferences.unit();
            self.tint.take(open, tint, reviewed, unit, ui);
        }
        let camera = reviewed.camera;
        let aspect = camera.width as f32 / camera.height as f32;
        let width = ui.available_width();
        let height = (width / aspect).min(ui.available_height() * 0.5).max(80.0);
        let (frame, response) =
            ui.allocate_exact_size(vec2(width, height), Sense::click_and_drag());
        response.widget_info(|| {
            let label = format!("Photo {} with its scale", reviewed.name());
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        let painter = ui.painter().with_clip_rect(frame);
        painter.rect_filled(frame, 2.0, ui.visuals().extreme_bg_color);
        // The photo fitted into the frame, then zoomed around its middle.
        let fitted = if frame.width() / frame.height() > aspect {
            vec2(frame.height() * aspect, frame.height())
        } else {
            vec2(frame.width(), frame.width() / aspect)
        };
        let size = fitted * self.zoom;
        let image = open.flight().parts().image;
        let on_screen = |middle: Vec2, size: Vec2| PhotoPlace {
            rect: Rect::from_min_size(frame.center() - middle * size, size),
            camera,
            image,
        };
        let shown = on_screen(self.middle, size);
        let taken = traced_photo::mouse(
            open,
            photo,
            &shown,
            &mut self.dragged,
            ui,
            &response,
            commands,
        );
        let is_traced = open.objects.tracing.is_some();
        self.turn_wheel(&response, ui, size, frame, taken, is_traced);
        let size = fitted * self.zoom;
        let half_seen = (frame.size() / size / 2.0).min(vec2(0.5, 0.5));
        self.middle = self.middle.clamp(half_seen, Vec2::splat(1.0) - half_seen);
        let shown = on_screen(self.middle, size);
        let place = shown.rect;
        match (&self.texture, open.pictures.preview.as_ref()) {
            (Some(texture), _) => {
                let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
                painter.image(texture.id(), place, whole, Color32::WHITE);
            }
            (None, Some(preview)) if preview.photo == photo && preview.picture.is_err() => {
                if let Err(reason) = &preview.picture {
                    message(&painter, frame, reason, ui);
                }
            }
            _ => {
                // The thumbnail stands in until the photo is read.
                if let Some(Some(texture)) = open.pictures.thumbnails.get(photo) {
                    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
                    painter.image(texture.id(), place, whole, Color32::from_gray(140));
                }
            }
        }
        // Nothing else lies over what is traced.
        if tint.is_some() && !is_traced {
            self.tint.draw(&painter, place);
        }
        if let Some(scale) = reviewed.scale_to_type().filter(|_| !is_traced) {
            let unit = state.preferences.unit();
            let to_screen = |pixel: DVec2| shown.to_screen(pixel);
            let pair = reviewed.estimates(reviewed.pair, unit);
            for bar in scale_bars(pair, camera.width, camera.height, unit) {
                draw_bar(&painter, frame, &bar, &to_screen);
            }
            for corner in &scale.corners {
                let at = nearest_inside(frame, CORNER_ROOM, to_screen(corner.pixel));
                draw_corner(&painter, at, &corner.outcome);
            }
        }
        if !is_traced {
            let to_screen = |pixel| Some(shown.to_screen(pixel));
            commands.extend(corner_loupe::clicked(reviewed, &response, frame, to_screen));
        }
        traced_photo::draw(open, photo, &shown, self.dragged, &painter);
        let from = PointFrom::Inspector;
        linked::on_photo(state, open, from, &shown, frame, ui, &response, commands);
        let pixel = response.hover_pos().map(|at| shown.pixel_under(at));
        if state.preferences.tint {
            tint::reading(state, reviewed, tint, pixel, ui);
        }
        if tint.is_some() {
            self.tint.legend(state.preferences.unit(), ui);
        }
        if is_traced || tint.is_some() {
            // A tooltip would hide what is traced, or pointed at.
            return;
        }
        let kind = match image {
            ImageKind::Undistorted => "undistorted",
            ImageKind::AsShot => "as shot",
        };
        response.on_hover_text(format!(
            "{} × {} px, {kind}. Wheel zooms, dragging moves, a double click fits.",
            camera.width, camera.height
        ));
    }

    /// Zooms and moves the photo, unless the mouse is `taken`; while something is traced a double
    /// click is two points.
    fn turn_wheel(
        &mut self,
        response: &egui::Response,
        ui: &egui::Ui,
        size: Vec2,
        frame: Rect,
        taken: bool,
        is_traced: bool,
    ) {
        if let Some(cursor) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (scroll * 0.005).exp() * pinch;
            if factor != 1.0 {
                let zoom = (self.zoom * factor).clamp(1.0, 40.0);
                // What is under the cursor stays under it.
                let offset = (cursor - frame.center()) / size;
                self.middle += offset * (1.0 - self.zoom / zoom);
                self.zoom = zoom;
            }
        }
        if response.dragged() && !taken {
            self.middle -= response.drag_delta() / size;
        }
        if response.double_clicked() && !is_traced {
            self.zoom = 1.0;
        }
    }
}

/// Says in the middle of a frame why nothing else is there.
pub(super) fn message(painter: &egui::Painter, frame: Rect, text: &str, ui: &egui::Ui) {
    in_the_middle(painter, frame, text, ui.visuals().error_fg_color, ui);
}

/// Says in the middle of a frame what is waited for.
pub(super) fn waiting(painter: &egui::Painter, frame: Rect, text: &str, ui: &egui::Ui) {
    in_the_middle(painter, frame, text, ui.visuals().text_color(), ui);
}

fn in_the_middle(painter: &egui::Painter, frame: Rect, text: &str, color: Color32, ui: &egui::Ui) {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let galley = painter.layout(text.to_owned(), font, color, frame.width() - 20.0);
    let place = Rect::from_center_size(frame.center(), galley.size());
    let behind = ui.visuals().panel_fill.gamma_multiply(0.85);
    painter.rect_filled(place.expand(6.0), 3.0, behind);
    painter.galley(place.min, galley, color);
}

/// A bar with its scale, which stays inside the frame: where that is narrow its length alone, because with its first
/// digit cut off it would be another number.
pub(super) fn draw_bar(
    painter: &egui::Painter,
    frame: Rect,
    bar: &ScaleBar,
    to_screen: &impl Fn(DVec2) -> Pos2,
) {
    let (from, to) = (to_screen(bar.from), to_screen(bar.to));
    let tick = vec2(0.0, 5.0);
    for (width, color) in [(4.0, Color32::from_black_alpha(180)), (2.0, Color32::WHITE)] {
        let stroke = Stroke::new(width, color);
        painter.line_segment([from, to], stroke);
        for end in [from, to] {
            painter.line_segment([end - tick, end + tick], stroke);
        }
    }
    let (gap, anchor) = match bar.edge {
        BarEdge::Top => (vec2(0.0, 7.0), egui::Align2::CENTER_TOP),
        BarEdge::Bottom => (vec2(0.0, -7.0), egui::Align2::CENTER_BOTTOM),
    };
    let at = from.lerp(to, 0.5) + gap;
    let font = egui::FontId::proportional(13.0);
    let widest = frame.width() - 8.0;
    let layout = |words: &str| {
        let text = names::unbroken(&format!("{}  {words}", bar.edge.as_str()));
        painter.layout(text, font.clone(), Color32::WHITE, widest)
    };
    let whole = layout(&bar.text);
    // In a small picture two rows at each edge would hide it: the scale itself stands below, or in the table.
    let galley = match (whole.rows.len(), bar.text.split_once(" · ")) {
        (2.., Some((length, _))) => layout(length),
        _ => whole,
    };
    let place = anchor.anchor_size(at, galley.size());
    let (least, most) = (frame.left() + 4.0, frame.right() - 4.0 - place.width());
    let place = place.translate(vec2(
        place.left().clamp(least, most.max(least)) - place.left(),
        0.0,
    ));
    painter.rect_filled(place.expand(2.0), 3.0, Color32::from_black_alpha(150));
    painter.galley(place.min, galley, Color32::WHITE);
}
