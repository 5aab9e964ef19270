//! What is asked of the plan: each field is taken when it is left, and the plan made anew.

use egui::{ComboBox, Ui};

use super::found::{found, refused};
use super::places::places;
use crate::command::{Answers, Asking, Command, Dialog};
use crate::numbers::to_digits;
use crate::open_flight::OpenFlight;
use crate::panels::Scrolled;
use crate::panels::field::{combo_box, hinted_field, number_field};
use crate::panels::working::working;
use crate::plan::{
    AskedPlan, Drone, Flying, MOST_SPEED, Pattern, Positioning, Purpose, Size, USUAL_CLEARANCE,
};
use crate::planning::PlanStep;
use crate::state::State;
use crate::tasks::Task;
use crate::typed::typed;
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
    if planning.flown.is_none() {
        // The fields alone are higher than a small window.
        refused(open, ui, commands);
    }
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show_focused(ui, |ui| {
            let mut asked = now.clone();
            fields(state, open, &mut asked, ui);
            places(open, &mut asked, ui, commands);
            if &asked != now {
                commands.push(Command::Plan(PlanStep::Ask(Box::new(asked))));
            }
            // The numbers of another plan would be taken for those of one that is refused.
            if planning.flown.is_none() && planning.refused().is_none() {
                ui.separator();
                found(state, open, ui, commands);
            }
            ui.separator();
            ui.horizontal_wrapped(|ui| {
                let is_there = planning.is_of_now();
                let made = planning.made.as_ref().filter(|_| is_there);
                let no_mission = made.and_then(|made| made.no_mission());
                for (name, asking, why_not, hover) in [
                    (
                        "Save mission…",
                        Asking::Mission,
                        no_mission,
                        "For DJI, QGroundControl, Mission Planner, Litchi, or as KML or GeoJSON",
                    ),
                    (
                        "Save table…",
                        Asking::PlanTable,
                        None,
                        "Every photo with what it will show, as CSV or JSON",
                    ),
                    (
                        "Save page…",
                        Asking::PlanSheet,
                        None,
                        "For the pilot, to print: map, numbers, checklist, photos",
                    ),
                ] {
                    let can = is_there && why_not.is_none();
                    let button = ui.add_enabled(can, egui::Button::new(name));
                    let why_not = why_not.unwrap_or("There is no plan of what is asked for now");
                    let button = button.on_disabled_hover_text(why_not);
                    if button.on_hover_text(hover).clicked() {
                        commands.push(Command::Ask(Some(asking)));
                    }
                }
            });
            compare(state, open, ui, commands);
        });
}

