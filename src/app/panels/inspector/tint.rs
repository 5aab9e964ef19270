//! The selected photo tinted by its scale: colours, lines of equal scale at round values, a legend, and
//! the scale under the mouse.

use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::DVec2;

use crate::actions;
use crate::command::Command;
use crate::flight::PhotoReview;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::open_flight::tint::PhotoTint;
use crate::picture::{isolines, round_levels};
use crate::render::viridis;
use crate::scale::FieldGrid;
use crate::state::State;
use crate::units::LengthUnit;

/// How much of the photo the colours leave.
const OPACITY: f32 = 0.55;

/// The most lines of equal scale.
const MOST_LINES: u32 = 9;

/// A line of equal scale.
struct Line {
    /// Pixels per unit.
    level: f64,
    /// As shares of the photo's width and height.
    points: Vec<[f32; 2]>,
}

/// What is drawn over the photo, made once for each field and unit.
#[derive(Default)]
pub(in crate::panels) struct Tint {
    /// Flight, number of the field, unit.
    made_of: Option<(u64, u64, LengthUnit)>,
    texture: Option<egui::TextureHandle>,
    lines: Vec<Line>,
    /// Pixels per unit.
    range: Option<[f64; 2]>,
}

/// The field that is to be shown: of the selected photo, where a scale means something.
pub(in crate::panels) fn wanted<'a>(
    state: &State,
    open: &'a OpenFlight,
    reviewed: PhotoReview<'_>,
) -> Option<&'a PhotoTint> {
    there(open, reviewed).filter(|_| state.preferences.tint)
}

/// The same, whether it is to be shown or not.
pub(super) fn there<'a>(open: &'a OpenFlight, reviewed: PhotoReview<'_>) -> Option<&'a PhotoTint> {
    let means_something = reviewed.unit_known && open.is_computed();
    let of_photo = |tint: &&PhotoTint| Some(tint.photo) == open.selected;
    open.tint
        .as_ref()
        .filter(|_| means_something)
        .filter(of_photo)
}

impl Tint {
    /// Makes what is drawn of a field, if it is another one than before.
    pub(in crate::panels) fn take(
        &mut self,
        open: &OpenFlight,
        tint: &PhotoTint,
        reviewed: PhotoReview<'_>,
        unit: LengthUnit,
        ui: &egui::Ui,
    ) {
        let wanted = Some((open.number, tint.number, unit));
        if self.made_of == wanted {
            return;
        }
        self.made_of = wanted;
        let factor = unit.in_units_of(reviewed.unit);
        self.range = tint.range.map(|range| range.map(|scale| scale * factor));
        let range = self.range.unwrap_or_default();
        let FieldGrid { columns, rows } = tint.field.grid;
        let at = |column, row| Some(tint.field.scale_at(column, row)? * factor);
        let places = tint.field.grid.cells();
        let pixels = places.map(|(column, row)| {
            let scale = at(column, row);
            scale.map_or(Color32::TRANSPARENT, |scale| {
                color(scale, range).gamma_multiply(OPACITY)
            })
        });
        let picture = egui::ColorImage::new([columns as usize, rows as usize], pixels.collect());
        // Cells are cells: between a place with a scale and one without nothing is made up.
        let options = egui::TextureOptions::NEAREST;
        self.texture = Some(ui.ctx().load_texture("tint", picture, options));
        let levels = round_levels(range, MOST_LINES);
        let share = |at: f64, count: u32| ((at + 0.5) / f64::from(count)) as f32;
        let lines = isolines(columns, rows, at, &levels).into_iter();
        self.lines = lines
            .map(|line| Line {
                level: line.level,
                points: line
                    .points
                    .iter()
                    .map(|point| [share(point.x, columns), share(point.y, rows)])
                    .collect(),
            })
            .collect();
    }

    /// Draws it over the photo, which is at `place`.
    pub(in crate::panels) fn draw(&self, painter: &egui::Painter, place: Rect) {
        let Some(texture) = &self.texture else {
            return;
        };
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(texture.id(), place, whole, Color32::WHITE);
        let on_screen = |[x, y]: [f32; 2]| place.min + vec2(x, y) * place.size();
        for line in &self.lines {
            let points: Vec<Pos2> = line.points.iter().copied().map(on_screen).collect();
            for (width, color) in [(2.5, Color32::from_black_alpha(120)), (1.0, Color32::WHITE)] {
                painter.add(egui::Shape::line(points.clone(), Stroke::new(width, color)));
            }
        }
        // Numbers over all lines, on long ones first: a short line is known by its neighbours.
        let length = |line: &Line| -> f32 {
            let points = line.points.windows(2);
            points
                .map(|pair| on_screen(pair[0]).distance(on_screen(pair[1])))
                .sum()
        };
        let mut long: Vec<(f32, &Line)> = self.lines.iter().map(|l| (length(l), l)).collect();
        long.retain(|(length, _)| *length > 60.0);
        long.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut taken: Vec<Rect> = Vec::new();
        for (_, line) in long {
            let Some(middle) = line.points.get(line.points.len() / 2) else {
                continue;
            };
            let (text, font) = (line.level.to_string(), FontId::proportional(11.0));
            let galley = painter.layout_no_wrap(text, font, Color32::WHITE);
            let back = Rect::from_center_size(on_screen(*middle), galley.size());
            if taken.iter().any(|other| other.intersects(back.expand(4.0))) {
                continue;
            }
            painter.rect_filled(back.expand(1.0), 2.0, Color32::from_black_alpha(150));
            painter.galley(back.min, galley, Color32::WHITE);
            taken.push(back);
        }
    }

