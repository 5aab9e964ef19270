//! What can be done with a photo of the table, under the right mouse button.

use crate::command::{Command, ViewChange};
use crate::flight::DecisionKind;
use crate::state::State;

/// Draws the menu of a row.
pub(in crate::panels) fn row_menu(
    state: &State,
    photo: usize,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    let Some(reviewed) = open.review.photo(photo) else {
        return;
    };
    let note = || {
        reviewed
            .decision
            .map_or_else(String::new, |d| d.note.clone())
    };
    let decide = |kind| Command::Decide(photo, Some((kind, note())));
    let select = || Command::Select(Some(photo));
    let can_accept = reviewed.is_looked_at && open.is_computed();
    let scales = state.scales_of(photo);
    let entries = [
        (
            "Go to",
            true,
            vec![select(), Command::View(ViewChange::FitSelected)],
        ),
        ("Accept", can_accept, vec![decide(DecisionKind::Accepted)]),
        ("Leave out", true, vec![decide(DecisionKind::LeftOut)]),
        (
            "Take the decision back",
            reviewed.decision.is_some(),
            vec![Command::Decide(photo, None)],
        ),
        (
            "Copy scales",
            scales.is_some(),
            scales.into_iter().map(Command::Copy).collect(),
        ),
        (
            "Copy file name",
            true,
            vec![Command::Copy(reviewed.name().to_owned())],
        ),
    ];
    ui.weak(reviewed.name());
    for (name, is_possible, does) in entries {
        let button = ui.add_enabled(is_possible, egui::Button::new(name));
        if button.clicked() {
            commands.extend(does);
            ui.close();
        }
    }
}
