//! The parts of the window. Each is a function that reads the state and sends commands.

mod accessible;
mod cloud_alone;
mod control_points;
mod corner_loupe;
mod corner_marks;
mod dialogs;
mod field;
mod flight_settings;
mod fragments;
mod inspector;
mod layers;
mod limits_page;
pub(crate) mod linked;
mod log_panel;
mod map;
mod menu_bar;
mod path_field;
mod photo_view;
mod photos_table;
mod planning;
mod review;
mod rows;
mod size_distributions;
mod start_page;
mod status_bar;
mod strips;
mod survey;
mod tool_bar;
mod verdict;
mod view_buttons;
mod working;

pub use accessible::{LastFocus, focus_ring, spoken};
pub(crate) use accessible::{Scrolled, described};
pub use control_points::control as control_points;
pub use corner_loupe::Crops;
pub use dialogs::ask;
pub use fragments::fragments;
pub use inspector::Inspector;
pub use layers::layers_panel;
use log_panel::reconstruct_offer;
pub use log_panel::{log_panel, notice};
pub use map::map;
pub use menu_bar::menu_bar;
pub use photo_view::PhotoPanel;
pub use photos_table::photos_table;
pub use planning::{asked_of_plan, planned_photos};
pub use size_distributions::size_distributions;
pub use start_page::start_page;
pub use status_bar::status_bar;
pub use strips::{health, kept_aside};
pub use survey::survey_panel;
pub use tool_bar::tool_bar;
pub use verdict::{line_color, verdict_color, verdict_sign};
pub use view_buttons::{blend_slider, view_buttons};

use crate::command::{Command, Tab};
use crate::open_flight::OpenFlight;
use crate::state::State;

/// The rows over what is in the middle of the window; none begins at the very edge.
fn head_of_middle(ui: &mut egui::Ui, rows: impl FnOnce(&mut egui::Ui)) {
    let margin = egui::Margin::symmetric(6, 0);
    egui::Frame::new().inner_margin(margin).show(ui, rows);
}

/// What scales are shown in ("px/cm"), and how many times a scale in pixels per unit of the world that is. Of a
/// model whose unit nobody states, the model's own.
fn shown_per(state: &State, open: &OpenFlight) -> (String, f64) {
    let parts = open.flight().parts();
    let unit = state.preferences.unit();
    match parts.unit_known {
        true => (format!("px/{unit}"), unit.in_units_of(parts.unit)),
        false => ("px per unit of the model".to_owned(), 1.0),
    }
}

/// What lengths are shown and typed in, and how many times one of the world that is. Of a model whose unit nobody states, its own.
fn shown_lengths(state: &State, open: &OpenFlight) -> (&'static str, f64) {
    let parts = open.flight().parts();
    let unit = state.preferences.unit();
    match parts.unit_known {
        true => (unit.symbol(), parts.unit.in_units_of(unit)),
        false => (parts.unit_of_lengths(), 1.0),
    }
}

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
            (
                Tab::Review,
                "Review",
                "The doubtful photos, one after the other: accept them or leave them out",
            ),
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
        Tab::Review => review::review(state, inspector, ui, commands),
        Tab::Flight => {
            egui::ScrollArea::vertical().show_focused(ui, |ui| {
                flight_settings::flight_settings(state, ui, commands);
            });
        }
        Tab::Limits => {
            egui::ScrollArea::vertical().show_focused(ui, |ui| {
                limits_page::limits_page(state, ui, commands);
            });
        }
    }
}
