//! What is asked of the plan: each field is taken when it is left, and the plan made anew.

use egui::{ComboBox, Ui};

use super::found::found;
use crate::command::{Asking, Command};
use crate::open_flight::OpenFlight;
use crate::panels::field::{combo_box, hinted_field, number_field};
use crate::plan::{Drone, MOST_SPEED, Pattern, Positioning, Size};
use crate::planning::{AskedPlan, PlanStep, PlanTool};
use crate::state::State;
use crate::tasks::Task;
use crate::units::LengthUnit;

/// Draws the panel.
pub fn asked_of_plan(state: &State, ui: &mut Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    if !open.flight().parts().unit_known {
        ui.label("The unit of the flight's coordinates is not known: set it under Flight on the page of the pile.");
        return;
    }
    let planning = &open.planning;
    let Some(now) = planning.now() else {
        commands.push(Command::Plan(PlanStep::Make));
        return;
    };
    let is_missing = !planning.is_of_now() && planning.refused().is_none();
    if is_missing && state.work.may_start(Task::PLAN, now) {
        commands.push(Command::Plan(PlanStep::Make));
    }
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show(ui, |ui| {
            let mut asked = now.clone();
            fields(state, open, &mut asked, ui);
            places(open, &mut asked, ui, commands);
            if &asked != now {
                commands.push(Command::Plan(PlanStep::Ask(Box::new(asked))));
            }
            ui.separator();
            found(state, open, ui, commands);
            ui.separator();
            ui.horizontal_wrapped(|ui| {
                let is_there = planning.is_of_now();
                for (name, asking, hover) in [
                    (
                        "Save mission…",
                        Asking::Mission,
                        "For DJI, QGroundControl, Mission Planner, Litchi, or as KML or GeoJSON",
                    ),
                    (
                        "Save table…",
                        Asking::PlanTable,
                        "Every photo with what it will show, as CSV or JSON",
                    ),
                    (
                        "Save page…",
                        Asking::PlanSheet,
                        "For the pilot, to print: map, numbers, checklist, photos",
                    ),
                ] {
                    let button = ui.add_enabled(is_there, egui::Button::new(name));
                    if button.on_hover_text(hover).clicked() {
                        commands.push(Command::Ask(Some(asking)));
                    }
                }
            });
        });
}

/// A list to choose one of.
fn choice<T: PartialEq + Copy>(name: &str, now: &mut T, all: &[(T, &str, &str)], ui: &mut Ui) {
    ui.label(name);
    let chosen = all.iter().find(|(value, ..)| value == now);
    let title = chosen.map_or("", |(_, title, _)| *title);
    let width = ui.available_width().clamp(80.0, 220.0);
    let list = ComboBox::from_id_salt(name)
        .selected_text(title)
        .width(width)
        .truncate();
    let list = list.show_ui(ui, |ui| {
        for (value, title, hover) in all {
            let entry = ui.selectable_label(value == now, *title);
            if entry.on_hover_text(*hover).clicked() {
                *now = *value;
            }
        }
    });
    list.response.widget_info(|| combo_box(name, title));
    ui.end_row();
}

/// A number with its unit.
fn number(name: &str, hover: &str, value: f64, unit: &str, ui: &mut Ui) -> Option<f64> {
    ui.label(name);
    let typed = ui
        .horizontal(|ui| number_field(ui, name, hover, value, unit))
        .inner;
    ui.end_row();
    typed
}

