//! What lies over the map: grid with coordinates, north, scale bar, and what the mouse points at.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, pos2, vec2};
use glam::DVec2;

use super::inside;
use crate::exports::{Grid, MapFrame, Plan, PlanBar};
use crate::map::MadePlan;
use crate::units::LengthUnit;

const LABEL: f32 = 11.0;
/// The longest bar, points.
const BAR: f64 = 160.0;

/// Between the bar and the sides of the frame, at least, points.
const BESIDE_BAR: f64 = 22.0;

/// What is left of a narrow map beside its coordinates, points.
const LEAST: f32 = 40.0;

/// Between a label and the map.
const GAP: f32 = 4.0;

/// The frame of the map that leaves room for its coordinates at the left and below it.
pub(super) fn without_labels(map: &MapFrame, whole: Rect, ui: &egui::Ui) -> Rect {
    let width = |text: &str| {
        let font = FontId::proportional(LABEL);
        let galley = ui
            .painter()
            .layout_no_wrap(text.to_owned(), font, Color32::WHITE);
        galley.size().x
    };
    let widths = Grid::of(map)
        .up
        .iter()
        .map(|line| width(&line.label))
        .fold(0.0, f32::max);
    // A coordinate that is cut at its begin is another one.
    let left = (widths + 2.0 * GAP).min((whole.width() - LEAST).max(0.0));
    let below = (LABEL + 2.0 * GAP).min(whole.height() / 4.0);
    Rect::from_min_max(whole.min + vec2(left, 0.0), whole.max - vec2(0.0, below))
}

/// Lines at round coordinates, which are written at the left of the map and below it where there is room for
/// the whole of them.
pub(super) fn grid(
    map: &MapFrame,
    painter: &egui::Painter,
    margins: &egui::Painter,
    frame: Rect,
    ui: &egui::Ui,
) {
    let grid = Grid::of(map);
    let line = Stroke::new(1.0, ui.visuals().text_color().gamma_multiply(0.22));
    let mut taken: Option<Rect> = None;
    let mut label = |at, anchor: Align2, words: &str| {
        let font = FontId::proportional(LABEL);
        let galley = margins.layout_no_wrap(words.to_owned(), font, Color32::WHITE);
        let place = anchor.anchor_size(at, galley.size());
        let is_free = taken.is_none_or(|before| !before.expand(GAP).intersects(place));
        if is_free && margins.clip_rect().contains_rect(place) {
            text(margins, at, anchor, LABEL, words, ui);
            taken = Some(place);
        }
    };
    for across in &grid.across {
        let x = map.place(DVec2::new(across.at, 0.0))[0] as f32;
        painter.vline(x, frame.y_range(), line);
        let at = pos2(x, frame.bottom() + GAP);
        label(at, Align2::CENTER_TOP, &across.label);
    }
    for up in &grid.up {
        let y = map.place(DVec2::new(0.0, up.at))[1] as f32;
        painter.hline(frame.x_range(), y, line);
        let at = pos2(frame.left() - GAP, y);
        label(at, Align2::RIGHT_CENTER, &up.label);
    }
    let edge = Stroke::new(1.0, ui.visuals().text_color().gamma_multiply(0.5));
    margins.vline(frame.left(), frame.y_range(), edge);
    margins.hline(frame.x_range(), frame.bottom(), edge);
}

/// Words that are read on any ground.
fn text(painter: &egui::Painter, at: Pos2, anchor: Align2, size: f32, words: &str, ui: &egui::Ui) {
    let color = ui.visuals().strong_text_color();
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(size), color);
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place.expand2(vec2(2.0, 0.0)), 2.0, behind(ui));
    painter.galley(place.min, galley, color);
}

fn behind(ui: &egui::Ui) -> Color32 {
    ui.visuals().extreme_bg_color.gamma_multiply(0.75)
}

/// What lies over the map at rest: the arrow to the north and the scale bar.
pub(super) fn covered(plan: &Plan, map: &MapFrame, unit: LengthUnit, frame: Rect) -> [Rect; 2] {
    let (_, north) = place_of_north(frame);
    let bar = place_of_bar(plan, map, unit, frame).map_or(Rect::NOTHING, |(_, _, back)| back);
    [north, bar]
}

