//! What a window left behind that ended badly is offered in a strip below the menu.

use crate::command::Command;
use crate::kept_aside::KeptStep;
use crate::state::State;

/// Draws a strip for each flight whose changes were kept aside; nothing where there are none.
pub fn kept_aside(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    if state.kept_aside.offered().next().is_none() {
        return;
    }
    egui::Panel::top("kept aside").show(ui, |ui| {
        for (place, of, at) in state.kept_aside.offered() {
            ui.horizontal_wrapped(|ui| {
                let said = format!(
                    "{}: changes that were not saved when the program ended were kept ({at}).",
                    of.name
                );
                ui.label(said).on_hover_text(of.file.display().to_string());
                let open = ui.button("Open them");
                if open
                    .on_hover_text("The flight with these changes; saving proposes the file it was saved in before")
                    .clicked()
                {
                    commands.push(Command::Kept(KeptStep::Open(place)));
                }
                let later = ui.button("Not now");
                if later
                    .on_hover_text("They stay, and are offered again when the program starts")
                    .clicked()
                {
                    commands.push(Command::Kept(KeptStep::PutOff(place)));
                }
            });
        }
    });
}
