//! The small windows that ask for the outlines of a photo that another tool made, and where the results of the fragments go.

use std::path::Path;

use crate::command::{Command, Dialog};
use crate::fragments::FragmentStep;
use crate::panels::path_field::taken_path;
use crate::scale::ImageKind;
use crate::state::State;

/// Which file has the outlines.
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
    let id = ui.scope_id().with("masks of");
    let mut of: Option<ImageKind> = ui.data(|data| data.get_temp(id)).flatten();
    ui.horizontal_wrapped(|ui| {
        ui.label("Outlined in");
        for (kind, name, hover) in [
            (
                None,
                "undistorted in fragscale's own files, else as shot",
                "What most files are: those that fragscale wrote are of the undistorted photo, all others of the photo as shot",
            ),
            (
                Some(ImageKind::AsShot),
                "the photo as shot",
                "As the camera took it",
            ),
            (
                Some(ImageKind::Undistorted),
                "the undistorted photo",
                "Without its lens, as fragscale exports it",
            ),
        ] {
            ui.radio_value(&mut of, kind, name).on_hover_text(hover);
        }
    });
    ui.data_mut(|data| data.insert_temp(id, of));
    let path = taken_path(
        state,
        ui,
        Path::new(""),
        &browse,
        "Take the outlines",
        commands,
    );
    // It closes itself once they are taken.
    if let Some(path) = path {
        commands.push(Command::Fragments(FragmentStep::Masks { path, of }));
    }
    let refused = state.open.as_ref();
    if let Some(message) = refused.and_then(|open| open.fragments.masks_refused.as_ref()) {
        ui.colored_label(ui.visuals().warn_fg_color, message);
    }
}

/// Which file describes the network.
pub(super) fn network(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label(
        "The TOML file that describes an ONNX model of yours, which lies beside it: what it takes and gives (docs/fragments.md, \"Your own \
         network\"). It runs on this computer alone.",
    );
    let browse = [("File…", Dialog::file("Description of the network"))];
    let path = taken_path(
        state,
        ui,
        Path::new(""),
        &browse,
        "Take the network",
        commands,
    );
    // It closes itself once it is read.
    if let Some(path) = path {
        commands.push(Command::Fragments(FragmentStep::Network(path)));
    }
    if let Some(message) = &state.network.refused {
        ui.colored_label(ui.visuals().warn_fg_color, message);
    }
}

/// Where tables, report and outlines go.
pub(super) fn export_fragments(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    ui.label(format!(
        "Of all photos that are outlined, as 'fragscale delineate' writes them, into one folder: outlines over the photo and in the \
         world, label images, tables of fragments, distributions and sizes in {}, and a page to read (report.html).",
        state.preferences.unit()
    ));
    let browse = [("Browse…", Dialog::folder("Folder for the fragments"))];
    let start = open.files.proposed(Some("fragment-sizes"));
    if let Some(path) = taken_path(state, ui, &start, &browse, "Write results", commands) {
        commands.push(Command::Fragments(FragmentStep::Export(path.into())));
    }
}