    /// What the colours mean, under the photo.
    pub(in crate::panels) fn legend(&self, unit: LengthUnit, ui: &mut egui::Ui) {
        let Some(range @ [low, high]) = self.range else {
            ui.weak("No ray of the photo meets the surface: it has no scale to tint it by.");
            return;
        };
        let size = vec2(ui.available_width(), 25.0);
        let (place, response) = ui.allocate_exact_size(size, Sense::hover());
        let ends = [low, high].map(|end| significant_digits(end, 4));
        let label = format!("Legend: {} to {} px/{unit}", ends[0], ends[1]);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &label));
        let painter = ui.painter().with_clip_rect(place);
        let bar = Rect::from_min_size(place.min, vec2(place.width(), 10.0));
        const STEPS: u8 = 64;
        for step in 0..STEPS {
            let share = |step: u8| f32::from(step) / f32::from(STEPS);
            let x = bar.left() + share(step) * bar.width();
            let stripe = Rect::from_x_y_ranges(x..=x + bar.width() * share(1) + 0.5, bar.y_range());
            let [red, green, blue] = viridis(f64::from(share(step) + share(1) / 2.0));
            painter.rect_filled(stripe, 0.0, Color32::from_rgb(red, green, blue));
        }
        let (text, font) = (ui.visuals().text_color(), FontId::proportional(11.0));
        let foot = bar.bottom() + 1.0;
        let end = |at: Pos2, anchor: Align2, words: &str| {
            painter.text(at, anchor, words, font.clone(), text)
        };
        let left = end(pos2(bar.left(), foot), Align2::LEFT_TOP, &ends[0]);
        let last = format!("{} px/{unit}", ends[1]);
        let right = end(pos2(bar.right(), foot), Align2::RIGHT_TOP, &last);
        let mut free_from = left.right() + 4.0;
        for level in round_levels(range, MOST_LINES) {
            let x = bar.left() + ((level - low) / (high - low)) as f32 * bar.width();
            painter.vline(x, bar.y_range(), Stroke::new(1.0, Color32::WHITE));
            let words = level.to_string();
            let galley = painter.layout_no_wrap(words, font.clone(), text);
            let words = Align2::CENTER_TOP.anchor_size(pos2(x, foot), galley.size());
            if words.left() > free_from && words.right() < right.left() - 4.0 {
                free_from = words.right() + 4.0;
                painter.galley(words.min, galley, text);
            }
        }
        response.on_hover_text(format!(
            "{label}; 2 % of the photo lie below, 2 % above. White lines: where one scale holds."
        ));
    }
}

/// The switch.
pub(in crate::panels) fn switch(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let (action, on) = (actions::photo::TINT, state.preferences.tint);
    let command = (action.command)(state);
    let is_on = command.is_some();
    let button = ui.add_enabled(is_on, egui::Button::new(action.label).selected(on));
    button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, is_on, on, action.label));
    let keys = action.shortcut.map(|keys| ui.ctx().format_shortcut(&keys));
    let hover = format!("{} ({})", action.hover, keys.unwrap_or_default());
    if button.on_hover_text(hover).clicked() {
        commands.extend(command);
    }
}

/// The scale under the mouse. `pixel` is what the mouse points at, if anything.
pub(in crate::panels) fn reading(
    state: &State,
    reviewed: PhotoReview<'_>,
    tint: Option<&PhotoTint>,
    pixel: Option<DVec2>,
    ui: &mut egui::Ui,
) {
    let unit = state.preferences.unit();
    match (tint, pixel) {
        (None, _) if !reviewed.unit_known => {
            ui.weak("No tint: nobody says which unit the world has.")
        }
        (None, _) => ui.weak("Computing the tint…"),
        (Some(_), None) => ui.weak("Point at the photo for the scale there."),
        (Some(tint), Some(pixel)) => match tint.at(pixel) {
            None => ui.label("no surface at the cursor"),
            Some(scale) => {
                let scale = scale.times(unit.in_units_of(reviewed.unit)).text(4);
                ui.label(format!("{scale} px/{unit} at the cursor"))
            }
        },
    };
}

fn color(scale: f64, [low, high]: [f64; 2]) -> Color32 {
    let share = match high > low {
        true => (scale - low) / (high - low),
        false => 0.5,
    };
    let [red, green, blue] = viridis(share);
    Color32::from_rgb(red, green, blue)
}
