//! Undo, and which photos are chosen.

use egui::{Key, Modifiers};

use super::{Action, SHIFT, beside_photos, keys, on_pile, on_plan, with_flight};
use crate::command::{Choice, Command};
use crate::open_flight::reviewing::no_scale;
use crate::open_flight::survey::{Drawn, SurveyStep};
use crate::size_distributions::{DistributionCommand, Page};
use crate::state::history::History;

actions! {
    UNDO {
        label: "Undo",
        hover: "Undo the last change: of the flight's settings and photos to export, of the points while they \
                are picked or drawn, of the clipping box while its window is shown, or of the size distributions on their page",
        shortcut: keys(Modifiers::COMMAND, Key::Z),
        command: |state| {
            if state.page == Page::SizeDistributions {
                let can = state.distributions.history.can_undo();
                return can.then_some(Command::Undo);
            }
            if let Some(planning) = on_plan(state) {
                let can = planning.asked.as_ref().is_some_and(History::can_undo);
                return can.then_some(Command::Undo);
            }
            let open = state.open.as_ref()?;
            if state.page == Page::Fragments {
                return open.can_undo_fragments()[0].then_some(Command::Undo);
            }
            let drawn = open.pointer.drawn.as_ref();
            if drawn.is_some_and(Drawn::is_in_hand) {
                return on_pile(state, Command::Survey(SurveyStep::RemoveLast));
            }
            let picked = &open.pointer.picked;
            let can = open.history.can_undo()
                || picked.is_on && picked.history.can_undo()
                || open.clip.is_open && open.clip_history.can_undo();
            can.then_some(Command::Undo)
        },
    }
    REDO {
        label: "Redo",
        hover: "Take the last undo back",
        shortcut: keys(SHIFT, Key::Z),
        also: keys(Modifiers::COMMAND, Key::Y),
        command: |state| {
            if state.page == Page::SizeDistributions {
                let can = state.distributions.history.can_redo();
                return can.then_some(Command::Redo);
            }
            if let Some(planning) = on_plan(state) {
                let can = planning.asked.as_ref().is_some_and(History::can_redo);
                return can.then_some(Command::Redo);
            }
            let open = state.open.as_ref()?;
            if state.page == Page::Fragments {
                return open.can_undo_fragments()[1].then_some(Command::Redo);
            }
            let picked = &open.pointer.picked;
            let can = open.history.can_redo()
                || picked.is_on && picked.history.can_redo()
                || open.clip.is_open && open.clip_history.can_redo();
            can.then_some(Command::Redo)
        },
    }
    COPY_SCALES {
        label: "Copy scales",
        hover: "Copy the selected photo's top and bottom scale, as Split-Desktop's dialog asks for them",
        shortcut: keys(SHIFT, Key::C),
        command: |state| state.scales_to_copy().map(|_| Command::CopyScales),
    }
    CHOOSE {
        label: "Leave this photo out of the export, or take it along",
        hover: "Take the selected photo along into the export, or leave it out",
        shortcut: keys(Modifiers::NONE, Key::Space),
        command: |state| {
            let open = state.open.as_ref()?;
            let photo = open.selected?;
            let row = open.row(photo)?;
            let goes_along = row.goes_along();
            if !goes_along && no_scale(&row.line.photo).is_some() {
                return None;
            }
            beside_photos(state, Command::Choose(photo, !goes_along))
        },
    }
    CHOOSE_TRUSTED {
        label: "Choose trusted photos",
        hover: "Choose for export the photos without any reason for doubt",
        shortcut: None,
        command: |state| {
            let looked = state.open.as_ref()?.review.is_looked_at();
            looked.then_some(Command::ChooseAll(Choice::Trusted))
        },
    }
    CHOOSE_ALL {
        label: "Choose all photos with a scale",
        hover: "Choose for export every photo that has a top and a bottom scale",
        shortcut: None,
        command: |state| with_flight(state, Command::ChooseAll(Choice::WithScale)),
    }
    CHOOSE_NONE {
        label: "Choose no photo",
        hover: "Leave all photos out of the export",
        shortcut: None,
        command: |state| with_flight(state, Command::ChooseAll(Choice::None)),
    }
    REMOVE_ALL {
        label: "Remove all size distributions",
        hover: "Take every file and table from the page of size distributions; undo brings them back",
        shortcut: None,
        command: |state| {
            let some = !state.distributions.sources().is_empty();
            some.then_some(Command::Distributions(DistributionCommand::RemoveAll))
        },
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(UNDO),
    Some(REDO),
    None,
    Some(COPY_SCALES),
    None,
    Some(CHOOSE),
    Some(CHOOSE_TRUSTED),
    Some(CHOOSE_ALL),
    Some(CHOOSE_NONE),
    None,
    Some(REMOVE_ALL),
];