fn fields(state: &State, open: &OpenFlight, asked: &mut AskedPlan, ui: &mut Ui) {
    let parts = open.flight().parts();
    let (shown, lengths) = (state.preferences.unit(), parts.unit.symbol());
    let per_shown = shown.in_units_of(parts.unit);
    egui::Grid::new("asked of the plan").num_columns(2).show(ui, |ui| {
        let patterns = Pattern::ALL.map(|pattern| (pattern, pattern.title(), pattern.explained()));
        choice("Pattern", &mut asked.pattern, &patterns, ui);
        sizes(asked, (shown, per_shown), lengths, ui);
        let overlap = asked.overlap.unwrap_or(asked.pattern.usual_overlap()) * 100.0;
        let hover = "How much a photo shares with the next, of its width and height";
        if let Some(percent) = number("Overlap", hover, overlap, "%", ui) {
            asked.overlap = Some(percent.clamp(0.0, 95.0) / 100.0);
        }
        ui.label("");
let fill = ui.checkbox(&mut asked.fill_gaps, "Fill gaps");
fill.on_hover_text("With photos more, which share more with others than the overlap says");
ui.end_row();
        match asked.pattern {
            Pattern::Paper => {
                let hover = "The camera's axis below the horizon: 90 looks straight down";
                if let Some(tilt) = number("Tilt", hover, asked.tilt, "°", ui) {
                    asked.tilt = tilt.clamp(5.0, 90.0);
                }
            }
            Pattern::Slope => {
                let hover = "How far a photo may look off the normal of the ground, to lie square in its strip";
                if let Some(off) = number("Off the normal", hover, asked.off_normal, "°", ui) {
                    asked.off_normal = off.clamp(0.1, 60.0);
                }
            }
            Pattern::Survey => {}
        }
        let own = parts.cameras.first().map(|_| {
            (None, "The flight's camera", "The first camera of this flight, as it was calibrated")
        });
        let nominal = "Nominal: scales may be off by 2 %. Calibrate it by a flight of its own";
        let drones = Drone::ALL.map(|drone| (Some(drone), drone.title, nominal));
        let drones: Vec<_> = own.into_iter().chain(drones).collect();
        choice("Camera", &mut asked.drone, &drones, ui);
        let known = Positioning::ALL.map(|by| (by, by.title(), by.explained()));
        choice("Positioning", &mut asked.positioning, &known, ui);
        let hover = "How near the drone may come to the surface, and to what it keeps out of";
        if let Some(near) = number("Clearance", hover, asked.clearance, lengths, ui) {
            asked.clearance = near.max(parts.unit.metres().recip() * 0.01);
        }
        let hover = "Between photos";
        if let Some(speed) = number("Speed", hover, asked.speed, "m/s", ui) {
            asked.speed = speed.clamp(0.1, MOST_SPEED);
        }
        let hover = "How long the drone waits at a photo, for the gimbal to settle";
        if let Some(settle) = number("Wait", hover, asked.settle, "s", ui) {
            asked.settle = settle.clamp(0.1, 60.0);
        }
        let hover = "Minutes in the air: a longer way becomes several missions. 0 does not ask";
        let battery = asked.battery.unwrap_or(0.0);
        if let Some(minutes) = number("Battery", hover, battery, "min (0: any)", ui) {
            asked.battery = (minutes > 0.0).then_some(minutes);
        }
        ui.label("Flown at");
        let hover = "Where the sun stands then, and what lies in shadow: a time with its difference from UTC, as \
                     2026-06-01T10:00+02:00";
        let when = asked.when.clone().unwrap_or_default();
        let hint = "a time, for the sun";
        let width = ui.available_width().clamp(80.0, 220.0);
        if let Some(typed) = hinted_field(ui, "Flown at", hover, &when, hint, width) {
            asked.when = Some(typed.trim().to_owned()).filter(|typed| !typed.is_empty());
        }
        ui.end_row();
    });
}

