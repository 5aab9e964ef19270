//! What stands over the photo: what is shown of it, and how large.

use crate::actions::{self, Action};
use crate::command::Command;
use crate::names;
use crate::open_flight::OpenFlight;
use crate::photo_view::{Middle, PhotoCommand};
use crate::scale::ImageKind;
use crate::size_distributions::Page;
use crate::state::State;

/// Draws it.
pub(super) fn head(
    state: &State,
    open: &OpenFlight,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        let mut button = |action: Action, text: &str, on: bool, ui: &mut egui::Ui| {
            let command = (action.command)(state);
            let button = ui.add_enabled(command.is_some(), egui::Button::selectable(on, text));
            // The buttons over the pile have the actions' own names.
            let label = format!("Photo view: {}", action.label);
            button.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::Button, command.is_some(), on, &label)
            });
            let keys = action.shortcut.map(|keys| ui.ctx().format_shortcut(&keys));
            let hover = format!("{} ({})", action.hover, keys.unwrap_or_default());
            if button.on_hover_text(hover).clicked() {
                commands.extend(command);
            }
        };
        if state.middle == Middle::Photo && state.page == Page::Pile {
            button(actions::view::PHOTO_ALONE, "Pile", false, ui);
            button(actions::view::PHOTO_BESIDE, "Both", false, ui);
            ui.separator();
        }
        button(
            actions::view::PHOTO_FIT,
            "Fit",
            open.photo_view.placing.zoom.is_none(),
            ui,
        );
        let is_one = open.photo_view.placing.zoom == Some(1.0);
        button(actions::view::PHOTO_ONE_TO_ONE, "1:1", is_one, ui);
        ui.separator();
        if state.page == Page::Fragments {
            if let Some(photo) = open.selected {
                names::name(ui, open.name(photo));
            }
            return;
        }
        let shown = open.photo_view.image_for(open.flight().parts().image);
        for (image, name, hover) in [
            (
                ImageKind::Undistorted,
                "Undistorted",
                "Without the lens, as pinhole cameras see it",
            ),
            (ImageKind::AsShot, "As shot", "The pixels of the file"),
        ] {
            let on = shown == image;
            let label = ui.selectable_label(on, name).on_hover_text(hover);
            label.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::RadioButton, true, on, name)
            });
            if label.clicked() {
                commands.push(Command::Photo(PhotoCommand::Image(image)));
            }
        }
        overlays(state, ui, commands);
        let of_scale = open.flight().parts().image;
        if state.preferences.tint && shown != of_scale {
            ui.weak(match of_scale {
                ImageKind::Undistorted => "The tint is of the undistorted photo.",
                ImageKind::AsShot => "The tint is of the photo as shot.",
            });
        }
        if let Some(photo) = open.selected {
            names::name(ui, open.name(photo));
        }
    });
}

/// What lies over the photo.
fn overlays(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let before = state.preferences.photo_overlays;
    let mut now = before;
    ui.menu_button("Overlays ⏷", |ui| {
        for (on, name, hover) in [
            (
                &mut now.edges,
                "Edges",
                "The edges of the image that the scale is for",
            ),
            (
                &mut now.bars,
                "Bars",
                "Bars of known length at the top and the bottom",
            ),
            (&mut now.grid, "Grid", "Eighths of the image"),
            (
                &mut now.corners,
                "Corners",
                "The corners, and what they lie on",
            ),
            (
                &mut now.isolines,
                "Lines of equal scale",
                "While the photo is tinted by its scale",
            ),
        ] {
            ui.checkbox(on, name).on_hover_text(hover);
        }
    });
    if now != before {
        commands.push(Command::Photo(PhotoCommand::Overlays(now)));
    }
}
