//! The review of doubtful photos, with keys alone.

use egui::{Key, Modifiers};

use super::{Action, keys, on_fragments, on_plan};
use crate::command::{Command, ReviewStep};
use crate::fragments::FragmentStep;
use crate::planning::PlanStep;
use crate::state::State;

fn reviewed(state: &State, step: ReviewStep) -> Option<Command> {
    let open = state.reviewed_flight().filter(|_| state.asking.is_none())?;
    (!open.table.doubtful.is_empty()).then_some(Command::Review(step))
}

/// Accepts the photo that is reviewed, where one is: what Enter does there.
pub(super) fn accept(state: &State) -> Option<Command> {
    let open = state.reviewed_flight()?;
    let (_, photo) = open.selected_review()?;
    let can = photo.is_doubtful() && open.why_not_accepted(&photo).is_none();
    can.then(|| reviewed(state, ReviewStep::Accept)).flatten()
}

actions! {
    NEXT_DOUBTFUL {
        label: "Next doubtful photo",
        hover: "Review the next photo that something speaks against and nobody has decided about",
        shortcut: keys(Modifiers::NONE, Key::N),
        command: |state| {
            if let Some(command) = on_fragments(state, |_| Some(FragmentStep::NextDoubtful)) {
                return command;
            }
            let doubtful = !state.open.as_ref()?.table.doubtful.is_empty();
            doubtful.then_some(Command::Review(ReviewStep::Next))
        },
    }
    DOUBTFUL_BEFORE {
        label: "Doubtful photo before",
        hover: "Go back to the photo before in the review",
        shortcut: keys(Modifiers::SHIFT, Key::N),
        command: |state| reviewed(state, ReviewStep::Back),
    }
    ACCEPT {
        label: "Accept the reviewed photo",
        hover: "Checked, accepted (Enter): it goes along into the export, with the note; go on to the next one",
        shortcut: None,
        command: |state| accept(state),
    }
    LEAVE_OUT {
        label: "Leave the reviewed photo out",
        hover: "Leave the photo out of the export, with the note, and go on to the next one",
        shortcut: keys(Modifiers::NONE, Key::Delete),
        command: |state| {
            if let Some(planning) = on_plan(state) {
                return planning.photo().map(|_| Command::Plan(PlanStep::Leave));
            }
            let fragments = on_fragments(state, |of| of.selected.map(|_| FragmentStep::Delete));
            if let Some(command) = fragments {
                return command;
            }
            let (_, photo) = state.reviewed_flight()?.selected_review()?;
            photo.is_doubtful().then(|| reviewed(state, ReviewStep::LeaveOut)).flatten()
        },
    }
    WRITE_NOTE {
        label: "Write the note",
        hover: "Type why the photo is accepted or left out; Enter accepts with it",
        shortcut: keys(Modifiers::NONE, Key::W),
        command: |state| reviewed(state, ReviewStep::WriteNote),
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(NEXT_DOUBTFUL),
    Some(DOUBTFUL_BEFORE),
    None,
    Some(ACCEPT),
    Some(LEAVE_OUT),
    Some(WRITE_NOTE),
];
