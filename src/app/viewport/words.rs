//! What is written over the picture: words, the legend.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, pos2, vec2};

use super::Scene;
use crate::picture::Anchor;
use crate::render::{Label, MEASURED, viridis};

pub(super) fn write(scene: &Scene, label: &Label, ui: &egui::Ui) {
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
    let color = Color32::from_rgb(red, green, blue);
    let at = scene.screen(label.at);
    match label.color == MEASURED {
        true => on_plate(&painter, at, anchor, &label.text, color, ui),
        false => haloed(&painter, at, anchor, &label.text, 13.0, color, ui),
    }
}

/// A text on a plate as a tooltip has, with a rim of the line's colour: numbers to be read off are hard to read in thin letters on
/// broken rock.
fn on_plate(
    painter: &egui::Painter,
    at: Pos2,
    anchor: Align2,
    text: &str,
    rim: Color32,
    ui: &egui::Ui,
) {
    let color = ui.visuals().text_color();
    let font = FontId::proportional(13.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, color);
    let edge = vec2(5.0, 2.0);
    let place = anchor.anchor_size(at, galley.size());
    // What belongs to something in sight is read whole beside the picture's edge.
    let (sight, half) = (painter.clip_rect(), place.size() / 2.0 + edge);
    let inside = Rect::from_min_max(sight.min + half, sight.max - half);
    let place = match sight.contains(at) && inside.is_positive() {
        true => Rect::from_center_size(inside.clamp(place.center()), place.size()),
        false => place,
    };
    let plate = place.expand2(edge);
    painter.rect_filled(plate.expand(1.0), 4.0, rim);
    painter.rect_filled(plate, 3.0, ui.visuals().window_fill);
    painter.galley(place.min, galley, color);
}

/// What the colours mean: a bar at the right edge, round values left of it, the title over it.
pub(super) fn legend(scene: &Scene, legend: Option<&crate::render::Legend>, ui: &egui::Ui) {
    let Some(legend) = legend else {
        return;
    };
    let (width, height) = (12.0, (scene.place.height() * 0.35).min(180.0));
    let margin = 14.0;
    let foot = scene.place.right_center() + vec2(-width - margin, height / 2.0);
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
    for (share, text) in legend.ticks() {
        let y = bar.bottom() - share as f32 * height;
        let at = pos2(bar.left() - 5.0, y);
        let tick = [pos2(bar.left() - 3.0, y), pos2(bar.left(), y)];
        painter.line_segment(tick, Stroke::new(1.0, color));
        haloed(&painter, at, Align2::RIGHT_CENTER, &text, 12.0, color, ui);
    }
    let at = pos2(bar.right() + 4.0, bar.top() - 10.0);
    let title = &legend.title;
    haloed(&painter, at, Align2::RIGHT_BOTTOM, title, 12.0, color, ui);
}

/// A text with a halo, because what lies behind may be of any colour.
pub(super) fn haloed(
    painter: &egui::Painter,
    at: Pos2,
    anchor: Align2,
    text: &str,
    size: f32,
    color: Color32,
    ui: &egui::Ui,
) {
    let font = FontId::proportional(size);
    let halo = if ui.visuals().dark_mode {
        Color32::from_black_alpha(170)
    } else {
        Color32::from_white_alpha(190)
    };
    for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
        painter.text(at + vec2(x, y), anchor, text, font.clone(), halo);
    }
    painter.text(at, anchor, text, font, color);
}
