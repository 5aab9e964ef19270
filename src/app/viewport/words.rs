//! What is written over the picture: words, the legend, the distance tool.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, pos2, vec2};

use super::Scene;
use crate::numbers::significant_digits;
use crate::open_flight::{Measure, OpenFlight};
use crate::picture::Anchor;
use crate::render::{Label, viridis};

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
    let (at, font) = (scene.screen(label.at), FontId::proportional(13.0));
    // A halo, because what lies behind may be of any colour.
    let halo = if ui.visuals().dark_mode {
        Color32::from_black_alpha(170)
    } else {
        Color32::from_white_alpha(190)
    };
    for (x, y) in [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)] {
        painter.text(at + vec2(x, y), anchor, &label.text, font.clone(), halo);
    }
    painter.text(
        at,
        anchor,
        &label.text,
        font,
        Color32::from_rgb(red, green, blue),
    );
}

/// What the colours mean.
pub(super) fn legend(scene: &Scene, legend: Option<&crate::render::Legend>, ui: &egui::Ui) {
    let Some(legend) = legend else {
        return;
    };
    let (width, height) = (12.0, (scene.place.height() * 0.35).min(180.0));
    let foot = scene.place.right_center() + vec2(-width - 64.0, height / 2.0);
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
    let font = FontId::proportional(12.0);
    for (value, y) in [
        (legend.range[1], bar.top()),
        (legend.range[0], bar.bottom()),
    ] {
        let text = significant_digits(value, 4);
        let at = pos2(bar.right() + 5.0, y);
        painter.text(at, Align2::LEFT_CENTER, text, font.clone(), color);
    }
    let at = pos2(bar.center().x, bar.top() - 8.0);
    painter.text(at, Align2::CENTER_BOTTOM, &legend.title, font, color);
}

/// The points and the line of the distance tool.
pub(super) fn distance(scene: &Scene, open: &OpenFlight, ui: &egui::Ui) {
    let (first, second) = match open.pointer.measure {
        Measure::Off | Measure::First => return,
        Measure::Second(first) => (first, None),
        Measure::Both(first, second) => (first, Some(second)),
    };
    let size = scene.size();
    let painter = ui.painter().with_clip_rect(scene.place);
    let color = Color32::from_rgb(255, 90, 200);
    let places: Vec<Pos2> = [Some(first), second]
        .into_iter()
        .flatten()
        .filter_map(|point| scene.view.project(point, size))
        .map(|pixel| scene.screen(pixel))
        .collect();
    if let ([a, b], Some(second)) = (&places[..], second) {
        painter.line_segment([*a, *b], Stroke::new(2.0, color));
        let text = format!(
            "{} {}",
            significant_digits(first.distance(second), 4),
            open.flight().parts().unit
        );
        let at = a.lerp(*b, 0.5);
        let galley = painter.layout_no_wrap(text, FontId::proportional(14.0), Color32::WHITE);
        let back = Rect::from_center_size(at - vec2(0.0, 14.0), galley.size()).expand(3.0);
        painter.rect_filled(back, 3.0, Color32::from_black_alpha(180));
        painter.galley(back.shrink(3.0).min, galley, Color32::WHITE);
    }
    for place in places {
        painter.circle(place, 4.0, color, Stroke::new(1.0, Color32::WHITE));
    }
}
