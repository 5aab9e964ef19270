//! What was added to the page of size distributions.

use crate::actions;
use crate::command::Command;
use crate::names;
use crate::panels::tool_bar::action_button;
use crate::size_distributions::DistributionCommand;
use crate::state::State;

/// What is said of a curve of fragments that are others now.
const OUTDATED: &str = "the outlines, or the flight's unit, have changed since: send it again";

/// Draws the list of files and tables, with what was noticed while reading them.
pub(super) fn files(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    for (place, source) in state.distributions.sources().iter().enumerate() {
        let count = source.set.curves.len();
        let curves = if count == 1 { "curve" } else { "curves" };
        let counted = format!("{count} {curves}, {}", source.set.unit);
        ui.horizontal(|ui| {
            let remove = ui.small_button("✖");
            let label = format!("Remove {}", source.name);
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if remove.on_hover_text(&label).clicked() {
                commands.push(Command::Distributions(DistributionCommand::Remove(place)));
            }
            let path = source.path.as_ref().map(|path| path.display().to_string());
            let body = egui::TextStyle::Body;
            let name = names::styled(ui, &source.name, body, egui::RichText::strong);
            name.on_hover_text(path.as_deref().unwrap_or("A table that was pasted"));
        });
        ui.horizontal_wrapped(|ui| ui.weak(counted));
        let outdated = state.is_outdated(source).then_some(OUTDATED);
        let warnings = source.warnings.iter().map(String::as_str);
        for warning in warnings.chain(outdated) {
            let text = egui::RichText::new(format!("⚠ {warning}"));
            let text = text.color(ui.visuals().warn_fg_color).small();
            ui.add(egui::Label::new(text).wrap());
        }
    }
    if state.distributions.sources().len() > 1 {
        action_button(state, actions::edit::REMOVE_ALL, "Remove all", ui, commands);
    }
}
