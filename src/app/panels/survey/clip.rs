//! The clipping box's small window.

use crate::command::Command;
use crate::geometry::LevelBox;
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::clip::ClipStep;

/// What it is good for, and what not.
const HOVER: &str = "Of surface and points only what lies in the box is seen and met by the mouse, also in saved \
                     pictures. Scales, footprints, profiles and volumes never depend on it";

/// The small window; it can be moved.
pub(super) fn clip_panel(
    open: &OpenFlight,
    context: &egui::Context,
    place: egui::Rect,
    commands: &mut Vec<Command>,
) {
    if !open.clip.is_open {
        return;
    }
    let held = context.input(|input| input.pointer.any_down());
    if !held && open.clip.level != *open.clip_history.now() {
        commands.push(Command::Clip(ClipStep::Settle));
    }
    let mut stays = true;
    egui::Window::new("Clipping box")
        .open(&mut stays)
        .constrain_to(place)
        // Above the other tools' windows, which begin at the foot.
        .default_pos(place.right_top() + egui::vec2(-8.0, 48.0))
        .pivot(egui::Align2::RIGHT_TOP)
        .resizable(false)
        .show(context, |ui| controls(open, ui, commands));
    if !stays {
        commands.push(Command::Clip(ClipStep::Close));
    }
}

fn controls(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let mut on = open.clip.is_on;
    if ui.checkbox(&mut on, "Clip").on_hover_text(HOVER).changed() {
        commands.push(Command::Clip(ClipStep::On(on)));
    }
    let now = open.clip.level;
    let mut next = now;
    let speed = (open.extent.bulk.size().max_element() / 400.0).max(1e-9);
    let unit = open.flight().parts().unit_of_lengths();
    egui::Grid::new("limits of the clipping box")
        .num_columns(4)
        .show(ui, |ui| {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                ui.label(name);
                for (limit, end) in [(&mut next.low, "from"), (&mut next.high, "to")] {
                    let label = format!("Clip {name} {end}");
                    let hover = match axis {
                        2 => format!("{label}, {unit}: drag, or click to type"),
                        _ => format!(
                            "{label}, {unit}, along the turned axis: drag, or click to type"
                        ),
                    };
                    number(&mut limit[axis], speed, &label, &hover, ui);
                }
                ui.label(unit);
                ui.end_row();
            }
            ui.label("turn");
            let mut turn = now.turn.to_degrees();
            let before = turn;
            let hover = "Turns the box about its middle, degrees counter-clockwise from above";
            number(&mut turn, 0.5, "Clip turn", hover, ui);
            if turn != before {
                next = now.turned_to(turn.to_radians());
            }
            ui.label("°");
            ui.end_row();
        });
    ui.horizontal(|ui| {
        let hover = "Around the whole surface, without points that lie far off it";
        if ui.button("Fit box").on_hover_text(hover).clicked() {
            commands.push(Command::Clip(ClipStep::Fit));
        }
        let has = open.around_footprint().is_some();
        let button = ui.add_enabled(has, egui::Button::new("To the footprint"));
        let hover = "Around the footprint of the selected photo, over all heights";
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Clip(ClipStep::ToFootprint));
        }
    });
    if next != now && LevelBox::is_box(&next) {
        commands.push(Command::Clip(ClipStep::Set(next)));
    }
}

fn number(value: &mut f64, speed: f64, label: &str, hover: &str, ui: &mut egui::Ui) {
    let mut shown = *value;
    let field = egui::DragValue::new(&mut shown)
        .speed(speed)
        .max_decimals(3);
    let field = ui.add(field);
    field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, label));
    // A number that is only shown keeps its digits.
    if field.on_hover_text(hover).changed() {
        *value = shown;
    }
}
