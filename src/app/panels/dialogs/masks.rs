//! The small window that asks for the outlines of a photo that another tool made.

use crate::command::{Command, Dialog};
use crate::fragments::FragmentStep;
use crate::panels::path_field::path_field;
use crate::state::State;
use crate::typed::typed;

/// Draws the window's contents.
pub(super) fn masks(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let selected = state
        .open
        .as_ref()
        .and_then(|open| Some(open.name(open.selected?)));
    let Some(photo) = selected else {
        ui.label("Select a photo first.");
        return;
    };
    ui.label(format!(
        "The outlines of {photo}: a label image (PNG, TIFF), COCO, LabelMe, CVAT or GeoJSON in pixels, or a folder that has \
         them under the photo's name. Undo brings back what is outlined now.",
    ));
    let browse = [
        ("File…", Dialog::file("Outlines of this photo")),
        ("Folder…", Dialog::folder("Folder of outlines")),
    ];
    let (path, entered) = path_field(state, ui, "", &browse, commands);
    ui.separator();
    let path = typed(&path);
    let button = ui.add_enabled(path.is_some(), egui::Button::new("Take the outlines"));
    if let Some(path) = path
        && (button.clicked() || entered)
    {
        commands.push(Command::Fragments(FragmentStep::Masks(path)));
        commands.push(Command::Ask(None));
    }
}
