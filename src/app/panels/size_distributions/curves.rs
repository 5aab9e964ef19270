//! The curves by method, trial and photo: which are drawn, in which colour, with which weight.

use egui::collapsing_header::CollapsingState;

use super::plot::color;
use crate::command::Command;
use crate::fragmentation::LabelledDistribution;
use crate::names;
use crate::numbers::significant_digits;
use crate::panels::rows::text_width;
use crate::size_distributions::drawing::MethodDrawing;
use crate::size_distributions::{Computed, DistributionCommand};
use crate::state::State;

/// What stands behind the method that the others are held against.
const REFERENCE: &str = "reference";

/// A text is laid out in whole points.
const ROUNDING: f32 = 1.0;

/// A trial of more photos is closed at first.
const FEW: usize = 4;

/// Draws the tree.
pub(super) fn curves(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(computed) = &state.distributions.computed else {
        return;
    };
    ui.strong("Curves");
    for drawing in &computed.drawing.methods {
        let method = &drawing.method;
        let curves: Vec<_> = computed.analysis.photos.curves.iter().collect();
        let curves = having(&curves, |curve| curve.labels.method == *method);
        let several = curves.len() > 1;
        let is_reference = computed.analysis.reference.as_ref() == Some(method);
        let head = |ui: &mut egui::Ui, commands: &mut Vec<Command>| {
            swatch(drawing, ui);
            let behind = is_reference.then_some(REFERENCE);
            check(state, [method, method], &curves, behind, ui, commands);
            if let Some(text) = behind {
                ui.weak(text);
            }
            weights(&curves, ui);
        };
        if several {
            let id = ui.make_persistent_id(("curves of", method));
            let open = CollapsingState::load_with_default_open(ui.ctx(), id, true);
            let head = open.show_header(ui, |ui| head(ui, commands));
            head.body(|ui| trials(state, computed, method, &curves, ui, commands));
        } else {
            // In line with those that can be opened.
            ui.horizontal(|ui| {
                ui.add_space(ui.spacing().indent);
                head(ui, commands);
            });
        }
    }
    let analysis = &computed.analysis;
    for note in analysis.steps.iter().chain(&analysis.warnings) {
        let text = egui::RichText::new(note).small().weak();
        ui.add(egui::Label::new(text).wrap());
    }
}

fn trials(
    state: &State,
    computed: &Computed,
    method: &str,
    curves: &[&LabelledDistribution],
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let of_method = |labels: &&crate::fragmentation::Labels| labels.method == method;
    let labels = computed
        .analysis
        .trials
        .curves
        .iter()
        .map(|trial| &trial.labels);
    for trial in labels.filter(of_method) {
        let photos = having(curves, |curve| curve.labels.trial == trial.trial);
        let text = match trial.trial.as_str() {
            "" => "no trial",
            trial => trial,
        };
        let name = format!("{method} / {text}");
        let head = |ui: &mut egui::Ui, commands: &mut Vec<Command>| {
            check(state, [&name, text], &photos, None, ui, commands);
            weights(&photos, ui);
        };
        if !photos.iter().any(|photo| !photo.labels.photo.is_empty()) {
            ui.horizontal(|ui| head(ui, commands));
            continue;
        }
        let id = ui.make_persistent_id(("photos of", trial));
        let open = CollapsingState::load_with_default_open(ui.ctx(), id, photos.len() <= FEW);
        let head = open.show_header(ui, |ui| head(ui, commands));
        head.body(|ui| {
            for photo in &photos {
                ui.horizontal(|ui| {
                    let name = photo.labels.to_string();
                    let names = [name.as_str(), &photo.labels.photo];
                    check(state, names, &[photo], None, ui, commands);
                    weights(&[photo], ui);
                });
            }
        });
    }
}

fn having<'a>(
    curves: &[&'a LabelledDistribution],
    wanted: impl Fn(&LabelledDistribution) -> bool,
) -> Vec<&'a LabelledDistribution> {
    let wanted = curves.iter().filter(|curve| wanted(curve));
    wanted.copied().collect()
}

/// The colour that the method is drawn in.
fn swatch(drawing: &MethodDrawing, ui: &mut egui::Ui) {
    let color = color(drawing.style, ui.visuals().dark_mode);
    let (place, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
    ui.painter().rect_filled(place, 3.0, color);
}

/// The box that draws these curves, or not. `name` is its whole name and what stands beside it; `behind` comes after it in its row,
/// before the weight, and has its room.
fn check(
    state: &State,
    [name, text]: [&str; 2],
    curves: &[&LabelledDistribution],
    behind: Option<&str>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let hidden = &state.distributions.hidden;
    let shown = curves.iter().filter(|c| !hidden.contains(&c.labels));
    let shown = shown.count();
    let mut all = shown == curves.len();
    let mixed = shown > 0 && !all;
    let font = egui::TextStyle::Body.resolve(ui.style());
    let spacing = ui.spacing();
    let gap = spacing.item_spacing.x;
    // What else is in the row: the box itself, what comes behind, the weight.
    let of_box = spacing.icon_width + spacing.icon_spacing + ROUNDING;
    let weight = weight_of(curves);
    let others = behind.into_iter().chain(weight.as_deref());
    let others: f32 = others.map(|text| text_width(ui, text) + gap).sum();
    let width = (ui.available_width() - of_box - others).max(40.0);
    let shown = names::fitted(ui, text, &font, width);
    let is_cut = *shown != *text;
    let response = ui.add(egui::Checkbox::new(&mut all, &*shown).indeterminate(mixed));
    let response = match is_cut {
        true => response.on_hover_text(text),
        false => response,
    };
    response.widget_info(|| {
        let label = format!("Show {name}");
        egui::WidgetInfo::selected(egui::Role::CheckBox, true, all, label)
    });
    let hover = "Draw it, or not; tables are of all curves";
    if response.on_hover_text(hover).changed() {
        let labels = curves.iter().map(|curve| curve.labels.clone()).collect();
        let command = DistributionCommand::Show(labels, all);
        commands.push(Command::Distributions(command));
    }
}

/// The sum of the weights, where the input says them.
fn weights(curves: &[&LabelledDistribution], ui: &mut egui::Ui) {
    if let Some(weight) = weight_of(curves) {
        let hover = "The area or mass that it stands for, as the table gives it";
        ui.weak(weight).on_hover_text(hover);
    }
}

/// The same in words.
fn weight_of(curves: &[&LabelledDistribution]) -> Option<String> {
    let known: Vec<f64> = curves.iter().filter_map(|curve| curve.weight).collect();
    let sum = || significant_digits(known.iter().sum(), 4);
    (!known.is_empty()).then(|| format!("weight {}", sum()))
}
