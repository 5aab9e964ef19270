//! The small window that makes a new flight from photos: what was found in their folder, where the flight
//! goes, how far it is.

use super::on_node::{ended_on_node, messages, node_rows};
use super::{browse, named_field, path_line};
use crate::command::{Answers, Command, Dialog};
use crate::from_photos::{Ended, FolderField, FromPhotos, FromPhotosForm, FromPhotosStep};
use crate::names;
use crate::panels::Scrolled;
use crate::panels::field::hinted_field;
use crate::reconstruct::{EngineName, PhotoSet, Quality, found, left_out, summary};
use crate::state::State;
use crate::tasks::Task;
use crate::typed::typed;

/// Draws the window's contents.
pub(super) fn from_photos(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let most = (ui.ctx().content_rect().height() - 90.0).max(150.0);
    egui::ScrollArea::vertical()
        .max_height(most)
        // It grows with what is in it.
        .min_scrolled_height(most)
        .show_focused(ui, |ui| contents(state, ui, commands));
}

fn contents(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let held = &state.from_photos;
    let mut running = state.work.running();
    let run = running.find(|(task, _)| *task == Task::RECONSTRUCT);
    // One line: in a small window the button is seen without scrolling.
    ui.label("Photos that overlap by 70 % become a flight: cloud, poses and lens.");
    ui.add_space(4.0);
    let mut form = held.form.clone();
    let mut entered = false;
    if form.node.chosen && run.is_some() {
        // So that the node's messages are seen in a small window, too.
        names::name(ui, &format!("{} at {}", form.photos, form.node.address));
    } else if held.growing.is_some() && run.is_some() {
        // The model behind this window is what one wants to see.
        names::name(ui, &form.photos);
    } else {
        ui.add_enabled_ui(run.is_none(), |ui| {
            entered |= folder_row(FolderField::Photos, &mut form, "", ui, commands);
            what_was_found(state, ui);
            ui.add_space(4.0);
            let proposed = held.found.as_ref();
            let proposed = proposed.map(|found| found.proposed.display().to_string());
            let hint = proposed.unwrap_or_default();
            entered |= folder_row(FolderField::To, &mut form, &hint, ui, commands);
            engine_row(held, &mut form, ui);
            if form.node.chosen {
                node_rows(&mut form.node, ui);
                return;
            }
            ui.horizontal(|ui| {
                ui.label("Coordinate system");
                let hint = "EPSG:n; if empty the zone of UTM";
                let hover = "Of the world: EPSG:n, WKT or a PROJ text; a projected one";
                let label = "Coordinate system";
                let width = ui.available_width();
                if let Some(typed) = hinted_field(ui, label, hover, &form.crs, hint, width) {
                    form.crs = typed;
                }
            });
            calibration_row(&mut form, ui, commands);
            quality_row(&mut form, ui);
            how_long(held, &form, ui);
        });
    }
    if form != held.form {
        commands.push(Command::FromPhotos(FromPhotosStep::Fill(form.clone())));
    }
    ui.separator();
    match run {
        Some((_, (sentence, fraction))) => {
            let works = match (form.node.chosen, form.engine) {
                (true, _) => Works::OnNode,
                (false, EngineName::Embedded) => Works::Embedded,
                (false, EngineName::Colmap) => Works::Colmap,
            };
            let is_paused = state.work.is_paused(Task::RECONSTRUCT);
            progress(&sentence, fraction, (works, is_paused), ui, commands);
            messages(held, ui);
        }
        None => start(held, &form, entered, ui, commands),
    }
}

/// A calibration that is kept, with the desktop's dialog.
fn calibration_row(form: &mut FromPhotosForm, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let label = "Calibration";
        ui.label(label);
        let hint = "a file; if empty the lens is found from the photos";
        let hover = "Of the photos' camera, of OpenCV's model (YAML, XML or JSON): it is kept digit for digit";
        let width = ui.available_width() - 80.0;
        if let Some(typed) = hinted_field(ui, label, hover, &form.calibration, hint, width) {
            form.calibration = typed;
        }
        if browse(ui, label) {
            let dialog = Dialog::file(label).answering(Answers::FromPhotos(FolderField::Calibration));
            commands.push(Command::Browse(dialog));
        }
    });
}

