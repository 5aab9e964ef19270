//! The small window of a season: where it is, what is done with each flight, and the list of its flights.

use egui_extras::{Column, TableBuilder};

use super::{browse, named_field, path_line};
use crate::batch::{Outcome, Step};
use crate::command::{Answers, Command, Dialog};
use crate::exports::size_text;
use crate::names;
use crate::season::{FlightState, FoundSeason, SeasonField, SeasonForm, SeasonStep};
use crate::state::State;
use crate::tasks::Task;
use crate::typed::typed;

/// How wide the window is, where there is room for it.
pub(super) const WIDTH: f32 = 780.0;

/// How high its contents are, where there is room for it and whatever it holds: the window is in the middle of the screen, and its
/// fields stay where they are while it looks for flights.
const HEIGHT: f32 = 560.0;
/// What of the screen is above and below the contents.
const AROUND: f32 = 70.0;

const ROW: f32 = 24.0;
/// What is said of the flight that is selected, below the list.
const SELECTED: f32 = 60.0;
/// What the run came to, and its button, below that.
const RAN: f32 = 70.0;

/// Draws the window's contents.
pub(super) fn season(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let held = &state.season;
    let mut running = state.work.running();
    let run = running.find(|(task, _)| *task == Task::SEASON);
    let mut form = held.form.clone();
    let (top, screen) = (ui.cursor().top(), ui.ctx().content_rect());
    let high = (screen.height() - AROUND).clamp(100.0, HEIGHT);
    ui.set_min_height(high);
    let bottom = top + high - RAN - held.taken_away.lines().count() as f32 * ROW;
    ui.add_enabled_ui(run.is_none(), |ui| {
        place_row(SeasonField::Season, &mut form, "", ui, commands);
        let proposed = held.season().map(|found| found.to.display().to_string());
        place_row(
            SeasonField::To,
            &mut form,
            &proposed.unwrap_or_default(),
            ui,
            commands,
        );
        if let Some(found) = held.season() {
            steps_row(found, &mut form, ui);
        }
    });
    if form != held.form {
        commands.push(Command::Season(SeasonStep::Fill(form.clone())));
    }
    match &held.found {
        Some(Err(error)) => {
            ui.colored_label(ui.visuals().error_fg_color, error);
        }
        Some(Ok(found)) => {
            for note in &found.notes {
                ui.colored_label(ui.visuals().warn_fg_color, format!("⚠ {note}"));
            }
            ui.separator();
            list(state, (found, bottom), ui, commands);
            selected(state, ui, commands);
        }
        None if state.work.is_running(Task::LOOK_AT_SEASON) => {
            ui.weak("Looking for flights…");
        }
        None if typed(&form.season).is_some() => {
            ui.weak("There is no such file or folder.");
        }
        None => {
            ui.weak("Every flight below the folder is taken, or those that SEASON.toml names.");
        }
    }
    let left = bottom - ui.cursor().top();
    ui.add_space(left.max(0.0));
    ui.separator();
    for line in held.taken_away.lines() {
        ui.label(line);
    }
    match run {
        Some((_, (_, fraction))) => {
            let [ended, of, failed] = held.counts();
            let said = match failed {
                0 => format!("{ended} of {of} flights"),
                _ => format!("{ended} of {of} flights, {failed} failed"),
            };
            ui.add(egui::ProgressBar::new(fraction as f32).text(said));
            let cancel = ui.button("Cancel");
            cancel.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, true, "Cancel season")
            });
            let hover = "What is done stays: Start goes on with the rest";
            if cancel.on_hover_text(hover).clicked() {
                commands.push(Command::Cancel(Task::SEASON));
            }
        }
        None => {
            match &held.ended {
                Some(Ok(said)) => {
                    ui.label(said);
                }
                Some(Err(why)) => {
                    ui.colored_label(ui.visuals().error_fg_color, why);
                }
                None => {}
            }
            let asked = held.season().map(|found| found.season.asked.check());
            let why = asked.as_ref().and_then(|asked| asked.as_ref().err());
            let flights = held.season().is_some_and(|found| !found.flights.is_empty());
            let ready = flights && why.is_none() && form == held.form;
            let button = ui.add_enabled(ready, egui::Button::new("Start"));
            button.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, ready, "Start season")
            });
            let why = why.map_or("First name a season with flights", String::as_str);
            let hover = "Does every flight whose files, steps or options have changed; the others stay as they are";
            let button = button.on_hover_text(hover).on_disabled_hover_text(why);
            if button.clicked() {
                commands.push(Command::Season(SeasonStep::Start));
            }
        }
    }
}

