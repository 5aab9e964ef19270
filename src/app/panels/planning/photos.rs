//! The planned photos in the order in which they are flown, and what the one that is looked at will show.

use egui::Ui;
use egui_extras::{Column, TableBuilder};

use super::flown::flown_photos;
use crate::command::Command;
use crate::flight::Verdict;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::rows::pairs;
use crate::panels::verdict::{verdict_color, verdict_sign};
use crate::planning::{MadePlan, PlanStep};
use crate::state::State;

/// The height of a row.
const ROW: f32 = 22.0;

/// Draws the panel.
pub fn planned_photos(state: &State, ui: &mut Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    if let Some(flown) = &open.planning.flown {
        flown_photos(open, flown, ui, commands);
        return;
    }
    let Some(made) = open
        .planning
        .made
        .as_ref()
        .filter(|_| open.planning.refused().is_none())
    else {
        ui.weak("No photos are planned.");
        return;
    };
    let unit = state.preferences.unit();
    let per_shown = unit.in_units_of(open.flight().parts().unit);
    walk(open, made, ui, commands);
    if let Some((place, photo)) = open.planning.photo() {
        let scale =
            |pixels: f64| format!("{} px/{unit}", significant_digits(pixels * per_shown, 4));
        let length = |length: f64| {
            format!(
                "{} {}",
                significant_digits(length, 4),
                open.flight().parts().unit
            )
        };
        let mut rows = vec![
            (
                "Tilt, pan",
                format!("{:.1}°, {:.1}°", photo.tilt, photo.pan),
            ),
            ("Off the normal", format!("{:.1}°", photo.off_normal)),
        ];
        if let Some(forecast) = &photo.forecast {
            if let Some(depth) = forecast.depth {
                rows.push(("Distance", length(depth)));
            }
            if let Some(fitted) = &forecast.fitted {
                rows.push(("Top, fitted", scale(fitted.top)));
                rows.push(("Bottom, fitted", scale(fitted.bottom)));
                rows.push(("Off the line", format!("{:.1} %", fitted.rms_percent)));
            }
            rows.push(("Least", scale(forecast.least)));
            rows.push(("Greatest", scale(forecast.greatest)));
            let covered = crate::exports::percent(forecast.covered.min(1.0));
            rows.push(("Shows the surface", covered));
        }
        if let Some(interval) = photo.interval {
            rows.push(("By the drone's errors", format!("±{interval:.1} %")));
        }
        if let Some(shared) = made.plan.cover.shared.get(place) {
            rows.push(("Shared with others", crate::exports::percent(*shared)));
        }
        if let Some((_, shadows)) = &made.sun
            && let Some(share) = shadows.photos.get(place)
        {
            rows.push(("In shadow", crate::exports::percent(*share)));
        }
        pairs("planned photo", rows, ui);
        for trouble in made.plan.troubles(place) {
            ui.colored_label(ui.visuals().warn_fg_color, trouble);
        }
        ui.separator();
    }
    table(open, made, per_shown, ui, commands);
}

