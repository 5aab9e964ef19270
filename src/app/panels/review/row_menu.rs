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
    let decide = |kind| Command::Decide(photo, Some((kind, open.note_of(photo).to_owned())));
    let select = || Command::Select(Some(photo));
    let why_not = open.why_not_accepted(&reviewed);
    let nothing_decided = reviewed.decision.is_none();
    let scales = state.scales_of(photo);
    let no_scales = scales.is_none();
    // What it is called, why it makes no sense now, and what it does.
    let entries = [
        (
            "Go to",
            None,
            vec![select(), Command::View(ViewChange::FitSelected)],
        ),
        ("Accept", why_not, vec![decide(DecisionKind::Accepted)]),
        ("Leave out", None, vec![decide(DecisionKind::LeftOut)]),
        (
            "Take the decision back",
            nothing_decided.then_some("Nothing is decided of it"),
            vec![Command::Decide(photo, None)],
        ),
        (
            "Copy scales",
            no_scales.then_some("There are no scales to copy now"),
            scales.into_iter().map(Command::Copy).collect(),
        ),
        (
            "Copy file name",
            None,
            vec![Command::Copy(reviewed.name().to_owned())],
        ),
    ];
    ui.weak(reviewed.name());
    for (name, why_not, does) in entries {
        let button = ui.add_enabled(why_not.is_none(), egui::Button::new(name));
        let button = button.on_disabled_hover_text(why_not.unwrap_or_default());
        if button.clicked() {
            commands.extend(does);
            ui.close();
        }
    }
}
