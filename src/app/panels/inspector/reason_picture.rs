//! The selected photo with what shows a reason for doubt: marked corners, bars, its scale as colours.

use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::DVec2;

use super::{Inspector, PhotoPlace, draw_bar, message, tint};
use crate::flight::{OnPhoto, PhotoReview};
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::corner_marks::{draw_corner, nearest_inside};
use crate::picture::scale_bars;
use crate::scale::Corner;
use crate::state::State;

/// Bright on rock, and not one of the colours that corners have.
const MARK: Color32 = Color32::from_rgb(255, 80, 220);

impl Inspector {
    /// Draws it, as wide as the panel.
    pub(in crate::panels) fn reason_picture(
        &mut self,
        state: &State,
        open: &OpenFlight,
        (photo, reviewed): (usize, PhotoReview<'_>),
        on_photo: &OnPhoto,
        ui: &mut egui::Ui,
    ) {
        self.take_texture(open, ui);
        let camera = reviewed.camera;
        let aspect = camera.width as f32 / camera.height as f32;
        // So that the sentence stays in sight below it.
        let most = (ui.ctx().content_rect().height() * 0.35).max(120.0);
        let size = ui.available_width().min(most * aspect);
        let size = vec2(size, size / aspect);
        let (row, response) =
            ui.allocate_exact_size(vec2(ui.available_width(), size.y), Sense::hover());
        let place = Rect::from_center_size(row.center(), size);
        response.widget_info(|| {
            let shown = match on_photo {
                OnPhoto::Nothing => "the photo".to_owned(),
                OnPhoto::Corners(corners) => {
                    let names = corners.iter().map(|c| c.as_str().replace('_', " "));
                    names.collect::<Vec<_>>().join(", ")
                }
                OnPhoto::TopBottom => "top and bottom scale".to_owned(),
                OnPhoto::Sides => "left and right scale".to_owned(),
                OnPhoto::Field => "scale of its pixels".to_owned(),
            };
            let what = open.reason().map_or("Scales", |_| "Reason");
            let label = format!("{what} on {}: {shown}", reviewed.name());
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        let painter = ui.painter().with_clip_rect(row);
        painter.rect_filled(place, 2.0, ui.visuals().extreme_bg_color);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let preview = open.pictures.preview.as_ref();
        let preview = preview.filter(|preview| preview.photo == photo);
        let thumbnail = open.pictures.thumbnails.get(photo).and_then(Option::as_ref);
        match (&self.texture, preview.map(|p| &p.picture), thumbnail) {
            (Some(texture), ..) => {
                painter.image(texture.id(), place, whole, Color32::WHITE);
            }
            (None, Some(Err(reason)), _) => message(&painter, place, reason, ui),
            (None, _, Some(texture)) => {
                painter.image(texture.id(), place, whole, Color32::from_gray(140));
            }
            _ => {}
        }
        let shown = PhotoPlace {
            rect: place,
            camera,
            image: open.flight().parts().image,
        };
        let to_screen = |pixel: DVec2| shown.to_screen(pixel);
        let unit = state.preferences.unit();
        let scale = reviewed.scale();
        match on_photo {
            OnPhoto::Nothing => {}
            OnPhoto::Corners(names) => {
                for corner in scale.into_iter().flat_map(|scale| &scale.corners) {
                    let at = nearest_inside(place, 9.0, to_screen(corner.pixel));
                    draw_corner(&painter, at, &corner.outcome);
                    if names.contains(&corner.name) {
                        mark(&painter, at, place, corner);
                    }
                }
            }
            OnPhoto::TopBottom => {
                let pair = reviewed.estimates(reviewed.pair, unit);
                let bars = scale_bars(pair, camera.width, camera.height, unit);
                for bar in bars.iter().filter(|_| reviewed.unit_known) {
                    draw_bar(&painter, place, bar, &to_screen);
                }
            }
            OnPhoto::Sides => {
                let edges = reviewed.edges(unit);
                for (x, side, value) in [
                    (place.left(), Align2::LEFT_CENTER, edges.left),
                    (place.right(), Align2::RIGHT_CENTER, edges.right),
                ] {
                    let inward = if x == place.left() { 6.0 } else { -6.0 };
                    let edge = [
                        pos2(x + inward / 2.0, place.top()),
                        pos2(x + inward / 2.0, place.bottom()),
                    ];
                    painter.line_segment(edge, Stroke::new(3.0, MARK));
                    let Some(value) = value.filter(|_| reviewed.unit_known) else {
                        continue;
                    };
                    let text = format!("{} px/{unit}", significant_digits(value, 4));
                    let at = pos2(x + 2.0 * inward, place.center().y);
                    written(&painter, at, side, text);
                }
            }
            OnPhoto::Field => match tint::there(open, reviewed) {
                Some(field) => {
                    self.tint.take(open, field, reviewed, unit, ui);
                    self.tint.draw(&painter, place);
                    self.tint.legend(unit, ui);
                }
                None => {
                    ui.weak("Computing the tint…");
                }
            },
        }
    }
}

/// A ring around a corner, and its name.
fn mark(painter: &egui::Painter, at: Pos2, place: Rect, corner: &Corner) {
    painter.circle_stroke(at, 16.0, Stroke::new(4.0, Color32::from_black_alpha(160)));
    painter.circle_stroke(at, 16.0, Stroke::new(2.0, MARK));
    let is_left = at.x < place.center().x;
    let (x, anchor) = match is_left {
        true => (at.x + 22.0, Align2::LEFT_CENTER),
        false => (at.x - 22.0, Align2::RIGHT_CENTER),
    };
    let name = corner.name.as_str().replace('_', " ");
    written(painter, pos2(x, at.y), anchor, name);
}

fn written(painter: &egui::Painter, at: Pos2, anchor: Align2, text: String) {
    let galley = painter.layout_no_wrap(text, FontId::proportional(13.0), Color32::WHITE);
    let back = anchor.anchor_size(at, galley.size());
    painter.rect_filled(back.expand(2.0), 3.0, Color32::from_black_alpha(150));
    painter.galley(back.min, galley, Color32::WHITE);
}