/// How much time the cloud may take; what that costs stands under the mouse.
fn quality_row(form: &mut FromPhotosForm, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        ui.label("Quality");
        for quality in Quality::ALL {
            let text = match quality {
                Quality::Fast => "Fast",
                Quality::Normal => "Normal",
                Quality::Best => "Best",
            };
            let radio = ui.radio_value(&mut form.quality, quality, text);
            let is_chosen = form.quality == quality;
            radio.widget_info(|| {
                let name = format!("Quality: {text}");
                egui::WidgetInfo::selected(egui::Role::RadioButton, true, is_chosen, name)
            });
            radio.on_hover_text(quality.explained());
        }
        let mut may_use = !form.processor_only;
        let card = ui.checkbox(&mut may_use, "Graphics card");
        form.processor_only = !may_use;
        card.on_hover_text(
            "Where there is one, photos are compared and depths found on it, whoever made it. Without it, or where \
             it fails, the processor does the same",
        );
    });
}

/// About how long that takes, where it is known: COLMAP's times are its own.
fn how_long(held: &FromPhotos, form: &FromPhotosForm, ui: &mut egui::Ui) {
    let takes = held.found.as_ref().map(|found| &found.takes);
    let chosen = Quality::ALL
        .iter()
        .position(|quality| *quality == form.quality);
    if let (Some(takes), Some(chosen), EngineName::Embedded) = (takes, chosen, form.engine)
        && let Some(time) = takes.get(chosen)
    {
        ui.weak(format!(
            "It takes {time} on this computer, estimated from its cores."
        ));
    }
}

/// What finds the poses; COLMAP by its version, grey where it is not installed.
fn engine_row(held: &FromPhotos, form: &mut FromPhotosForm, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        ui.label("Engine");
        for engine in EngineName::ALL {
            let (text, why_not) = match (engine, &held.colmap) {
                (EngineName::Embedded, _) => ("Embedded", None),
                (EngineName::Colmap, Some(Ok(version))) => (version.as_str(), None),
                (EngineName::Colmap, Some(Err(why))) => ("COLMAP", Some(why.as_str())),
                (EngineName::Colmap, None) => ("COLMAP", Some("Looking for it…")),
            };
            let is_chosen = form.engine == engine && !form.node.chosen;
            let radio = egui::RadioButton::new(is_chosen, text);
            let radio = ui.add_enabled(why_not.is_none(), radio);
            if radio.clicked() {
                form.engine = engine;
                form.node.chosen = false;
            }
            radio.widget_info(|| {
                let name = format!("Engine: {text}");
                let role = egui::Role::RadioButton;
                egui::WidgetInfo::selected(role, why_not.is_none(), is_chosen, name)
            });
            let radio = radio.on_hover_text(engine.explained());
            radio.on_disabled_hover_text(why_not.unwrap_or_default());
        }
        let is_chosen = form.node.chosen;
        let radio = ui.radio(is_chosen, "NodeODM");
        if radio.clicked() {
            form.node.chosen = true;
        }
        radio.widget_info(|| {
            let role = egui::Role::RadioButton;
            egui::WidgetInfo::selected(role, true, is_chosen, "Engine: NodeODM")
        });
        radio.on_hover_text(
            "OpenDroneMap on another computer: a NodeODM or ClusterODM, to which the photos are sent",
        );
    });
}

/// A field for a folder, with the desktop's dialog. `hint` is what counts while it is empty. Returns whether Enter was pressed in it.
fn folder_row(
    field: FolderField,
    form: &mut FromPhotosForm,
    hint: &str,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) -> bool {
    let (label, hover, text) = match field {
        FolderField::Photos => (
            "Folder of the photos",
            "A path, typed or pasted",
            &mut form.photos,
        ),
        FolderField::To | FolderField::Calibration => (
            "Folder to make",
            "Where the flight goes: a new folder, or one of a run that did not end",
            &mut form.to,
        ),
    };
    ui.label(label);
    let row = ui.horizontal(|ui| {
        let width = ui.available_width() - 80.0;
        let edit = path_line(ui, text, hint, width);
        let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if field == FolderField::Photos {
            crate::panels::path_field::takes_the_keys_at_first(ui, &edit);
        }
        named_field(edit, label, hover, text);
        if browse(ui, label) {
            let dialog = Dialog::folder(label).answering(Answers::FromPhotos(field));
            commands.push(Command::Browse(dialog));
        }
        entered
    });
    row.inner
}

fn what_was_found(state: &State, ui: &mut egui::Ui) {
    let held = &state.from_photos;
    let Some(photos) = &held.found else {
        if state.work.is_running(Task::LOOK_AT_PHOTOS) {
            ui.weak("Reading the headers of the photos…");
        } else if typed(&held.form.photos).is_some() {
            ui.weak("There is no such folder.");
        }
        return;
    };
    match &photos.photos {
        Err(error) => {
            ui.colored_label(ui.visuals().error_fg_color, error);
        }
        Ok(set) => photo_set(set, ui),
    }
}

/// Most cameras and reasons that are listed; a folder of all sorts of pictures has dozens.
const MOST_LINES: usize = 8;

