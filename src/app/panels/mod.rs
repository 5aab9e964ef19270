//! The parts of the window. Each is a function that reads the state and sends commands.

mod ask;
mod field;
mod flight_settings;
mod georeference;
mod inspector;
mod layers_panel;
mod limits_page;
mod log_panel;
mod menu_bar;
mod photos_table;
mod residuals;
mod scale_objects;
mod size_distributions;
mod start_page;
mod status_bar;
mod tool_bar;
mod traced_photo;
mod view_buttons;

pub use ask::ask;
pub(super) use ask::typed;
pub use inspector::Inspector;
pub use layers_panel::layers_panel;
pub use log_panel::{log_panel, notice};
pub use menu_bar::menu_bar;
pub use photos_table::photos_table;
pub use size_distributions::size_distributions;
pub use start_page::start_page;
pub use status_bar::status_bar;
pub use tool_bar::tool_bar;
pub use view_buttons::{blend_slider, view_buttons};

use super::command::{Command, Tab};
use super::state::State;
use crate::flight::Verdict;
use crate::numbers::significant_digits;

/// The right panel: its tabs and the one that is shown.
pub fn right_panel(
    state: &State,
    inspector: &mut Inspector,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        for (tab, name, hover) in [
            (Tab::Photo, "Photo", "The selected photo and its scale"),
            (Tab::Flight, "Flight", "The flight's settings"),
            (Tab::Limits, "Limits", "When a photo's scale is doubted"),
        ] {
            let shown = ui
                .selectable_label(state.tab == tab, name)
                .on_hover_text(hover);
            shown.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::Tab, true, state.tab == tab, name)
            });
            if shown.clicked() {
                commands.push(Command::Tab(tab));
            }
        }
    });
    ui.separator();
    match state.tab {
        Tab::Photo => inspector.show(state, ui, commands),
        Tab::Flight => {
            egui::ScrollArea::vertical().show(ui, |ui| {
                flight_settings::flight_settings(state, ui, commands);
            });
        }
        Tab::Limits => {
            egui::ScrollArea::vertical().show(ui, |ui| {
                limits_page::limits_page(state, ui, commands);
            });
        }
    }
}

/// The colour of a verdict: told apart by brightness too.
pub fn verdict_color(verdict: Verdict, visuals: &egui::Visuals) -> egui::Color32 {
    match (verdict, visuals.dark_mode) {
        (Verdict::Trust, true) => egui::Color32::from_rgb(110, 200, 130),
        (Verdict::Trust, false) => egui::Color32::from_rgb(20, 120, 50),
        (Verdict::Check, true) => egui::Color32::from_rgb(255, 190, 80),
        (Verdict::Check, false) => egui::Color32::from_rgb(160, 90, 0),
        (Verdict::NoScale, true) => egui::Color32::from_rgb(255, 110, 110),
        (Verdict::NoScale, false) => egui::Color32::from_rgb(180, 20, 30),
    }
}

/// A sign before a verdict, so that colour is not all.
pub fn verdict_sign(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Trust => "✔",
        Verdict::Check => "⚠",
        Verdict::NoScale => "✖",
    }
}

/// A number that may be missing.
fn or_dash(value: Option<f64>, digits: u8) -> String {
    value.map_or_else(|| "–".to_owned(), |value| significant_digits(value, digits))
}
