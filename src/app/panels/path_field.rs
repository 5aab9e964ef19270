//! A field for a path, with the desktop's own dialog beside it.

use std::path::{Path, PathBuf};

use crate::command::{Command, Dialog};
use crate::files;
use crate::state::State;
use crate::typed::typed;

/// A path that is typed, or chosen in the desktop's dialog. Returns the text of now, and whether
/// Enter was pressed in it.
pub(super) fn path_field(
    state: &State,
    ui: &mut egui::Ui,
    start: &Path,
    browse: &[(&str, Dialog)],
    commands: &mut Vec<Command>,
) -> (String, bool) {
    // Kept until another flight is open.
    let id = ui.scope_id().with((
        "path",
        state
            .open
            .as_ref()
            .map(|open| open.files.origin.suggested_file()),
    ));
    let mut path: String = ui
        .data(|data| data.get_temp(id))
        .unwrap_or_else(|| start.display().to_string());
    if let Some(answered) = &state.answered {
        path = answered.display().to_string();
        commands.push(Command::TakeAnswer);
    }
    let field = ui.add(egui::TextEdit::singleline(&mut path).desired_width(440.0));
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Path");
        info.current_text_value = Some(path.clone());
        info
    });
    let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
    takes_the_keys_at_first(ui, &field);
    takes_the_keys_again(state, ui, &field, entered);
    ui.horizontal(|ui| {
        for (name, dialog) in browse {
            let hover = "Choose in the desktop's own dialog";
            if ui.button(*name).on_hover_text(hover).clicked() {
                commands.push(Command::Browse(*dialog));
            }
        }
    });
    ui.data_mut(|data| data.insert_temp(id, path.clone()));
    (path, entered)
}

/// The same with a button below it: the path, once the button or Enter is pressed.
pub(super) fn taken_path(
    state: &State,
    ui: &mut egui::Ui,
    start: &Path,
    browse: &[(&str, Dialog)],
    button: &str,
    commands: &mut Vec<Command>,
) -> Option<PathBuf> {
    let (path, entered) = path_field(state, ui, start, browse, commands);
    ui.separator();
    let path = typed(&path);
    let button = ui.add_enabled(path.is_some(), egui::Button::new(button));
    path.filter(|_| button.clicked() || entered)
}

/// The same for a file that is to be written: where its folder is not there, that is said below and the window stays.
pub(super) fn path_to_write(
    state: &State,
    ui: &mut egui::Ui,
    start: &Path,
    browse: &[(&str, Dialog)],
    button: &str,
    commands: &mut Vec<Command>,
) -> Option<PathBuf> {
    let taken = taken_path(state, ui, start, browse, button, commands);
    in_a_folder(ui, taken)
}

/// Of a path that was taken, unless its folder is not there: then it says so until another one is taken.
pub(super) fn in_a_folder(ui: &mut egui::Ui, taken: Option<PathBuf>) -> Option<PathBuf> {
    let id = ui.scope_id().with("no folder");
    let taken = taken.and_then(|path| {
        let has = files::has_folder(&path);
        let why = has.as_ref().err().map(ToString::to_string);
        ui.data_mut(|data| data.insert_temp(id, why.unwrap_or_default()));
        has.ok().map(|()| path)
    });
    let why: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    if taken.is_none() && !why.is_empty() {
        ui.colored_label(ui.visuals().error_fg_color, why);
    }
    taken
}

/// Where the window is still there behind Enter, what was named was not taken, or not yet: it is typed on in the same field.
fn takes_the_keys_again(state: &State, ui: &egui::Ui, field: &egui::Response, entered: bool) {
    let id = ui.scope_id().with("entered");
    let before: bool = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    // A question is answered first, and who goes on elsewhere stays there.
    let waits = before && state.held_back.is_some();
    if before && !waits && ui.memory(|memory| memory.focused().is_none()) {
        field.request_focus();
    }
    ui.data_mut(|data| data.insert_temp(id, entered || waits));
}

/// She asked for this window, so what she types or pastes next belongs into this field of it.
pub(super) fn takes_the_keys_at_first(ui: &egui::Ui, field: &egui::Response) {
    let seen = ui.scope_id().with("seen");
    let now = ui.ctx().cumulative_frame_nr();
    let last: Option<u64> = ui.data(|data| data.get_temp(seen));
    if last.is_none_or(|last| last + 1 < now) {
        field.request_focus();
    }
    ui.data_mut(|data| data.insert_temp(seen, now));
}
