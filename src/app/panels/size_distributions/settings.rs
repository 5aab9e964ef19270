//! How the size distributions are looked at.

use egui::{Grid, Ui};

use crate::command::Command;
use crate::fragmentation::{Model, SieveSeries, Weighting};
use crate::panels::field::{combo_box, number_field};
use crate::size_distributions::{DistributionCommand, Settings};
use crate::state::State;
use crate::units::LengthUnit;

/// The units that sizes are wanted in.
const UNITS: [LengthUnit; 5] = [
    LengthUnit::Millimetre,
    LengthUnit::Centimetre,
    LengthUnit::Metre,
    LengthUnit::Inch,
    LengthUnit::Foot,
];

/// Draws the fields.
pub(super) fn settings(state: &State, ui: &mut Ui, commands: &mut Vec<Command>) {
    let before = state.distributions.settings();
    let mut settings = before.clone();
    let edge = ui.max_rect().right();
    Grid::new("distribution settings")
        .num_columns(2)
        .spacing([8.0, 4.0])
        .show(ui, |ui| {
            ui.label("Sizes in");
            ui.horizontal_wrapped(|ui| {
                // Closer together: the column is as wide as they are, where it can be.
                ui.spacing_mut().item_spacing.x = 2.0;
                for unit in UNITS {
                    let chosen = settings.unit == unit;
                    let button = ui.selectable_label(chosen, unit.symbol());
                    let button = button.on_hover_text(format!("Show sizes in {unit}"));
                    button.widget_info(|| {
                        let label = format!("Sizes in {unit}");
                        egui::WidgetInfo::selected(egui::Role::RadioButton, true, chosen, label)
                    });
                    if button.clicked() {
                        settings.unit = unit;
                    }
                }
            });
            ui.end_row();
            ui.label("Function");
            let models = Model::ALL.map(|model| (model, model.name().to_owned()));
            let hover = "Which function is fitted to the curves, by least squares";
            choice("Function", hover, &models, &mut settings.model, edge, ui);
            ui.end_row();
            reference(state, &mut settings, edge, ui);
            ui.end_row();
            ui.label("Photos by");
            let weightings = [
                (Weighting::Equal, "equal weight".to_owned()),
                (Weighting::Area, "area".to_owned()),
                (Weighting::Mass, "mass".to_owned()),
            ];
            let hover = "What each photo counts by where the photos of a trial are merged; area and \
                         mass come from the table's column of weights";
            choice("Merge photos by", hover, &weightings, &mut settings.merging, edge, ui);
            ui.end_row();
            ui.label("Sieves");
            let mut sieves = vec![(None, "as measured".to_owned())];
            sieves.extend(SieveSeries::ALL.map(|series| (Some(series), series.name().to_owned())));
            let hover = "Bring every curve to the sieves of a series, linear in the logarithm of the \
                         size between its points";
            choice("Sieves", hover, &sieves, &mut settings.sieves, edge, ui);
            ui.end_row();
            ui.label("Envelope ±");
            ui.horizontal(|ui| {
                let hover = "Around the reference's sizes; 30 % after Sanchidrián and others (2009)";
                let percent = settings.envelope_percent;
                if let Some(percent) = number_field(ui, "Envelope percent", hover, percent, "%") {
                    settings.envelope_percent = percent.clamp(0.1, 99.0);
                }
            });
            ui.end_row();
            ui.label("Level");
            ui.horizontal(|ui| {
                let hover = "Of significance: 0.05 gives bands of 95 % and the F that one in twenty \
                             exceeds by chance";
                let level = settings.level;
                if let Some(level) = number_field(ui, "Level of significance", hover, level, "") {
                    settings.level = level.clamp(1e-6, 0.5);
                }
            });
            ui.end_row();
        });
    if settings != *before {
        let command = DistributionCommand::Set(settings);
        commands.push(Command::Distributions(command));
    }
}

/// The method that the others are held against.
fn reference(state: &State, settings: &mut Settings, edge: f32, ui: &mut Ui) {
    ui.label("Reference");
    let computed = state.distributions.computed.as_ref();
    let methods = computed.map_or(&[][..], |computed| &computed.analysis.methods);
    let now = computed.and_then(|computed| computed.analysis.reference.clone());
    let offered: Vec<(Option<String>, String)> = methods
        .iter()
        .map(|method| (Some(method.clone()), method.clone()))
        .collect();
    let mut chosen = now.clone();
    let hover = "The method that the others are held against: the sieve";
    choice("Reference", hover, &offered, &mut chosen, edge, ui);
    if chosen != now {
        settings.reference = chosen;
    }
}

/// How wide a list is where there is room, points, and where there is none.
const LIST: f32 = 150.0;
const NARROW_LIST: f32 = 60.0;

/// A list to choose from, which ends before the panel's `edge`.
fn choice<T: PartialEq + Clone>(
    name: &str,
    hover: &str,
    offered: &[(T, String)],
    chosen: &mut T,
    edge: f32,
    ui: &mut Ui,
) {
    let room = edge - ui.cursor().left();
    let text = offered.iter().find(|(value, _)| value == chosen);
    let text = text.map_or("–", |(_, text)| text.as_str());
    let combo = egui::ComboBox::from_id_salt(name)
        .selected_text(text)
        .width(room.clamp(NARROW_LIST, LIST))
        .truncate()
        .show_ui(ui, |ui| {
            for (value, text) in offered {
                ui.selectable_value(chosen, value.clone(), text);
            }
        });
    combo_box(&combo.response.on_hover_text(hover), name, text);
}