fn photo_set(set: &PhotoSet, ui: &mut egui::Ui) {
    let lines = found(set);
    let more = lines.len().saturating_sub(MOST_LINES);
    for (number, line) in lines.iter().enumerate() {
        // The last one says where they were taken.
        if (MOST_LINES - 1..lines.len() - 1).contains(&number) && more > 0 {
            if number == MOST_LINES - 1 {
                ui.label(format!("and {more} cameras more"));
            }
            continue;
        }
        match number {
            0 => ui.strong(line),
            _ => ui.label(line),
        };
    }
    let reasons = left_out(&set.left_out, set.count);
    let more = reasons.len().saturating_sub(MOST_LINES);
    let color = ui.visuals().warn_fg_color;
    for reason in reasons.iter().take(MOST_LINES) {
        ui.colored_label(color, format!("⚠ {reason}"));
    }
    if more > 0 {
        ui.colored_label(color, format!("⚠ and {more} reasons more"));
    }
}

/// What works.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Works {
    /// The only one that can be paused.
    Embedded,
    Colmap,
    OnNode,
}

fn progress(
    sentence: &str,
    fraction: f64,
    (works, is_paused): (Works, bool),
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let can_pause = works == Works::Embedded;
    match is_paused {
        true => ui.label(format!("Paused: {sentence}")),
        false => ui.label(sentence),
    };
    let bar = egui::ProgressBar::new(fraction as f32).show_percentage();
    ui.add(bar);
    ui.horizontal(|ui| {
        let cancel = ui.button("Cancel");
        cancel.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, true, "Cancel reconstruction")
        });
        let hover = match works {
            Works::OnNode => "The task on the node is cancelled and removed",
            _ => "What is done by then is kept: Start goes on with it",
        };
        if cancel.on_hover_text(hover).clicked() {
            commands.push(Command::Cancel(Task::RECONSTRUCT));
        }
        if can_pause {
            let pause = ui.button(if is_paused { "Go on" } else { "Pause" });
            pause.widget_info(|| {
                let name = match is_paused {
                    true => "Go on with the reconstruction",
                    false => "Pause reconstruction",
                };
                egui::WidgetInfo::labeled(egui::Role::Button, true, name)
            });
            let hover = match is_paused {
                true => "Go on where it waits",
                false => "End the photo or the pair that is being worked on, then wait and use no processor",
            };
            if pause.on_hover_text(hover).clicked() {
                commands.push(Command::FromPhotos(FromPhotosStep::Pause(!is_paused)));
            }
        }
        ui.weak(match (works, is_paused) {
            (_, true) => "It waits when this window is closed, too.",
            (Works::Embedded | Works::OnNode, false) => "It goes on when this window is closed.",
            (Works::Colmap, false) => {
                "It goes on when this window is closed. COLMAP cannot be paused."
            }
        });
    });
}

/// What the last run came to, and the button that starts one; so does Enter, where it was pressed in a field of a folder.
fn start(
    held: &FromPhotos,
    form: &FromPhotosForm,
    entered: bool,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let kept = "What was done is kept in that folder: Start goes on with it.";
    match &held.ended {
        None => {}
        Some(ended @ (Ended::Cancelled | Ended::Failed(_))) if held.node.is_some() => {
            ended_on_node(held, ended, ui);
        }
        Some(Ended::Cancelled) => {
            ui.label(format!("Cancelled. {kept}"));
        }
        Some(Ended::Failed(why)) => {
            ui.colored_label(ui.visuals().error_fg_color, why);
            if held.goes_on {
                ui.weak(kept);
            }
        }
        Some(Ended::Made(made)) => {
            for line in summary(made) {
                ui.label(line);
            }
            let open = ui.button("Open the flight");
            if open.on_hover_text("Look at what came out").clicked() {
                commands.push(Command::FromPhotos(FromPhotosStep::Open));
            }
            ui.separator();
        }
    }
    // What a field says that this click leaves comes first: the button must not wait for the next frame.
    let is_known = !form.node.chosen || form.node.typed().is_ok();
    let ready = held.photos().is_some() && is_known;
    let button = ui.add_enabled(ready, egui::Button::new("Start"));
    button.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Button, ready, "Start reconstruction")
    });
    let button = button.on_hover_text(
        "Finds what the photos have in common, where they were taken, and opens the flight. It can be \
         cancelled, and goes on later",
    );
    let button = button.on_disabled_hover_text(match is_known {
        true => "First name a folder with three photos or more",
        false => "First type the node's address",
    });
    if button.clicked() || (entered && ready) {
        commands.push(Command::FromPhotos(FromPhotosStep::Start));
    }
}