/// A field for a place, with the desktop's dialog. `hint` is what counts while it is empty.
fn place_row(
    field: SeasonField,
    form: &mut SeasonForm,
    hint: &str,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let (label, hover, text) = match field {
        SeasonField::Season => (
            "SEASON.toml or folder of flights",
            "A path, typed or pasted",
            &mut form.season,
        ),
        SeasonField::To => (
            "Folder of the results",
            "A new folder, or that of an earlier run, which goes on",
            &mut form.to,
        ),
    };
    ui.label(label);
    ui.horizontal(|ui| {
        let buttons = if field == SeasonField::Season {
            190.0
        } else {
            80.0
        };
        let width = (ui.available_width() - buttons).max(120.0);
        let edit = path_line(ui, text, hint, width);
        if field == SeasonField::Season {
            crate::panels::path_field::takes_the_keys_at_first(ui, &edit);
        }
        named_field(edit, label, hover, text);
        let answers = Answers::Season(field);
        match field {
            SeasonField::Season => {
                for (name, dialog) in [
                    ("Folder…", Dialog::folder("Folder of flights")),
                    ("File…", Dialog::file("SEASON.toml")),
                ] {
                    let hover = "Choose in the desktop's own dialog";
                    if ui.button(name).on_hover_text(hover).clicked() {
                        commands.push(Command::Browse(dialog.answering(answers)));
                    }
                }
            }
            SeasonField::To => {
                if browse(ui, label) {
                    let dialog = Dialog::folder("Folder of the results");
                    commands.push(Command::Browse(dialog.answering(answers)));
                }
            }
        }
    });
}

/// What the box of psd says before anybody chooses it in vain.
const NO_REFERENCE: &str = "No flight found has a reference, so psd is passed over: name one in SEASON.toml, as reference of [psd] or of a [[flight]]";

/// Whether there are flights, and nobody says what the sizes of any are held against.
fn is_without_reference(found: &FoundSeason) -> bool {
    !found.has_reference && !found.flights.is_empty()
}

/// What is done with every flight.
fn steps_row(found: &FoundSeason, form: &mut SeasonForm, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Steps");
        let asked = &found.season.asked;
        for step in Step::ALL {
            let mut is_on = asked.has(step);
            let check = ui.checkbox(&mut is_on, step.as_str());
            check.widget_info(|| {
                let name = format!("Step {}", step.as_str());
                egui::WidgetInfo::selected(egui::Role::CheckBox, true, is_on, name)
            });
            let explained = step.explained();
            let hover = match step == Step::Psd && is_without_reference(found) {
                true => format!("{explained}\n{NO_REFERENCE}"),
                false => explained.to_owned(),
            };
            if check.on_hover_text(hover).changed() {
                let steps = Step::ALL.into_iter();
                let steps = steps.filter(|other| match *other == step {
                    true => is_on,
                    false => asked.has(*other),
                });
                form.steps = Some(steps.collect());
            }
        }
    });
}

