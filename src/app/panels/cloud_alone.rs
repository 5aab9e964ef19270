//! What stands in the place of the table of photos while a cloud without photos is looked at.

use crate::command::{Asking, Command};

/// Draws it.
pub(super) fn cloud_alone(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let text = "A cloud without photos: it can be measured, coloured and drawn. Scales need the cameras: \
                a flight.toml, what a photogrammetry package wrote, or a folder of drone photos.";
    ui.add(egui::Label::new(text).wrap());
    let add = ui.button("Add cameras…");
    let hover = "Open the cameras of this cloud; it becomes their surface";
    if add.on_hover_text(hover).clicked() {
        commands.push(Command::Ask(Some(Asking::Add)));
    }
}
