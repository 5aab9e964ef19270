//! What a cloud is to be that was dropped or opened beside the flight on the screen.

use crate::command::Command;
use crate::names;
use crate::state::State;

/// Draws a button for each use; each does what its entry in the menu does.
pub(super) fn cloud_use(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let (Some(path), Some(open)) = (&state.cloud, &state.open) else {
        return;
    };
    let body = egui::TextStyle::Body.resolve(ui.style());
    let file = path.file_name().unwrap_or(path.as_os_str());
    let file = names::fitted(ui, &file.to_string_lossy(), &body, 400.0).into_owned();
    let flight = names::fitted(ui, &open.flight().parts().name, &body, 300.0).into_owned();
    ui.label(file).on_hover_text(path.display().to_string());
    ui.label(format!("{flight} is open. What is the cloud to it?"));
    ui.add_space(6.0);
    let uses = [
        (
            "Use as the surface",
            "Scales and footprints are computed anew, on this cloud; undone by opening the flight again",
            Command::Add(path.clone()),
        ),
        (
            "Show beside the surface",
            "Its points are drawn, in a colour of their own; scales never depend on them",
            Command::AddLayer(path.clone()),
        ),
        (
            "Use as the base of volumes",
            "Volumes are counted between it and the surface, such as over the floor before",
            Command::VolumeBase(path.clone()),
        ),
        (
            "Open on its own",
            "The flight on the screen is closed, and the cloud is looked at alone",
            Command::OpenAlone(path.clone()),
        ),
    ];
    for (label, what, command) in uses {
        let button = egui::Button::new(label).min_size(egui::vec2(220.0, 0.0));
        if ui.add(button).clicked() {
            commands.push(command);
        }
        ui.indent(label, |ui| ui.weak(what));
        ui.add_space(2.0);
    }
    ui.separator();
    if ui.button("Cancel").clicked() {
        commands.push(Command::Ask(None));
    }
}
