//! What the tools that draw on the surface have measured: numbers and a plot, beside the viewport.

mod beside_line;
mod clip;
mod picked;
mod profile;
mod volume;

use crate::command::{Asking, Command, MeasuredTable};
use crate::open_flight::survey::{SurveyStep, SurveyTool};
use crate::state::State;
use beside_line::beside_what_is_looked_at;

/// The small window of the tool that is taken; it can be moved.
pub fn survey_panel(
    state: &State,
    context: &egui::Context,
    place: egui::Rect,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    clip::clip_panel(open, context, place, commands);
    picked::picked_panel(open, context, place, commands);
    let Some(drawn) = &open.pointer.drawn else {
        return;
    };
    let title = match drawn.tool {
        SurveyTool::Profile => "Profile",
        SurveyTool::Volume => "Volume",
    };
    let mut stays = true;
    let window = egui::Window::new(title)
        .open(&mut stays)
        .constrain_to(place)
        .pivot(egui::Align2::LEFT_BOTTOM)
        .resizable([true, false]);
    let window = beside_what_is_looked_at(window, state, (open, drawn), context, place);
    window.show(context, |ui| {
        match drawn.tool {
            SurveyTool::Profile => profile::profile(open, drawn, ui, commands),
            SurveyTool::Volume => volume::volume(open, drawn, ui, commands),
        }
        if let Some(Err(why)) = &drawn.measured {
            ui.colored_label(ui.visuals().warn_fg_color, why);
        }
        if drawn.points.is_empty() {
            ui.weak(match drawn.tool {
                SurveyTool::Profile => "Click the points of a line on the surface.",
                SurveyTool::Volume => "Click the corners of a polygon on the surface.",
            });
        } else if !drawn.finished {
            ui.weak("Double click or Enter ends it; Backspace takes a point back.");
        }
    });
    if !stays {
        commands.push(Command::Survey(SurveyStep::Leave));
    }
}

/// Rows of a name and a text, with the numbers at the right.
fn numbers(id: &str, rows: &[(&str, String)], ui: &mut egui::Ui) {
    egui::Grid::new(id)
        .num_columns(2)
        .striped(true)
        .show(ui, |ui| {
            for (name, said) in rows {
                ui.label(*name);
                ui.label(said);
                ui.end_row();
            }
        });
}

/// A button that copies a text.
fn copy(
    name: &str,
    hover: &str,
    text: Option<String>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let button = ui.add_enabled(text.is_some(), egui::Button::new(name));
    if button.on_hover_text(hover).clicked() {
        commands.extend(text.map(Command::Copy));
    }
}

/// A button that asks where a table goes.
fn save(table: MeasuredTable, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let hover = "The numbers as a CSV file, as the command writes it";
    if ui.button("Save CSV…").on_hover_text(hover).clicked() {
        commands.push(Command::Ask(Some(Asking::SaveMeasured(table))));
    }
}
