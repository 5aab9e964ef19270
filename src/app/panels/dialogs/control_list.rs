//! The small window that asks for a list of control points.

use crate::command::{Command, Dialog};
use crate::control_points::ControlStep;
use crate::panels::path_field::path_field;
use crate::state::State;
use crate::typed::typed;

/// Draws the window's contents.
pub(super) fn control_list(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label(
        "A table with a header (name, x, y, z or longitude, latitude, height), or OpenDroneMap's gcp_list.txt, with \
         marks or without. Points of the same name are replaced; undo takes all of it back.",
    );
    let browse = [("Browse…", Dialog::file("List of control points"))];
    let (path, entered) = path_field(state, ui, "", &browse, commands);
    ui.separator();
    let path = typed(&path);
    let button = ui.add_enabled(path.is_some(), egui::Button::new("Load the list"));
    if let Some(path) = path
        && (button.clicked() || entered)
    {
        commands.push(Command::Control(ControlStep::Load(path)));
    }
}
