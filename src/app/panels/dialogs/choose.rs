//! The flights that a folder holds, to choose from.

use std::path::{Path, PathBuf};

use crate::command::Command;
use crate::formats::Candidate;
use crate::panels::Scrolled;
use crate::state::State;

/// Draws a button for each.
pub(super) fn choose(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let folder = common_folder(&state.choices);
    ui.label(format!("{} holds several:", folder.display()));
    egui::ScrollArea::vertical()
        .max_height(300.0)
        .show_focused(ui, |ui| {
            for candidate in &state.choices {
                let button = ui.button(candidate.in_words(&folder));
                let hover = candidate.path.display().to_string();
                if button.on_hover_text(hover).clicked() {
                    commands.push(Command::Open(candidate.path.clone()));
                }
            }
        });
}

/// The deepest folder that all of them lie in.
fn common_folder(choices: &[Candidate]) -> PathBuf {
    let Some((first, others)) = choices.split_first() else {
        return PathBuf::new();
    };
    let mut folder = first.path.parent().unwrap_or(Path::new("")).to_owned();
    while !others.iter().all(|other| other.path.starts_with(&folder)) && folder.pop() {}
    folder
}
