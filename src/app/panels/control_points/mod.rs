//! Control points: the list of points with their marks, scale bars, and what brings the flight to the world by
//! them. It stands at the left, in the place of the table, while the tool is taken.
//!
//! ```text
//! points  the points, and the marks of the chosen one
//! bars    the scale bars
//! ```

mod bars;
mod points;

use crate::command::{Asking, Command};
use crate::control_points::{Applied, ControlStep};
use crate::names;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::opening::Georeferenced;
use crate::panels::Scrolled;
use crate::panels::field::hinted_field;
use crate::panels::working::working;
use crate::state::State;
use crate::tasks::Task;

/// Draws the panel.
pub fn control(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    ui.horizontal(|ui| {
        ui.strong("Control points");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hover = "Put the tool away; the points stay";
            if ui
                .button("Back to the photos")
                .on_hover_text(hover)
                .clicked()
            {
                commands.push(Command::Control(ControlStep::Toggle));
            }
        });
    });
    ui.separator();
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show_focused(ui, |ui| {
            points::points(open, ui, commands);
            ui.separator();
            bars::bars(open, ui, commands);
            ui.separator();
            apply(state, open, ui, commands);
        });
}

/// Of the surveyed places.
fn crs_row(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let crs = open.control_list().crs.as_deref().unwrap_or_default();
    let hint = match &open.files.crs {
        Some(_) => "that of the flight",
        None => "EPSG:n; if empty a local one, metres",
    };
    ui.horizontal(|ui| {
        ui.label("Surveyed in");
        let hover = "The coordinate system of the surveyed places: EPSG:n, WKT or a PROJ text";
        // Its own margin is beside it; else the panel would grow.
        let width = (ui.available_width() - 12.0).max(60.0);
        let label = "System of the survey";
        if let Some(typed) = hinted_field(ui, label, hover, crs, hint, width) {
            let typed = typed.trim();
            let crs = (!typed.is_empty()).then(|| typed.to_owned());
            commands.push(Command::Control(ControlStep::Crs(crs)));
        }
    });
}

/// The buttons that add.
fn adding(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let hover = "A point to mark in photos: surveyed, or only an end of a scale bar";
        if ui.button("Add point").on_hover_text(hover).clicked() {
            commands.push(Command::Control(ControlStep::Add));
        }
        let hover = "Read surveyed points, with or without marks: a table with a header, or OpenDroneMap's gcp_list.txt";
        if ui.button("Load list…").on_hover_text(hover).clicked() {
            commands.push(Command::Ask(Some(Asking::ControlList)));
        }
    });
}

/// The button that brings the flight to the world, and what came of it.
fn apply(state: &State, open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let lacks = open.control_lacks();
    let runs = state.work.is_running(Task::CONTROL) || state.is_opening();
    let surveyed = (open.control_list().points.iter())
        .filter(|point| point.position.is_some())
        .count();
    if surveyed < 3 && !open.control_list().bars.is_empty() {
        let mut level = open.control.level;
        let hover =
            "Turn the plane of the surface level, cameras above: scale bars do not say what is up";
        let check = ui.checkbox(&mut level, "Level by the ground");
        if check.on_hover_text(hover).changed() {
            commands.push(Command::Control(ControlStep::Level(level)));
        }
    }
    ui.horizontal_wrapped(|ui| {
        let ready = lacks.is_none() && !runs;
        let button = ui.add_enabled(ready, egui::Button::new("Apply"));
        button.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, ready, "Apply control points")
        });
        let hover = "Bring the flight, photos and surface together, to where the points are. Undo takes it back";
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Control(ControlStep::Apply));
        }
        if runs {
            working(ui);
        }
    });
    if let Some(lacks) = lacks {
        ui.weak(lacks);
    }
    match &open.control.applied {
        Some(Applied::Failed(why)) => {
            ui.colored_label(ui.visuals().error_fg_color, why);
        }
        Some(Applied::Placed(found, placed, by)) if *placed == open.settings().placed => {
            match **by == *open.control_list() {
                true => result(found, ui),
                false => {
                    let warn = ui.visuals().warn_fg_color;
                    ui.colored_label(warn, "⚠ Points, marks or bars have changed since they were applied: the flight lies where they were before. Apply them again.");
                }
            }
        }
        _ => {}
    }
    if open.is_changed() {
        ui.weak("Points and marks are saved with the flight, in a file beside its flight.toml.");
    }
}

/// How well it fits.
fn result(found: &Georeferenced, ui: &mut egui::Ui) {
    let unit = found.unit;
    let scale = significant_digits(found.similarity.scale, 6);
    ui.label(names::unbroken(&format!(
        "Applied: {scale} {unit} to a unit before, {}",
        found.scale_error_in_words()
    )));
    if let Some(used) = found.used_in_words("points") {
        ui.label(used);
    }
    if let Some(errors) = found.errors_in_words() {
        ui.label(format!("Poses: {errors}"));
    }
    for warning in &found.warnings {
        ui.colored_label(ui.visuals().warn_fg_color, format!("⚠ {warning}"));
    }
}

/// How far the point of this name is from where it was surveyed, in the flight of now, and whether it was used.
fn residual<'a>(open: &'a OpenFlight, name: &str) -> Option<(&'a Georeferenced, f64, bool)> {
    let Some(Applied::Placed(found, placed, by)) = &open.control.applied else {
        return None;
    };
    if *placed != open.settings_now().placed || **by != *open.control_list() {
        return None;
    }
    let position = found
        .positions
        .iter()
        .find(|position| position.name == name)?;
    Some((found, position.residual.length(), position.used))
}
