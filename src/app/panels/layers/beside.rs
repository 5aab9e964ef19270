//! The clouds beside the surface: on and off, colour, away.

use crate::actions;
use crate::command::Command;
use crate::open_flight::beside::BesideStep;
use crate::panels::tool_bar::action_button;
use crate::state::State;

/// Draws the list, and the button that adds to it.
pub(super) fn beside(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    for (place, cloud) in open.beside.iter().enumerate() {
        let name = cloud.name();
        ui.horizontal(|ui| {
            let remove = ui.small_button("✖");
            let label = format!("Remove layer {name}");
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if remove.on_hover_text(&label).clicked() {
                commands.push(Command::Beside(BesideStep::Remove(place)));
            }
            let mut color = cloud.color.unwrap_or([184, 180, 172]);
            let before = color;
            let button = ui.color_edit_button_srgb(&mut color);
            let label = format!("Colour of {name}");
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            button.on_hover_text("The one colour of its points");
            if color != before {
                commands.push(Command::Beside(BesideStep::Color(place, Some(color))));
            }
            let own = cloud.color.is_none();
            let button = ui.selectable_label(own, "own");
            let label = format!("Own colours of {name}");
            button
                .widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, own, &label));
            if button.on_hover_text("The colours of its file").clicked() {
                let next = own.then_some(before);
                commands.push(Command::Beside(BesideStep::Color(place, next)));
            }
            let mut shown = cloud.is_shown;
            let font = egui::TextStyle::Button.resolve(ui.style());
            let fitted = crate::names::fitted(ui, &name, &font, 100.0).into_owned();
            let check = ui.checkbox(&mut shown, fitted);
            check.widget_info(|| {
                let label = format!("Layer {name}");
                egui::WidgetInfo::selected(egui::Role::CheckBox, true, shown, label)
            });
            let hover = format!(
                "{}: drawn beside the surface; scales never depend on it",
                cloud.path.display()
            );
            if check.on_hover_text(hover).changed() {
                commands.push(Command::Beside(BesideStep::Show(place, shown)));
            }
        });
    }
    action_button(
        state,
        actions::file::ADD_LAYER,
        "Add cloud as layer…",
        ui,
        commands,
    );
}
