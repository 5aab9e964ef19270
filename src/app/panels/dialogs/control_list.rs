//! The small window that asks for a list of control points.

use std::path::Path;

use crate::command::{Command, Dialog};
use crate::control_points::ControlStep;
use crate::panels::path_field::taken_path;
use crate::state::State;

/// Draws the window's contents.
pub(super) fn control_list(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label(
        "A table with a header (name, x, y, z or longitude, latitude, height), or OpenDroneMap's gcp_list.txt, with \
         marks or without. Points of the same name are replaced; undo takes all of it back.",
    );
    let browse = [("Browse…", Dialog::file("List of control points"))];
    if let Some(path) = taken_path(state, ui, Path::new(""), &browse, "Load the list", commands) {
        commands.push(Command::Control(ControlStep::Load(path)));
    }
}