/// A slider through the flight, and what is done with the photo under it.
fn walk(open: &OpenFlight, made: &MadePlan, ui: &mut Ui, commands: &mut Vec<Command>) {
    let planning = &open.planning;
    let count = made.plan.photos.len();
    let mut place = planning.selected().map_or(0, |place| place + 1);
    let before = place;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 70.0).clamp(30.0, 400.0);
        let slider =
            ui.add(egui::Slider::new(&mut place, 0..=count).clamping(egui::SliderClamping::Always));
        slider.widget_info(|| egui::WidgetInfo::slider(true, place as f64, "Through the flight"));
        slider.on_hover_text("Through the flight, photo by photo (arrow keys up and down)");
    });
    if place != before {
        commands.push(Command::Plan(PlanStep::Select(place.checked_sub(1))));
    }
    let Some((place, photo)) = planning.photo() else {
        ui.weak("Click a photo in the viewport or in the table, or move the slider.");
        return;
    };
    ui.horizontal_wrapped(|ui| {
        ui.strong(&photo.name);
        if let Some((minutes, share)) = made.flown_at(place) {
            let battery = share.map_or(String::new(), |share| {
                format!(", {:.0} % of the battery", share * 100.0)
            });
            ui.label(format!("after {minutes:.1} min{battery}"));
        }
        let through = ui.add(egui::Button::selectable(planning.through, "Through camera"));
        through.widget_info(|| {
            egui::WidgetInfo::selected(
                egui::Role::Button,
                true,
                planning.through,
                "Through planned camera",
            )
        });
        let hover = "What this photo will show, from the surface and its colours (C)";
        if through.on_hover_text(hover).clicked() {
            commands.push(Command::Plan(PlanStep::ToggleThrough));
        }
        let leave = ui.add_enabled(count > 1, egui::Button::new("Leave out"));
        if leave.on_hover_text("Without this photo (Delete)").clicked() {
            commands.push(Command::Plan(PlanStep::Leave));
        }
    });
}

fn table(
    open: &OpenFlight,
    made: &MadePlan,
    per_shown: f64,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let selected = open.planning.selected();
    let id = ui.scope_id().with("planned row");
    let before: Option<Option<usize>> = ui.data(|data| data.get_temp(id));
    // A click on a number is one on its row. No number is broken over two lines.
    ui.style_mut().interaction.selectable_labels = false;
    ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
    let mut table = TableBuilder::new(ui)
        .id_salt("planned photos")
        .striped(true)
        .sense(egui::Sense::CLICK)
        .column(Column::auto().at_least(40.0))
        .columns(Column::auto().at_least(38.0), 3)
        .column(Column::remainder().at_least(18.0));
    if before != Some(selected)
        && let Some(row) = selected
    {
        table = table.scroll_to_row(row, None);
    }
    table
        .header(ROW, |mut header| {
            for (name, hover) in [
                ("Photo", "In the order in which they are flown"),
                ("Top", "The fitted scale at the top edge"),
                ("Bottom", "The fitted scale at the bottom edge"),
                (
                    "± %",
                    "How far it may be off by the drone's errors, percent",
                ),
                ("", "Whether it holds what was asked for"),
            ] {
                header.col(|ui| {
                    ui.weak(name).on_hover_text(hover);
                });
            }
        })
        .body(|body| {
            body.rows(ROW, made.plan.photos.len(), |mut row| {
                let place = row.index();
                let Some(photo) = made.plan.photos.get(place) else {
                    return;
                };
                row.set_selected(selected == Some(place));
                let fitted = photo.forecast.as_ref().and_then(|forecast| forecast.fitted);
                let scale = |pixels: Option<f64>| {
                    pixels.map_or("–".to_owned(), |pixels| {
                        significant_digits(pixels * per_shown, 4)
                    })
                };
                row.col(|ui| {
                    ui.label(&photo.name);
                });
                row.col(|ui| {
                    ui.label(scale(fitted.map(|fitted| fitted.top)));
                });
                row.col(|ui| {
                    ui.label(scale(fitted.map(|fitted| fitted.bottom)));
                });
                row.col(|ui| {
                    let interval = photo.interval.map(|interval| format!("{interval:.1}"));
                    ui.label(interval.unwrap_or_else(|| "–".to_owned()));
                });
                row.col(|ui| {
                    let troubles = made.plan.troubles(place);
                    let verdict = match troubles.is_empty() {
                        true => Verdict::Trust,
                        false => Verdict::Check,
                    };
                    let color = verdict_color(verdict, ui.visuals());
                    let sign = ui.colored_label(color, verdict_sign(verdict));
                    if !troubles.is_empty() {
                        sign.on_hover_text(troubles.join("\n"));
                    }
                });
                if row.response().clicked() {
                    commands.push(Command::Plan(PlanStep::Select(Some(place))));
                }
            });
        });
    ui.data_mut(|data| data.insert_temp(id, selected));
}
