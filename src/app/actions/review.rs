//! The review of photos, with keys alone: N goes through the doubtful ones, arrows through all.

use egui::{Key, Modifiers};

use super::{Action, beside_photos, keys, on_fragments, on_pile, on_plan};
use crate::command::{Command, ReviewStep, Tab};
use crate::fragments::FragmentStep;
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::Drawn;
use crate::planning::PlanStep;
use crate::state::State;

fn reviewed(state: &State, step: ReviewStep) -> Option<Command> {
    let open = state.reviewed_flight().filter(|_| state.asking.is_none())?;
    open.selected.map(|_| Command::Review(step))
}

/// The same on the photo's own panel, which has a note, too.
fn on_photo_panel(state: &State, step: ReviewStep) -> Option<Command> {
    let in_sight = state.tab == Tab::Photo && state.preferences.right_open;
    let is_selected = state
        .open
        .as_deref()
        .is_some_and(|open| open.selected.is_some());
    let can = in_sight && is_selected && state.asking.is_none();
    on_pile(state, Command::Review(step)).filter(|_| can)
}

/// Whether points are set with the mouse: Delete would be meant for the last of them.
fn is_setting_points(open: &OpenFlight) -> bool {
    let pointer = &open.pointer;
    open.objects.tracing.is_some()
        || open.control.is_on && open.control.chosen.is_some()
        || pointer.drawn.as_ref().is_some_and(Drawn::is_in_hand)
        || pointer.picked.is_on
}

/// Leaves the selected photo out, doubtful or not, in a review or beside it.
fn leave_out(state: &State) -> Option<Command> {
    let open = state.open.as_deref().filter(|_| state.asking.is_none())?;
    let (_, photo) = open.selected_review()?;
    let is_in_turn = state.reviewed_flight().is_some() && photo.is_doubtful();
    let can = is_in_turn || !is_setting_points(open);
    can.then(|| beside_photos(state, Command::Review(ReviewStep::LeaveOut)))
        .flatten()
}

/// Accepts the photo that is reviewed, where one is: what Enter does there.
pub(super) fn accept(state: &State) -> Option<Command> {
    let open = state.reviewed_flight()?;
    let (_, photo) = open.selected_review()?;
    // Nothing is to be accepted of a photo that goes along by itself: Enter in its note keeps what was decided.
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
        command: |state| {
            let open = state.reviewed_flight().filter(|_| state.asking.is_none())?;
            (!open.table.doubtful.is_empty()).then_some(Command::Review(ReviewStep::Back))
        },
    }
    ACCEPT {
        label: "Accept the reviewed photo",
        hover: "Checked, accepted (Enter): it goes along into the export, with the note; go on to the next one",
        shortcut: None,
        command: |state| accept(state),
    }
    LEAVE_OUT {
        label: "Leave the selected photo out",
        hover: "Leave the photo out of the export, with the note; in a review of doubtful photos go on to the next one",
        shortcut: keys(Modifiers::NONE, Key::Delete),
        command: |state| {
            if let Some(planning) = on_plan(state) {
                return planning.photo().map(|_| Command::Plan(PlanStep::Leave));
            }
            let fragments = on_fragments(state, |of| of.selected.map(|_| FragmentStep::Delete));
            if let Some(command) = fragments {
                return command;
            }
            leave_out(state)
        },
    }
    WRITE_NOTE {
        label: "Write the note",
        hover: "Type why the photo is accepted or left out; Enter accepts a doubtful one with it",
        shortcut: keys(Modifiers::NONE, Key::W),
        command: |state| {
            let step = ReviewStep::WriteNote;
            reviewed(state, step.clone()).or_else(|| on_photo_panel(state, step))
        },
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