/// The way to what came of a mission.
fn compare(state: &State, open: &OpenFlight, ui: &mut Ui, commands: &mut Vec<Command>) {
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        ui.label("After the flight:");
        let running = state.work.is_running(Task::FLOWN);
        let button = ui.add_enabled(!running, egui::Button::new("Compare with mission…"));
        let hover = "Planned against flown: a mission's file (.kmz, .plan, .waypoints, .csv, .geojson) beside this flight. It can \
                     also be dropped on this window";
        if button.on_hover_text(hover).clicked() {
            let dialog = Dialog::file("Mission as it was planned").answering(Answers::Flown);
            commands.push(Command::Browse(dialog));
        }
        if running {
            working(ui);
        }
    });
    let hover = "The path of a mission's file, with Enter";
    let width = ui.available_width().clamp(80.0, 320.0);
    let hint = "or its path";
    if let Some(path) = hinted_field(ui, "Mission's file", hover, "", hint, width)
        && let Some(path) = typed(&path)
    {
        commands.push(Command::Plan(PlanStep::Compare(path)));
    }
    if open.planning.flown.is_some() {
        let back = ui.button("Back to the plan");
        if back
            .on_hover_text("Look at what is planned again")
            .clicked()
        {
            commands.push(Command::Plan(PlanStep::CloseFlown));
        }
    }
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
    combo_box(&list.response, name, title);
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
        if asked.pattern.has(Purpose::Scale) {
            let hover = "How much a photo shares with the next, of its width and height";
            if let Some(percent) = number("Overlap", hover, asked.overlap * 100.0, "%", ui) {
                asked.overlap = percent.clamp(0.0, 95.0) / 100.0;
            }
            ui.label("");
            let fill = ui.checkbox(&mut asked.fill_gaps, "Fill gaps");
            fill.on_hover_text("With photos more, which share more with others than the overlap says");
            ui.end_row();
        }
        if asked.pattern.is_level() {
            let hover = "The camera's axis below the horizon: 90 looks straight down";
            if let Some(tilt) = number("Tilt", hover, asked.tilt, "°", ui) {
                asked.tilt = tilt.clamp(5.0, 90.0);
            }
        }
        if asked.pattern.is_square() {
            let hover = "How far a photo may look off the normal of the ground, to lie square in its strip";
            if let Some(off) = number("Off the normal", hover, asked.off_normal, "°", ui) {
                asked.off_normal = off.clamp(0.1, 60.0);
            }
        }
        if asked.pattern.has(Purpose::Survey) {
            survey(asked, (shown, per_shown), ui);
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
        let hover = "How near the drone may come to the surface, and to what it keeps out of: 5 m, or half of the photos' distance where they are nearer (a lab)";
        if let Some(near) = number("Clearance", hover, asked.clearance, lengths, ui) {
            asked.clearance = near.max(parts.unit.metres().recip() * 0.01);
        }
        let usual = USUAL_CLEARANCE / parts.unit.metres();
        if asked.clearance < usual * 0.999 {
            ui.label("");
            let unit = parts.unit.symbol();
            ui.weak(format!("nearer than the usual {} {unit}", to_digits(usual, 3)));
            ui.end_row();
        }
        flying(&mut asked.flying, ui);
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

/// How the photos of a survey lie.
fn survey(asked: &mut AskedPlan, (shown, per_shown): (LengthUnit, f64), ui: &mut Ui) {
    let survey = &mut asked.survey;
    let hover = "How much a photo of the survey shares with the next, of its width and height";
    if let Some(percent) = number("Survey's overlap", hover, survey.overlap * 100.0, "%", ui) {
        survey.overlap = percent.clamp(0.0, 95.0) / 100.0;
    }
    if asked.pattern.has(Purpose::Scale) {
        let own = match survey.size {
            Some(Size::Scale { pixels, .. }) => pixels * per_shown,
            _ => 0.0,
        };
        let unit = format!("px/{shown} (0: as wished)");
        let hover = "The scale of the survey's photos: a coarser one needs fewer. 0 takes that of the others";
        if let Some(scale) = number("Survey's scale", hover, own, &unit, ui) {
            survey.size = (scale > 0.0).then(|| Size::scale(scale / per_shown));
        }
    }
    ui.label("");
    ui.horizontal_wrapped(|ui| {
        let cross = ui.checkbox(&mut survey.cross, "Cross grid");
        cross.on_hover_text("Rows straight down across the others, too");
        let ring = ui.checkbox(&mut survey.ring, "Ring");
        ring.on_hover_text("Photos around the area that look aslant into it");
    });
    ui.end_row();
}

/// How the drone is flown from photo to photo.
fn flying(flying: &mut Flying, ui: &mut Ui) {
    let speeds = "At most";
    if let Some(speed) = number("Speed", "Between photos", flying.speed, "m/s", ui) {
        flying.speed = speed.clamp(0.1, MOST_SPEED);
    }
    if let Some(climb) = number("Climb", speeds, flying.climb, "m/s", ui) {
        flying.climb = climb.clamp(0.1, MOST_SPEED);
    }
    if let Some(descent) = number("Descent", speeds, flying.descent, "m/s", ui) {
        flying.descent = descent.clamp(0.1, MOST_SPEED);
    }
    let hover = "How steeply a slanted leg may climb or fall: steeper ones are flown upright and level. 0 does not ask";
    let steepest = flying.steepest.unwrap_or(0.0);
    if let Some(degrees) = number("Steepest leg", hover, steepest, "° (0: any)", ui) {
        flying.steepest = (degrees > 0.0).then_some(degrees.min(89.0));
    }
    let hover = "How long the drone waits at a photo, for the gimbal to settle";
    if let Some(settle) = number("Wait", hover, flying.settle, "s", ui) {
        flying.settle = settle.clamp(0.1, 60.0);
    }
    let hover = "Minutes in the air: a longer way becomes several missions. 0 does not ask";
    let battery = flying.battery.unwrap_or(0.0);
    if let Some(minutes) = number("Battery", hover, battery, "min (0: any)", ui) {
        flying.battery = (minutes > 0.0).then_some(minutes);
    }
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