/// The scale, or the height.
fn sizes(asked: &mut AskedPlan, (shown, per_shown): (LengthUnit, f64), lengths: &str, ui: &mut Ui) {
    let kinds = [
        (
            true,
            "Scale",
            "So many pixels to a unit of length of the rock",
        ),
        (
            false,
            "Height",
            "So far from the ground; of rows above the highest of the area",
        ),
    ];
    let mut by_scale = matches!(asked.size, Size::Scale { .. });
    let before = by_scale;
    choice("Photos by", &mut by_scale, &kinds, ui);
    if by_scale != before {
        asked.size = match by_scale {
            true => Size::scale(100.0 / per_shown.max(f64::MIN_POSITIVE) * per_shown),
            false => Size::Distance(asked.clearance * 4.0),
        };
    }
    match asked.size {
        Size::Scale { pixels, within } => {
            let unit = format!("px/{shown}");
            let hover = "Wished everywhere in every photo";
            if let Some(wished) = number("Scale", hover, pixels * per_shown, &unit, ui)
                && wished > 0.0
            {
                asked.size = Size::scale(wished / per_shown);
            }
            let hover = "How far it may be off anywhere in a photo, but for one pixel in fifty";
            let off = within.unwrap_or(0.0);
            if let Some(off) = number("Within ±", hover, off * per_shown, &unit, ui)
                && off > 0.0
            {
                let within = Some(off / per_shown);
                asked.size = Size::Scale { pixels, within };
            }
        }
        Size::Distance(height) => {
            let hover =
                "Of the slope pattern from the ground; of rows above the highest of the area";
            if let Some(height) = number("Height", hover, height, lengths, ui)
                && height > 0.0
            {
                asked.size = Size::Distance(height);
            }
        }
    }
}

/// What is set by clicks on the surface.
fn places(open: &OpenFlight, asked: &mut AskedPlan, ui: &mut Ui, commands: &mut Vec<Command>) {
    let planning = &open.planning;
    let mut tool = |tool: PlanTool, text: &str, hover: &str, ui: &mut Ui| {
        let is_taken = planning.tool == tool;
        let button = ui.add(egui::Button::new(text).selected(is_taken));
        button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_taken, text));
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Plan(PlanStep::Tool(tool)));
        }
    };
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.label("Area:");
        ui.label(match &asked.area {
            None => "the pile that was found".to_owned(),
            Some(corners) => format!("drawn, {} corners", corners.len()),
        });
        let hover = "Click the corners of what is to be photographed; its corners can be dragged";
        tool(PlanTool::Area, "Draw area", hover, ui);
        let find = ui.add_enabled(asked.area.is_some(), egui::Button::new("Find the pile"));
        if find
            .on_hover_text("What stands out of the floor around it")
            .clicked()
        {
            asked.area = None;
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Keep out:");
        ui.label(match asked.keep_out.len() {
            0 => "nothing".to_owned(),
            1 => "1 area".to_owned(),
            count => format!("{count} areas"),
        });
        let hover =
            "Click the corners of ground that is not flown over, at any height: misfires, people";
        tool(PlanTool::KeepOut, "Draw keep-out", hover, ui);
        let has = !asked.keep_out.is_empty();
        let remove = ui.add_enabled(has, egui::Button::new("Remove last"));
        if remove
            .on_hover_text("The area that was drawn last")
            .clicked()
        {
            asked.keep_out.pop();
        }
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Take-off:");
        ui.label(match asked.take_off {
            None => "not set".to_owned(),
            Some(place) => format!("{:.1}, {:.1}", place.x, place.y),
        });
        let hover =
            "Click where the drone takes off and lands: heights of the mission count from there";
        tool(PlanTool::TakeOff, "Set take-off", hover, ui);
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Photos:");
        let hover = "Click places for one photo more each; drag the selected photo over the ground; Delete leaves it out";
        tool(PlanTool::Add, "Add photos", hover, ui);
        let changed = !asked.edits.is_empty();
        let anew = ui.add_enabled(changed, egui::Button::new("As planned"));
        if anew.on_hover_text("Take back what was changed by hand").clicked() {
            asked.edits.clear();
        }
    });
    if matches!(planning.tool, PlanTool::Area | PlanTool::KeepOut) {
        ui.weak("Double click or Enter ends it; Backspace takes a corner back.");
    }
}
