//! Pages and views. The pages' keys count them from left to right, as they stand in the tool bar.

use egui::{Key, Modifiers};

use super::{Action, in_viewport, keys, on_pile, on_plan, turning, with_flight, with_photo};
use crate::command::{Command, ViewChange};
use crate::photo_view::{Middle, PhotoCommand};
use crate::planning::PlanStep;
use crate::size_distributions::Page;
use crate::state::State;

/// Shows this in the middle, or the pile where it is there already.
fn middle(state: &State, middle: Middle) -> Option<Command> {
    let wanted = match state.middle == middle {
        true => Middle::Pile,
        false => middle,
    };
    on_pile(state, Command::Photo(PhotoCommand::Middle(wanted)))
}

fn in_photo(state: &State, command: PhotoCommand) -> Option<Command> {
    if state.page == Page::Fragments {
        let open = state.open.as_ref()?;
        return open.selected.map(|_| Command::Photo(command));
    }
    with_photo(state, Command::Photo(command)).filter(|_| state.middle.has_photo())
}

fn has_panels(state: &State, command: Command) -> Option<Command> {
    let has = match state.page {
        Page::Pile | Page::Map | Page::Plan | Page::Fragments => state.open.is_some(),
        Page::SizeDistributions => !state.distributions.sources().is_empty(),
    };
    has.then_some(command)
}

actions! {
    PILE {
        label: "Pile",
        hover: "Show the flight over the pile",
        shortcut: keys(Modifiers::COMMAND, Key::Num1),
        command: |_| Some(Command::Page(Page::Pile)),
    }
    MAP {
        label: "Map",
        hover: "Show the flight as a plan: hillshade, footprints, grid, scale bar",
        shortcut: keys(Modifiers::COMMAND, Key::Num2),
        command: |state| with_flight(state, Command::Page(Page::Map)),
    }
    PLAN {
        label: "Flight plan",
        hover: "Plan photos of this surface: where from, what each will show, and the mission for the drone",
        shortcut: keys(Modifiers::COMMAND, Key::Num3),
        command: |state| with_flight(state, Command::Page(Page::Plan)),
    }
    FRAGMENTS {
        label: "Fragments",
        hover: "Outline the fragments of the selected photo, correct them, and measure them where they lie",
        shortcut: keys(Modifiers::COMMAND, Key::Num4),
        command: |state| with_flight(state, Command::Page(Page::Fragments)),
    }
    SIZE_DISTRIBUTIONS {
        label: "Size distributions",
        hover: "Show size distributions: fits, the reference, repeatability",
        shortcut: keys(Modifiers::COMMAND, Key::Num5),
        command: |_| Some(Command::Page(Page::SizeDistributions)),
    }
    TOP {
        label: "From above",
        hover: "Look straight down, north up",
        shortcut: keys(Modifiers::NONE, Key::T),
        keypad: Key::Num7,
        command: |state| in_viewport(state, Command::View(ViewChange::Top)),
    }
    FRONT {
        label: "From the front",
        hover: "Look to the north, level",
        shortcut: keys(Modifiers::NONE, Key::F),
        keypad: Key::Num1,
        command: |state| in_viewport(state, Command::View(ViewChange::Front)),
    }
    SIDE {
        label: "From the side",
        hover: "Look to the west, level",
        shortcut: keys(Modifiers::NONE, Key::S),
        keypad: Key::Num3,
        command: |state| in_viewport(state, Command::View(ViewChange::Side)),
    }
    FIT {
        label: "Show everything",
        hover: "Bring the whole flight into sight, without points that lie far off it",
        shortcut: keys(Modifiers::NONE, Key::Home),
        keypad: Key::Num0,
        command: |state| in_viewport(state, Command::View(ViewChange::Fit)),
    }
    FIT_ALL {
        label: "Show all points",
        hover: "Bring everything into sight, with the points that lie far off",
        shortcut: keys(Modifiers::SHIFT, Key::Home),
        command: |state| in_viewport(state, Command::View(ViewChange::FitAll)),
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
        command: |state| match on_plan(state) {
            Some(planning) => planning.photo().map(|_| Command::Plan(PlanStep::ToggleThrough)),
            None => with_photo(state, Command::View(ViewChange::Through)),
        },
    }
    PHOTO_ALONE {
        label: "Photo in the middle",
        hover: "Show the selected photo at full resolution instead of the pile, or the pile again",
        shortcut: keys(Modifiers::NONE, Key::P),
        command: |state| middle(state, Middle::Photo),
    }
    PHOTO_BESIDE {
        label: "Photo beside the pile",
        hover: "Show the selected photo at full resolution beside the pile, or the pile alone again",
        shortcut: keys(Modifiers::NONE, Key::B),
        command: |state| middle(state, Middle::Both),
    }
    PHOTO_ONE_TO_ONE {
        label: "Photo one to one",
        hover: "A pixel of the photo is a pixel of the screen",
        shortcut: keys(Modifiers::NONE, Key::Z),
        command: |state| in_photo(state, PhotoCommand::OneToOne),
    }
    PHOTO_FIT {
        label: "Whole photo",
        hover: "Show all of the photo in the photo view",
        shortcut: keys(Modifiers::SHIFT, Key::Z),
        command: |state| in_photo(state, PhotoCommand::Fit),
    }
    LEFT_PANEL {
        label: "Table",
        hover: "Show or hide the panel at the left: the photos, or the size distributions. A very narrow window has room for one: \
                close the right one first",
        shortcut: keys(Modifiers::NONE, Key::F2),
        command: |state| has_panels(state, Command::ToggleLeft),
    }
    RIGHT_PANEL {
        label: "Photo and settings",
        hover: "Show or hide the panel at the right: photo and settings, or results",
        shortcut: keys(Modifiers::NONE, Key::F3),
        command: |state| has_panels(state, Command::ToggleRight),
    }
    HEALTH {
        label: "Flight health",
        hover: "Show or hide the strip of unit, coordinates, up axis, colours, EXIF, holes and photos",
        shortcut: keys(Modifiers::NONE, Key::F4),
        command: |state| on_pile(state, Command::ToggleHealth),
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
    Some(MAP),
    Some(PLAN),
    Some(FRAGMENTS),
    Some(SIZE_DISTRIBUTIONS),
    None,
    Some(TOP),
    Some(FRONT),
    Some(SIDE),
    Some(turning::OPPOSITE),
    Some(turning::PARALLEL),
    Some(turning::LEFT),
    Some(turning::RIGHT),
    Some(turning::UP),
    Some(turning::DOWN),
    None,
    Some(FIT),
    Some(FIT_ALL),
    Some(FIT_SELECTED),
    Some(THROUGH),
    None,
    Some(PHOTO_ALONE),
    Some(PHOTO_BESIDE),
    Some(PHOTO_ONE_TO_ONE),
    Some(PHOTO_FIT),
    None,
    Some(LEFT_PANEL),
    Some(RIGHT_PANEL),
    Some(HEALTH),
    Some(LOG),
];
