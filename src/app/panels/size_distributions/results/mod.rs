//! The results beside the plot: their tabs, and the one that is shown.

mod against_reference;
mod effort;
mod fits;
mod repeatability;
mod sentence;

use crate::command::Command;
use crate::panels::Scrolled;
use crate::size_distributions::{DistributionCommand, ResultTab};
use crate::state::State;

/// Draws the tabs and the results.
pub(super) fn results(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        for (tab, name, hover) in [
            (
                ResultTab::Fits,
                "Fits",
                "The fitted functions and what they say",
            ),
            (
                ResultTab::Reference,
                "Against the reference",
                "Errors, norms and shifts of every method",
            ),
            (
                ResultTab::Repeatability,
                "Repeatability",
                "Whether the trials of a method are alike: analysis of variance",
            ),
            (ResultTab::Effort, "Time effort", "How long each step took"),
        ] {
            let chosen = state.distributions.tab == tab;
            let button = ui.selectable_label(chosen, name).on_hover_text(hover);
            button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, chosen, name));
            if button.clicked() {
                commands.push(Command::Distributions(DistributionCommand::Tab(tab)));
            }
        }
    });
    ui.separator();
    egui::ScrollArea::vertical()
        .id_salt("results")
        .auto_shrink(false)
        .show_focused(ui, |ui| {
            if state.distributions.tab == ResultTab::Effort {
                effort::effort(state, ui, commands);
                return;
            }
            let Some(computed) = &state.distributions.computed else {
                return;
            };
            if !state.distributions.is_current() {
                // The numbers of the settings before are told from those of now.
                ui.multiply_opacity(0.5);
            }
            match state.distributions.tab {
                ResultTab::Fits => fits::fits(computed, ui, commands),
                ResultTab::Reference => against_reference::show(computed, ui, commands),
                ResultTab::Repeatability => repeatability::show(computed, ui, commands),
                ResultTab::Effort => {}
            }
        });
}
