//! The selected photo.

use egui::{Key, Modifiers};

use super::{Action, keys, on_pile};
use crate::command::Command;
use crate::open_flight::tracing::Trace;
use crate::scale::ScaleObjectKind;
use crate::state::State;

fn begin_tracing(state: &State, kind: ScaleObjectKind) -> Option<Command> {
    let open = state.open.as_ref()?;
    let possible = open.selected.is_some() && open.trace_size(kind).is_some();
    possible.then_some(Command::Trace(Trace::Begin(kind)))
}

actions! {
    NEXT {
        label: "Next photo",
        hover: "Select the next photo of the table",
        shortcut: keys(Modifiers::NONE, Key::ArrowDown),
        command: |state| on_pile(state, Command::SelectBy(1)),
    }
    PREVIOUS {
        label: "Previous photo",
        hover: "Select the photo above in the table",
        shortcut: keys(Modifiers::NONE, Key::ArrowUp),
        command: |state| on_pile(state, Command::SelectBy(-1)),
    }
    MEASURE {
        label: "Measure a distance",
        hover: "Click two points on the surface",
        shortcut: keys(Modifiers::NONE, Key::M),
        command: |state| on_pile(state, Command::ToggleMeasure),
    }
    TRACE_SPHERE {
        label: "Trace sphere",
        hover: "Mark the outline of a sphere of known size on the photo, to compare its scale",
        shortcut: None,
        command: |state| begin_tracing(state, ScaleObjectKind::Sphere),
    }
    TRACE_BAR {
        label: "Trace bar",
        hover: "Mark the two ends of a bar of known length on the photo, to compare its scale",
        shortcut: None,
        command: |state| begin_tracing(state, ScaleObjectKind::Bar),
    }
    FINISH_TRACING {
        label: "Finish the outline",
        hover: "Make a scale object of the points; a click on the first one does the same",
        shortcut: keys(Modifiers::NONE, Key::Enter),
        command: |state| {
            let tracing = state.open.as_ref()?.objects.tracing.as_ref()?;
            let is_complete = tracing.is_complete();
            is_complete.then_some(Command::Trace(Trace::Finish))
        },
    }
    REMOVE_POINT {
        label: "Remove the last point",
        hover: "Take the last point of the outline back",
        shortcut: keys(Modifiers::NONE, Key::Backspace),
        command: |state| {
            let tracing = state.open.as_ref()?.objects.tracing.as_ref()?;
            let has_points = !tracing.outline.is_empty();
            has_points.then_some(Command::Trace(Trace::RemoveLast))
        },
    }
    GIVE_UP_TRACING {
        label: "Give up tracing",
        hover: "Forget the points of the outline",
        shortcut: keys(Modifiers::NONE, Key::Escape),
        command: |state| {
            state.open.as_ref()?.objects.tracing.as_ref()?;
            Some(Command::Trace(Trace::GiveUp))
        },
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(NEXT),
    Some(PREVIOUS),
    None,
    Some(MEASURE),
    None,
    Some(TRACE_SPHERE),
    Some(TRACE_BAR),
    Some(FINISH_TRACING),
    Some(REMOVE_POINT),
    Some(GIVE_UP_TRACING),
];
