//! A mission against the flight that came of it: the whole, and every planned photo.

use egui::Ui;
use egui_extras::{Column, TableBuilder};

use crate::command::{Asking, Command};
use crate::exports::flown_summary;
use crate::open_flight::OpenFlight;
use crate::panels::rows::pairs;
use crate::planning::{FlownMission, PlanStep};

/// The height of a row.
const ROW: f32 = 22.0;

/// Draws the panel.
pub(super) fn flown_photos(
    open: &OpenFlight,
    flown: &FlownMission,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let parts = open.flight().parts();
    let report = flown.report(&parts.name, parts.unit);
    let name = flown.file.file_name().unwrap_or_default();
    ui.strong(format!("Planned and flown: {}", name.to_string_lossy()));
    ui.horizontal_wrapped(|ui| {
        let save = ui.button("Save comparison…");
        let hover =
            "As a table (.csv, .json), a figure (.svg, .pdf, .png), or a page with both (.html)";
        if save.on_hover_text(hover).clicked() {
            commands.push(Command::Ask(Some(Asking::Flown)));
        }
        let close = ui.button("Close");
        if close.on_hover_text("Look at the plan again").clicked() {
            commands.push(Command::Plan(PlanStep::CloseFlown));
        }
    });
    let said: Vec<(&str, String)> = flown_summary(&report);
    pairs("planned and flown", said, ui);
    for warning in &flown.warnings {
        ui.colored_label(ui.visuals().warn_fg_color, warning);
    }
    ui.weak(format!("Flown less planned, in {}", parts.unit));
    ui.separator();
    ui.style_mut().interaction.selectable_labels = false;
    // The panel is narrower than the table where the window is small.
    egui::ScrollArea::horizontal().show(ui, |ui| table(open, flown, ui, commands));
}

/// Every planned photo.
fn table(open: &OpenFlight, flown: &FlownMission, ui: &mut Ui, commands: &mut Vec<Command>) {
    TableBuilder::new(ui)
        .id_salt("planned and flown photos")
        .striped(true)
        .sense(egui::Sense::CLICK)
        .column(Column::auto().at_least(40.0))
        .column(Column::auto().at_least(40.0).clip(true))
        .columns(Column::auto().at_least(30.0), 6)
        .header(ROW, |mut header| {
            for (name, hover) in [
                ("Planned", "Its name in the mission"),
                ("Photo", "That was taken for it; a click selects it"),
                ("x", "Flown less planned, to the east"),
                ("y", "Flown less planned, to the north"),
                ("z", "Flown less planned, upwards"),
                ("Tilt", "Of the axis below the horizon, degrees"),
                ("Pan", "Degrees clockwise"),
                ("Shared", "How much of what it was to show it shows"),
            ] {
                header.col(|ui| {
                    ui.weak(name).on_hover_text(hover);
                });
            }
        })
        .body(|body| {
            let residuals = &flown.compared.flown.residuals;
            body.rows(ROW, residuals.len(), |mut row| {
                let place = row.index();
                let plan = flown.compared.planned.get(place);
                let residual = residuals.get(place).copied().flatten();
                let photo = residual.map(|residual| residual.photo);
                row.set_selected(photo.is_some() && open.selected == photo);
                row.col(|ui| {
                    ui.label(plan.map_or("", |plan| plan.name.as_str()));
                });
                let Some(residual) = residual else {
                    row.col(|ui| {
                        ui.colored_label(ui.visuals().error_fg_color, "not taken");
                    });
                    return;
                };
                let name = flown.compared.photos.get(residual.photo);
                row.col(|ui| {
                    ui.label(name.map_or("", String::as_str));
                });
                let [x, y, z] = residual.offset.to_array();
                let shared = residual.shared.map_or("–".to_owned(), |shared| {
                    format!("{:.0} %", shared * 100.0)
                });
                for text in [
                    format!("{x:+.2}"),
                    format!("{y:+.2}"),
                    format!("{z:+.2}"),
                    format!("{:+.1}°", residual.tilt),
                    format!("{:+.1}°", residual.pan),
                    shared,
                ] {
                    row.col(|ui| {
                        ui.label(text);
                    });
                }
                if row.response().clicked() {
                    commands.push(Command::Select(Some(residual.photo)));
                }
            });
        });
}
