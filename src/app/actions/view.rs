//! Pages and views.

use egui::{Key, Modifiers};

use super::{Action, keys, on_pile, with_photo};
use crate::command::{Command, ViewChange};
use crate::size_distributions::Page;

actions! {
    PILE {
        label: "Pile",
        hover: "Show the flight over the pile",
        shortcut: keys(Modifiers::COMMAND, Key::Num1),
        command: |_| Some(Command::Page(Page::Pile)),
    }
    SIZE_DISTRIBUTIONS {
        label: "Size distributions",
        hover: "Show size distributions: fits, the reference, repeatability",
        shortcut: keys(Modifiers::COMMAND, Key::Num2),
        command: |_| Some(Command::Page(Page::SizeDistributions)),
    }
    TOP {
        label: "From above",
        hover: "Look straight down, north up",
        shortcut: keys(Modifiers::NONE, Key::T),
        command: |state| on_pile(state, Command::View(ViewChange::Top)),
    }
    FRONT {
        label: "From the front",
        hover: "Look to the north, level",
        shortcut: keys(Modifiers::NONE, Key::F),
        command: |state| on_pile(state, Command::View(ViewChange::Front)),
    }
    SIDE {
        label: "From the side",
        hover: "Look to the west, level",
        shortcut: keys(Modifiers::NONE, Key::S),
        command: |state| on_pile(state, Command::View(ViewChange::Side)),
    }
    FIT {
        label: "Show everything",
        hover: "Bring the whole flight into sight",
        shortcut: keys(Modifiers::NONE, Key::Home),
        command: |state| on_pile(state, Command::View(ViewChange::Fit)),
    }
    FIT_SELECTED {
        label: "Show the selected photo",
        hover: "Bring the selected photo's camera and footprint into sight",
        shortcut: keys(Modifiers::NONE, Key::Period),
        command: |state| with_photo(state, Command::View(ViewChange::FitSelected)),
    }
    THROUGH {
        label: "Look through the camera",
        hover: "See the surface as the selected photo does, with the photo over it",
        shortcut: keys(Modifiers::NONE, Key::C),
        command: |state| with_photo(state, Command::View(ViewChange::Through)),
    }
    LOG {
        label: "Log",
        hover: "Show or hide everything that was said",
        shortcut: keys(Modifiers::COMMAND, Key::L),
        command: |_| Some(Command::ToggleLog),
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(PILE),
    Some(SIZE_DISTRIBUTIONS),
    None,
    Some(TOP),
    Some(FRONT),
    Some(SIDE),
    Some(FIT),
    Some(FIT_SELECTED),
    Some(THROUGH),
    None,
    Some(LOG),
];
