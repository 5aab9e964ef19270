//! The list of points that were picked.

use crate::command::{Asking, Command, MeasuredTable};
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::picked::PickStep;
use crate::panels::Scrolled;
use crate::panels::field::text_field;

/// The small window while the tool is taken; it can be moved.
pub(super) fn picked_panel(
    open: &OpenFlight,
    context: &egui::Context,
    place: egui::Rect,
    commands: &mut Vec<Command>,
) {
    if !open.pointer.picked.is_on {
        return;
    }
    let mut stays = true;
    egui::Window::new("Points")
        .open(&mut stays)
        .constrain_to(place)
        .default_pos(place.left_bottom() + egui::vec2(8.0, -8.0))
        .pivot(egui::Align2::LEFT_BOTTOM)
        .default_width((place.width() - 16.0).clamp(180.0, 400.0))
        .resizable([true, false])
        .show(context, |ui| list(open, place, ui, commands));
    if !stays {
        commands.push(Command::Pick(PickStep::Toggle));
    }
    copied(open, context, commands);
}

fn list(open: &OpenFlight, place: egui::Rect, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let points = open.pointer.picked.list();
    if points.is_empty() {
        ui.weak("Click on the surface to pick points.");
    }
    let unit = open.measured_unit().length();
    let crs = open.files.crs.as_deref();
    if !points.is_empty() {
        ui.weak(match crs {
            Some(crs) => format!("x (east), y (north), z in {unit}, {crs}"),
            None => format!("x, y, z in {unit}"),
        });
    }
    let most = (place.height() * 0.4).max(60.0);
    egui::ScrollArea::vertical()
        .max_height(most)
        .show_focused(ui, |ui| rows(open, ui, commands));
    ui.horizontal_wrapped(|ui| {
        let is_some = !points.is_empty();
        let hover = "The list as a table with tabs between its columns, all digits (Ctrl+C)";
        // Written out only when it is asked for.
        let button = ui.add_enabled(is_some, egui::Button::new("Copy table"));
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Copy(open.picked_table()));
            commands.push(Command::Pick(PickStep::Copied));
        }
        let button = ui.add_enabled(is_some, egui::Button::new("Save CSV…"));
        if button
            .on_hover_text("The list with all digits as a CSV file")
            .clicked()
        {
            let asking = Asking::SaveMeasured(MeasuredTable::Points);
            commands.push(Command::Ask(Some(asking)));
        }
        let button = ui.add_enabled(is_some, egui::Button::new("Remove all"));
        let hover = "Empty the list; undo (Ctrl+Z) brings it back while this window is open";
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Pick(PickStep::RemoveAll));
        }
    });
}

fn rows(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let points = open.pointer.picked.list();
    egui::Grid::new("picked points")
        .num_columns(3)
        .striped(true)
        .show(ui, |ui| {
            for (place, picked) in points.iter().enumerate() {
                let name = &picked.name;
                let label = format!("Name of point {}", place + 1);
                let hover = "What the point is called; click to write another name";
                if let Some(name) = text_field(ui, &label, hover, name, 70.0) {
                    commands.push(Command::Pick(PickStep::Rename(place, name)));
                }
                let [x, y, z] = picked.point.to_array();
                let text = format!("{x:.3}  {y:.3}  {z:.3}");
                let go = ui.selectable_label(false, text);
                go.widget_info(|| {
                    let label = format!("Go to {name}");
                    egui::WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                let hover = format!("Go there: {x}  {y}  {z}");
                if go.on_hover_text(hover).clicked() {
                    commands.push(Command::Pick(PickStep::GoTo(place)));
                }
                let remove = ui.small_button("✖");
                let label = format!("Remove {name}");
                remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
                let hover = format!("{label}; undo (Ctrl+Z) brings it back");
                if remove.on_hover_text(hover).clicked() {
                    commands.push(Command::Pick(PickStep::Remove(place)));
                }
                ui.end_row();
            }
        });
}

/// Ctrl+C copies the table while the tool is taken.
fn copied(open: &OpenFlight, context: &egui::Context, commands: &mut Vec<Command>) {
    let asks = |input: &egui::InputState| {
        // With Shift the scales are copied.
        input.events.contains(&egui::Event::Copy) && !input.modifiers.shift
    };
    let is_some = !open.pointer.picked.list().is_empty();
    if is_some && !context.text_edit_focused() && context.input(asks) {
        commands.push(Command::Copy(open.picked_table()));
        commands.push(Command::Pick(PickStep::Copied));
    }
}
