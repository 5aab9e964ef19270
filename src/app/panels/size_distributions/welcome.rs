//! What can be brought to the page of size distributions, before anything was.

use crate::actions;
use crate::command::Command;
use crate::panels::Scrolled;
use crate::panels::working::working;
use crate::state::State;

/// Draws the page without data.
pub(super) fn welcome(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    egui::ScrollArea::vertical().show_focused(ui, |ui| {
        ui.vertical_centered(|ui| {
            ui.add_space((ui.available_height() * 0.1).min(70.0));
            ui.heading(egui::RichText::new("Size distributions").size(26.0));
            ui.label("What Split-Desktop or a sieve gave: can it be trusted?");
            ui.add_space(16.0);
            for action in [
                actions::file::ADD_DISTRIBUTIONS,
                actions::file::PASTE_TABLE,
                actions::file::ADD_KNOWN,
            ] {
                let command = (action.command)(state);
                let text = egui::RichText::new(action.label).size(16.0);
                let button = egui::Button::new(text).min_size(egui::vec2(300.0, 34.0));
                let button = ui.add_enabled(command.is_some(), button);
                let button = button.on_disabled_hover_text("Open a flight first");
                if button.on_hover_text(action.hover).clicked() {
                    commands.extend(command);
                }
                ui.add_space(4.0);
            }
            ui.add_space(12.0);
            ui.weak("or drop tables on this window: CSV, one line a point or one column a curve,");
            ui.weak(
                "cumulative percent passing by size, of one or many methods, trials and photos",
            );
            if state
                .work
                .is_running(crate::tasks::work::Task::READ_DISTRIBUTIONS)
            {
                ui.add_space(14.0);
                working(ui);
            }
        });
    });
}
