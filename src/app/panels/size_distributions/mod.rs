//! The page of size distributions.
//!
//! ```text
//! welcome     what can be brought here, before anything was
//! files       what was added, and how to look at it
//! curves      the curves by method, trial and photo
//! plot        percent passing, or percent error, over the size; log_axis its axis
//! results     the tabs beside it: fits, against_reference, repeatability, effort; table how they
//!             are drawn and copied
//! paste       the small window for a table
//! ```

mod asking;
mod curves;
mod files;
mod log_axis;
mod paste;
mod plot;
mod results;
mod settings;
mod table;
mod welcome;

pub(super) use asking::{add_distributions, add_effort, save_figure, save_report, save_table};
pub(super) use paste::paste;

use crate::NARROW;
use crate::command::Command;
use crate::panels::Scrolled;
use crate::state::State;

/// Draws the page.
pub fn size_distributions(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let width = ui.available_width();
    // As on the other pages a narrow window has panels of its own, and a third of it is left for the plot.
    let is_narrow = width < NARROW;
    let [left, right] = if is_narrow { [0.33; 2] } else { [0.4, 0.5] };
    if state.distributions.sources().is_empty() {
        egui::CentralPanel::default_margins().show(ui, |ui| {
            super::notice(state, ui, commands);
            welcome::welcome(state, ui, commands);
        });
        return;
    }
    if state.preferences.left_open {
        egui::Panel::left(("distributions", is_narrow))
            .resizable(true)
            .default_size((width * 0.25).clamp(270.0, 400.0))
            .min_size(180.0)
            .max_size((width * left).max(180.0))
            .show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .auto_shrink(false)
                    .show_focused(ui, |ui| {
                        files::files(state, ui, commands);
                        ui.separator();
                        settings::settings(state, ui, commands);
                        ui.separator();
                        curves::curves(state, ui, commands);
                    });
            });
    }
    if state.preferences.right_open {
        egui::Panel::right(("distribution results", is_narrow))
            .resizable(true)
            .default_size((width * 0.36).clamp(260.0, 480.0))
            .min_size(220.0)
            .max_size((width * right).max(220.0))
            .show(ui, |ui| results::results(state, ui, commands));
    }
    egui::CentralPanel::default_margins().show(ui, |ui| {
        super::notice(state, ui, commands);
        plot::plot(state, ui, commands);
    });
}
