//! Where a table of what was measured goes, and which cloud comes
//! beside the surface or under a volume.

use std::path::{Path, PathBuf};

use crate::command::{Command, Dialog, MeasuredTable};
use crate::panels::path_field::{path_to_write, taken_path};
use crate::state::State;

pub(super) fn save_measured(
    table: MeasuredTable,
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    let (what, dialog) = match table {
        MeasuredTable::Points => (
            "The picked points: name, x, y, z with all digits.",
            Dialog::new_file("Save points", "points.csv"),
        ),
        MeasuredTable::Profile => (
            "Every point of the profile: distance, x, y, height, as 'fragscale profile' writes it.",
            Dialog::new_file("Save profile", "profile.csv"),
        ),
        MeasuredTable::Volume => (
            "Fill, cut and areas in one line, as 'fragscale volume' writes it.",
            Dialog::new_file("Save volume", "volume.csv"),
        ),
    };
    ui.label(what);
    let start = open.files.proposed(Some(table.file_name()));
    let browse = [("Browse…", dialog)];
    if let Some(path) = path_to_write(state, ui, &start, &browse, "Write table", commands) {
        commands.push(Command::SaveMeasured(table, path.into()));
    }
}

/// Which cloud the volume is over.
pub(super) fn volume_base(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let what = "A cloud or mesh that the volume is over, such as the floor before:";
    let dialog = Dialog::file("Base of the volume");
    if let Some(path) = cloud(what, dialog, "Use it", state, ui, commands) {
        commands.push(Command::VolumeBase(path));
    }
}

/// Which cloud is drawn beside the surface.
pub(super) fn add_layer(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let what = "A cloud or mesh whose points are drawn beside the flight's surface. Scales never depend on it.";
    let dialog = Dialog::file("Cloud to draw beside the surface");
    if let Some(path) = cloud(what, dialog, "Add layer", state, ui, commands) {
        commands.push(Command::AddLayer(path));
    }
}

fn cloud(
    what: &str,
    dialog: Dialog,
    done: &str,
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) -> Option<PathBuf> {
    ui.label(what);
    let browse = [("Browse…", dialog)];
    taken_path(state, ui, Path::new(""), &browse, done, commands)
}
