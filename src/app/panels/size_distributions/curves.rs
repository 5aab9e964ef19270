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
            check(state, method, method, &curves, ui, commands);
            if is_reference {
                ui.weak("reference");
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
            check(state, &name, text, &photos, ui, commands);
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
                    check(state, &name, &photo.labels.photo, &[photo], ui, commands);
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

/// The box that draws these curves, or not.
fn check(
    state: &State,
    name: &str,
    text: &str,
    curves: &[&LabelledDistribution],
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let hidden = &state.distributions.hidden;
    let shown = curves.iter().filter(|c| !hidden.contains(&c.labels));
    let shown = shown.count();
    let mut all = shown == curves.len();
    let mixed = shown > 0 && !all;
    let font = egui::TextStyle::Button.resolve(ui.style());
    let spacing = ui.spacing();
    // What else is in the row: the box itself, "reference", the weight.
    let weight = weight_of(curves).map_or(0.0, |weight| text_width(ui, &weight));
    let others = spacing.icon_width + spacing.icon_spacing + 90.0 + weight;
    let width = (ui.available_width() - others).max(40.0);
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