/// The tip of the arrow, and what is behind it.
fn place_of_north(frame: Rect) -> (Pos2, Rect) {
    let tip = inside(frame, frame.width() - 24.0, 26.0);
    let back = Rect::from_min_max(tip + vec2(-14.0, -24.0), tip + vec2(14.0, 34.0));
    (tip, back)
}

/// An arrow to the grid's north; in a frame of its own, along y.
pub(super) fn north(plan: &Plan, painter: &egui::Painter, frame: Rect, ui: &egui::Ui) {
    let (letter, words) = match plan.is_on_map() {
        true => ("N", "grid north"),
        false => ("y", "y of the flight's frame"),
    };
    let color = ui.visuals().strong_text_color();
    let (tip, back) = place_of_north(frame);
    painter.rect_filled(back, 3.0, behind(ui));
    let font = FontId::proportional(14.0);
    painter.text(
        tip - vec2(0.0, 4.0),
        Align2::CENTER_BOTTOM,
        letter,
        font,
        color,
    );
    let (right, left) = (tip + vec2(7.0, 30.0), tip + vec2(-7.0, 30.0));
    let notch = tip + vec2(0.0, 23.0);
    let half = vec![tip, right, notch];
    painter.add(egui::Shape::convex_polygon(half, color, Stroke::NONE));
    let around = vec![tip, right, notch, left];
    painter.add(egui::Shape::closed_line(around, Stroke::new(1.2, color)));
    let hint = ui.interact(
        back,
        ui.scope_id().with("north of the map"),
        egui::Sense::hover(),
    );
    hint.on_hover_text(words);
}

/// The bar, its right end, and what is behind it; none where no round length fits.
fn place_of_bar(
    plan: &Plan,
    map: &MapFrame,
    unit: LengthUnit,
    frame: Rect,
) -> Option<(PlanBar, Pos2, Rect)> {
    let longest = BAR.min(f64::from(frame.width()) - 2.0 * BESIDE_BAR);
    let bar = plan.bar(map.scale, longest, unit)?;
    let end = frame.max - vec2(14.0, 30.0);
    let start = end - vec2(bar.long as f32, 0.0);
    let back = Rect::from_min_max(start - vec2(8.0, 20.0), end + vec2(8.0, 8.0));
    Some((bar, end, back))
}

/// A bar of a round length.
pub(super) fn bar(
    plan: &Plan,
    map: &MapFrame,
    unit: LengthUnit,
    painter: &egui::Painter,
    frame: Rect,
    ui: &egui::Ui,
) {
    let Some((bar, end, back)) = place_of_bar(plan, map, unit, frame) else {
        return;
    };
    let color = ui.visuals().strong_text_color();
    let long = bar.long as f32;
    let start = end - vec2(long, 0.0);
    painter.rect_filled(back, 3.0, behind(ui));
    let stroke = Stroke::new(2.0, color);
    painter.line_segment([start, end], stroke);
    for tip in [start, end] {
        painter.line_segment([tip - vec2(0.0, 4.0), tip + vec2(0.0, 4.0)], stroke);
    }
    let galley = painter.layout_no_wrap(bar.words(), FontId::proportional(12.0), color);
    // Over the middle; of a short bar within the frame.
    let most = frame.right() - 4.0 - galley.size().x;
    let left = (start.x + (long - galley.size().x) / 2.0).min(most);
    painter.galley(pos2(left, start.y - 4.0 - galley.size().y), galley, color);
}

/// Coordinates and photo under the mouse, in the upper left.
pub(super) fn words(
    made: &MadePlan,
    point: DVec2,
    photo: Option<usize>,
    painter: &egui::Painter,
    frame: Rect,
    ui: &egui::Ui,
) {
    let unit = made.plan.unit_of_lengths();
    let mut words = format!("x {:.2}  y {:.2} {unit}", point.x, point.y);
    if let Some(photo) = photo.and_then(|photo| made.plan.photos.get(photo)) {
        let verdict = photo
            .verdict
            .map_or("not settled", |verdict| verdict.as_str());
        words = format!("{words}   {}: {verdict}", photo.name);
    }
    let at = inside(frame, 6.0, 5.0);
    text(painter, at, Align2::LEFT_TOP, 13.0, &words, ui);
}
