//! The limits of the colours: a histogram of the values with two handles, numbers, and the way back.

use egui::{Color32, Rect, Sense, Stroke, pos2, vec2};

use crate::command::Command;
use crate::open_flight::OpenFlight;
use crate::open_flight::colors::Histogram;
use crate::render::{ColorBy, viridis};
use crate::state::State;

/// Of the histogram, points.
const HEIGHT: f32 = 44.0;
/// How wide a handle is to be caught, points.
const HANDLE: f32 = 10.0;

/// Draws them where the colours mean numbers.
pub(super) fn color_range(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let by = state.preferences.layers.color_by;
    let Some(open) = state.open.as_deref().filter(|_| by != ColorBy::Rgb) else {
        return;
    };
    let Some(histogram) = open.colors.histogram(by) else {
        ui.weak("Looking at the values…");
        return;
    };
    // Shown in the unit that the legend has.
    let (factor, unit) = shown_in(state, open, by);
    let set = open.colors.limits(by);
    let now = set.unwrap_or(histogram.usual);
    let mut next = now;
    handles(histogram, &mut next, ui);
    ui.horizontal(|ui| {
        let span = (histogram.ends[1] - histogram.ends[0]).abs() * factor;
        let names = ["Lower limit of the colours", "Upper limit of the colours"];
        for (limit, name) in next.iter_mut().zip(names) {
            let mut shown = *limit * factor;
            let before = shown;
            let field = egui::DragValue::new(&mut shown)
                .speed((span / 200.0).max(1e-9))
                .max_decimals(3);
            let field = ui.add(field);
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, name));
            field.on_hover_text(format!("{name}, {unit}: drag, or click to type"));
            if shown != before {
                *limit = shown / factor;
            }
        }
        ui.label(unit);
        let reset = ui.add_enabled(set.is_some(), egui::Button::new("Reset"));
        let hover = match by {
            ColorBy::Slope => "From 0° to 90°",
            ColorBy::Scale => "From the 2nd to the 98th percentile of the photo",
            _ => "From the 1st to the 99th percentile of the points",
        };
        if reset.on_hover_text(hover).clicked() {
            commands.push(Command::ColorLimits(by, None));
        }
    });
    if next != now {
        commands.push(Command::ColorLimits(by, Some(next)));
    }
}

/// What values are multiplied by to be shown, and the unit that they are shown in.
fn shown_in(state: &State, open: &OpenFlight, by: ColorBy) -> (f64, String) {
    let parts = open.flight().parts();
    match by {
        ColorBy::Rgb | ColorBy::Elevation => (1.0, parts.unit_of_lengths().to_owned()),
        ColorBy::Slope => (1.0, "°".to_owned()),
        ColorBy::Scale => {
            let unit = state.preferences.unit();
            (unit.in_units_of(parts.unit), format!("px/{unit}"))
        }
    }
}

/// The columns in the colours that their values have, and the two limits to drag.
fn handles(histogram: &Histogram, limits: &mut [f64; 2], ui: &mut egui::Ui) {
    let width = ui.available_width().min(210.0);
    let (place, _) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::hover());
    let painter = ui.painter().with_clip_rect(place);
    painter.rect_filled(place, 2.0, ui.visuals().extreme_bg_color);
    let inner = place.shrink2(vec2(HANDLE * 0.5, 2.0));
    let [low, high] = histogram.ends;
    let span = (high - low).max(f64::MIN_POSITIVE);
    // `as`: screens are f32.
    let x_of = |value: f64| inner.left() + ((value - low) / span) as f32 * inner.width();
    let columns = histogram.columns.len();
    for (column, share) in histogram.columns.iter().enumerate() {
        let edge = |column: usize| inner.left() + inner.width() * column as f32 / columns as f32;
        let middle = low + span * (column as f64 + 0.5) / columns as f64;
        let colored = (middle - limits[0]) / (limits[1] - limits[0]).max(f64::MIN_POSITIVE);
        let [red, green, blue] = viridis(colored.clamp(0.0, 1.0));
        // The root, so that what is rare is seen.
        let top = inner.bottom() - inner.height() * share.sqrt() as f32;
        let bar = Rect::from_min_max(
            pos2(edge(column), top),
            pos2(edge(column + 1), inner.bottom()),
        );
        painter.rect_filled(bar, 0.0, Color32::from_rgb(red, green, blue));
    }
    let names = ["Lower handle of the colours", "Upper handle of the colours"];
    let before = *limits;
    for (side, name) in names.into_iter().enumerate() {
        let x = x_of(before[side]).clamp(inner.left(), inner.right());
        let grip = Rect::from_center_size(pos2(x, place.center().y), vec2(HANDLE, HEIGHT));
        let handle = ui.interact(grip, ui.scope_id().with(name), Sense::drag());
        handle.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, name));
        let strong = handle.hovered() || handle.dragged();
        let stroke = Stroke::new(
            if strong { 3.0 } else { 2.0 },
            ui.visuals().strong_text_color(),
        );
        painter.vline(x, place.y_range(), stroke);
        if handle.dragged()
            && let Some(at) = handle.interact_pointer_pos()
        {
            let share = f64::from((at.x - inner.left()) / inner.width()).clamp(0.0, 1.0);
            let value = low + share * span;
            // The two do not pass each other.
            let least = span / 500.0;
            limits[side] = match side {
                0 => value.min(before[1] - least),
                _ => value.max(before[0] + least),
            };
        }
        handle.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    }
}
