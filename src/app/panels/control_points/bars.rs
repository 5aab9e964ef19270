//! The scale bars: two points with a known distance each.

use crate::command::Command;
use crate::control::ScaleBar;
use crate::control_points::ControlStep;
use crate::names::unbroken;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::field::{combo_box, number_field, settled, text_field};
use crate::units::LengthUnit;

/// Draws them.
pub(super) fn bars(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let list = open.control_list();
    ui.horizontal(|ui| {
        ui.label("Scale bars");
        let button = ui.add_enabled(list.points.len() > 1, egui::Button::new("Add scale bar"));
        let hover = "Two points whose distance is known: alone they give the unit, beside surveyed points they check";
        let button = button.on_hover_text(hover);
        if button.on_disabled_hover_text("First add its two points").clicked() {
            commands.push(Command::Control(ControlStep::AddBar));
        }
    });
    for (place, bar) in list.bars.iter().enumerate() {
        let mut next = bar.clone();
        let number = place + 1;
        ui.horizontal_wrapped(|ui| {
            for (end, word) in next.ends.iter_mut().zip(["from", "to"]) {
                end_of(open, end, &format!("Scale bar {number} {word}"), ui);
            }
            let label = format!("Length of scale bar {number}");
            let hover = "How long it is in truth";
            // Empty until somebody types it: a length that stands there already is taken for true.
            let typed = match bar.is_known() {
                true => number_field(ui, &label, hover, bar.length, ""),
                false => {
                    let typed = text_field(ui, &label, hover, "", 90.0);
                    settled(ui, &label, typed)
                }
            };
            if let Some(length) = typed {
                next.length = length;
            }
            unit_of(&mut next, &format!("Unit of scale bar {number}"), ui);
            let remove = ui.small_button("✖");
            let label = format!("Remove scale bar {number}");
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if remove
                .on_hover_text(format!("{label}; undo brings it back"))
                .clicked()
            {
                commands.push(Command::Control(ControlStep::RemoveBar(place)));
            }
        });
        measured(open, bar, ui);
        if next != *bar {
            // Its ends can be chosen before its length is typed.
            let is_length = next.length > 0.0 || next.length == bar.length;
            let is_bar = is_length && next.ends[0] != next.ends[1];
            commands.push(match is_bar {
                true => Command::Control(ControlStep::Bar(place, next)),
                false => Command::Report(format!(
                    "scale bar {number} is between two different points, and longer than 0"
                )),
            });
        }
    }
}

/// One of its ends.
fn end_of(open: &OpenFlight, end: &mut String, label: &str, ui: &mut egui::Ui) {
    let combo = egui::ComboBox::from_id_salt(label)
        .selected_text(end.as_str())
        .width(56.0)
        .show_ui(ui, |ui| {
            for point in &open.control_list().points {
                ui.selectable_value(end, point.name.clone(), &point.name);
            }
        });
    combo_box(&combo.response, label, end);
}

fn unit_of(bar: &mut ScaleBar, label: &str, ui: &mut egui::Ui) {
    let combo = egui::ComboBox::from_id_salt(label)
        .selected_text(bar.unit.symbol())
        .width(44.0)
        .show_ui(ui, |ui| {
            for unit in LengthUnit::ALL {
                ui.selectable_value(&mut bar.unit, unit, unit.symbol());
            }
        });
    combo_box(&combo.response, label, bar.unit.symbol());
}

/// How long it is in the flight of now, where both of its ends are found.
fn measured(open: &OpenFlight, bar: &ScaleBar, ui: &mut egui::Ui) {
    let Some(length) = open.bar_length(bar) else {
        ui.weak("Mark both of its ends in two photos each.");
        return;
    };
    let parts = open.flight().parts();
    if !parts.unit_known {
        let length = significant_digits(length, 5);
        ui.weak(format!("{length} of the reconstruction's units"));
        return;
    }
    if !bar.is_known() {
        ui.weak("Type how long it is in truth.");
        return;
    }
    let here = length * parts.unit.metres() / bar.unit.metres();
    let percent = 100.0 * (here / bar.length - 1.0);
    let (here, unit) = (significant_digits(here, 5), bar.unit);
    ui.label(unbroken(&format!(
        "{here} {unit} in the flight, {percent:+.2} % off"
    )));
}