/// The flights, down to `bottom` with what is said of the one that is selected: only the rows in sight are drawn.
fn list(
    state: &State,
    (found, bottom): (&FoundSeason, f32),
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let held = &state.season;
    let unit = &found.season.asked.unit;
    // Behind its header.
    let high = (bottom - SELECTED - ROW - ui.cursor().top()).max(100.0);
    let sizes = [format!("P50 {unit}"), format!("P80 {unit}")];
    let heads = [
        "State", "Blast", "Date", "Photos", "Verdicts", &sizes[0], &sizes[1],
    ];
    let table = TableBuilder::new(ui)
        .id_salt("season")
        .striped(true)
        .sense(egui::Sense::click())
        .cell_layout(egui::Layout::left_to_right(egui::Align::Center))
        .max_scroll_height(high)
        .column(Column::exact(110.0).clip(true))
        .column(Column::remainder().at_least(110.0).clip(true))
        .column(Column::exact(82.0).clip(true))
        .column(Column::exact(50.0).clip(true))
        .column(Column::exact(160.0).clip(true))
        .columns(Column::exact(84.0).clip(true), 2);
    table
        .header(ROW, |mut header| {
            for head in heads {
                header.col(|ui| {
                    ui.strong(head);
                });
            }
        })
        .body(|body| {
            body.rows(ROW, found.flights.len(), |mut row| {
                let place = row.index();
                let (Some(flight), Some(now)) = (found.flights.get(place), held.states.get(place))
                else {
                    return;
                };
                let known = now.row();
                row.set_selected(held.selected == Some(place));
                row.col(|ui| state_cell(now, ui));
                row.col(|ui| {
                    names::name(ui, &flight.blast);
                });
                let date = known.map_or(flight.date, |known| known.date);
                let findings = known.and_then(|known| known.findings.as_ref());
                let photos = findings.map(|findings| findings.photos.to_string());
                let verdicts = findings.map(|findings| findings.verdicts.in_words());
                let size = |percent| size_text(known.and_then(|known| known.size(percent)));
                for text in [
                    date.map(|date| date.to_string()),
                    photos,
                    verdicts,
                    size(50.0),
                    size(80.0),
                ] {
                    row.col(|ui| {
                        match text {
                            Some(text) => names::name(ui, &text),
                            None => ui.weak("–"),
                        };
                    });
                }
                let response = row.response();
                response.widget_info(|| {
                    let label = format!("Flight {}, {}", flight.blast, now.in_words());
                    let selected = held.selected == Some(place);
                    egui::WidgetInfo::selected(egui::Role::Row, true, selected, label)
                });
                if response.clicked() {
                    commands.push(Command::Season(SeasonStep::Select(place)));
                }
                if response.double_clicked() {
                    commands.push(Command::Open(flight.path.clone()));
                }
                response.on_hover_text("Double click opens the flight");
            });
        });
}

fn state_cell(now: &FlightState, ui: &mut egui::Ui) {
    let visuals = ui.visuals();
    let color = match now {
        FlightState::Ended(Outcome::Failed, _) => visuals.error_fg_color,
        FlightState::Waiting => visuals.weak_text_color(),
        _ => visuals.text_color(),
    };
    let said = match now {
        // `as` saturates.
        FlightState::Running(_, fraction) if *fraction > 0.0 => {
            format!("{} running {} %", now.sign(), (fraction * 100.0) as u8)
        }
        _ => format!("{} {}", now.sign(), now.in_words()),
    };
    let words = egui::RichText::new(said).color(color);
    let label = ui.add(egui::Label::new(words).selectable(false).truncate());
    match now {
        FlightState::Running(stage, _) => {
            label.on_hover_text(stage);
        }
        FlightState::Ended(_, row) => {
            if let Some(error) = &row.error {
                label.on_hover_text(error);
            }
        }
        _ => {}
    }
}

/// What is to be said of the flight that is selected.
fn selected(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some((path, now)) = state.season.selected_flight() else {
        ui.weak("Select a flight to see what is said of it.");
        return;
    };
    let row = now.row();
    if let Some(error) = row.and_then(|row| row.error.as_ref()) {
        ui.colored_label(ui.visuals().error_fg_color, error);
    } else if let FlightState::Running(stage, _) = now {
        ui.label(stage);
    } else if let Some(findings) = row.and_then(|row| row.findings.as_ref()) {
        let said = match findings.warnings.as_slice() {
            [] => "No warnings.".to_owned(),
            [one] => format!("⚠ {one}"),
            [first, others @ ..] => format!("⚠ {first} (and {} more)", others.len()),
        };
        ui.label(said);
    }
    let open = ui.button("Open the flight");
    open.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Button, true, "Open the selected flight")
    });
    if open.on_hover_text("Look at it in the window").clicked() {
        commands.push(Command::Open(path.to_owned()));
    }
}
