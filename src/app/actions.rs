//! Named actions: the menu's entry, the shortcut and the tooltip of each are this one entry.

use egui::{Key, KeyboardShortcut, Modifiers};

use crate::command::{Answers, Asking, Choice, Command, Dialog, ViewChange};
use crate::open_flight::tracing::Trace;
use crate::scale::ScaleObjectKind;
use crate::size_distributions::{DistributionCommand, Page};
use crate::state::State;

/// What an entry of the menu does.
#[derive(Debug, Clone, Copy)]
pub struct Action {
    /// Its name in the menu.
    pub label: &'static str,
    /// What it does, as a tooltip.
    pub hover: &'static str,
    /// Its keys.
    pub shortcut: Option<KeyboardShortcut>,
    /// What it sends; `None` where it makes no sense now, and the entry is grey.
    pub command: fn(&State) -> Option<Command>,
}

const fn keys(modifiers: Modifiers, key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(modifiers, key))
}

const SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

fn with_flight(state: &State, command: Command) -> Option<Command> {
    state.open.is_some().then_some(command)
}

fn with_distributions(state: &State, asking: Asking) -> Option<Command> {
    let computed = state.distributions.computed.is_some();
    computed.then_some(Command::Ask(Some(asking)))
}

/// What is done in sight of the pile.
fn on_pile(state: &State, command: Command) -> Option<Command> {
    let in_sight = state.page == Page::Pile;
    in_sight.then(|| with_flight(state, command)).flatten()
}

fn with_photo(state: &State, command: Command) -> Option<Command> {
    let open = state.open.as_ref().filter(|_| state.page == Page::Pile)?;
    open.selected.map(|_| command)
}

/// See its `hover`.
pub const OPEN: Action = Action {
    label: "Open…",
    hover: "Open a flight: a flight.toml, or what a photogrammetry package wrote",
    shortcut: keys(Modifiers::COMMAND, Key::O),
    command: |_| Some(Command::Ask(Some(Asking::Open))),
};
/// See its `hover`.
pub const OPEN_FILE: Action = Action {
    label: "Open file…",
    hover: "Choose a file with the desktop's own dialog",
    shortcut: None,
    command: |_| {
        Some(Command::Browse(
            Dialog::file("Open a flight").answering(Answers::Open),
        ))
    },
};
/// See its `hover`.
pub const OPEN_FOLDER: Action = Action {
    label: "Open folder…",
    hover: "Choose a folder with the desktop's own dialog",
    shortcut: None,
    command: |_| {
        Some(Command::Browse(
            Dialog::folder("Open a flight's folder").answering(Answers::Open),
        ))
    },
};
/// See its `hover`.
pub const ADD: Action = Action {
    label: "Add surface or photos…",
    hover: "Give the flight another cloud or mesh as its surface, or the folder of its photos",
    shortcut: keys(SHIFT, Key::O),
    command: |state| {
        let wanted = state.open.is_some() || state.tried.is_some();
        wanted.then_some(Command::Ask(Some(Asking::Add)))
    },
};
/// See its `hover`.
pub const GEOREFERENCE: Action = Action {
    label: "Georeference…",
    hover: "Bring a reconstruction in a frame of its own to the world, or to its true scale, by what \
            is known of it",
    shortcut: None,
    command: |state| {
        state.open.as_ref()?.reconstruction.as_ref()?;
        Some(Command::Ask(Some(Asking::Georeference)))
    },
};
/// See its `hover`.
pub const OPEN_SAMPLE: Action = Action {
    label: "Open the sample flight",
    hover: "Nine photos of the paper's lab, simulated, with known answers",
    shortcut: None,
    command: |_| Some(Command::OpenSample),
};
/// See its `hover`.
pub const SAVE: Action = Action {
    label: "Save",
    hover: "Write the flight's settings into its flight.toml",
    shortcut: keys(Modifiers::COMMAND, Key::S),
    command: |state| with_flight(state, Command::Save),
};
/// See its `hover`.
pub const SAVE_AS: Action = Action {
    label: "Save as…",
    hover: "Write a flight.toml at another place",
    shortcut: keys(SHIFT, Key::S),
    command: |state| with_flight(state, Command::Ask(Some(Asking::SaveAs))),
};
/// See its `hover`.
pub const EXPORT: Action = Action {
    label: "Export for Split-Desktop…",
    hover: "Write a folder with the scales, a sheet to type from, undistorted photos and overlays",
    shortcut: keys(Modifiers::COMMAND, Key::E),
    command: |state| with_flight(state, Command::Ask(Some(Asking::Export))),
};
/// See its `hover`.
pub const PICTURE: Action = Action {
    label: "Save picture…",
    hover: "Write the viewport, or the corner-ray figure, as a PNG of any size",
    shortcut: keys(Modifiers::COMMAND, Key::P),
    command: |state| on_pile(state, Command::Ask(Some(Asking::Picture))),
};
/// See its `hover`.
pub const CLOSE: Action = Action {
    label: "Close flight",
    hover: "Go back to the start page",
    shortcut: keys(Modifiers::COMMAND, Key::W),
    command: |state| with_flight(state, Command::Close),
};
/// See its `hover`.
pub const QUIT: Action = Action {
    label: "Quit",
    hover: "Leave fragscale",
    shortcut: keys(Modifiers::COMMAND, Key::Q),
    command: |_| Some(Command::Quit),
};
/// See its `hover`.
pub const UNDO: Action = Action {
    label: "Undo",
    hover: "Undo the last change: of the flight's settings and photos to export, or of the size \
            distributions on their page",
    shortcut: keys(Modifiers::COMMAND, Key::Z),
    command: |state| {
        if state.page == Page::SizeDistributions {
            let can = state.distributions.history.can_undo();
            return can.then_some(Command::Undo);
        }
        let open = state.open.as_ref()?;
        open.history.can_undo().then_some(Command::Undo)
    },
};
/// See its `hover`.
pub const REDO: Action = Action {
    label: "Redo",
    hover: "Take the last undo back",
    shortcut: keys(SHIFT, Key::Z),
    command: |state| {
        if state.page == Page::SizeDistributions {
            let can = state.distributions.history.can_redo();
            return can.then_some(Command::Redo);
        }
        let open = state.open.as_ref()?;
        open.history.can_redo().then_some(Command::Redo)
    },
};
/// See its `hover`.
pub const COPY_SCALES: Action = Action {
    label: "Copy scales",
    hover: "Copy the selected photo's top and bottom scale, as Split-Desktop's dialog asks for them",
    shortcut: keys(SHIFT, Key::C),
    command: |state| state.scales_to_copy().map(|_| Command::CopyScales),
};
/// See its `hover`.
pub const CHOOSE_TRUSTED: Action = Action {
    label: "Choose trusted photos",
    hover: "Choose for export the photos without any reason for doubt",
    shortcut: None,
    command: |state| {
        let looked = state.open.as_ref()?.views.is_some();
        looked.then_some(Command::ChooseAll(Choice::Trusted))
    },
};
/// See its `hover`.
pub const CHOOSE_ALL: Action = Action {
    label: "Choose all photos with a scale",
    hover: "Choose for export every photo that has a top and a bottom scale",
    shortcut: None,
    command: |state| with_flight(state, Command::ChooseAll(Choice::WithScale)),
};
/// See its `hover`.
pub const CHOOSE_NONE: Action = Action {
    label: "Choose no photo",
    hover: "Leave all photos out of the export",
    shortcut: None,
    command: |state| with_flight(state, Command::ChooseAll(Choice::None)),
};
/// See its `hover`.
pub const NEXT: Action = Action {
    label: "Next photo",
    hover: "Select the next photo of the table",
    shortcut: keys(Modifiers::NONE, Key::ArrowDown),
    command: |state| on_pile(state, Command::SelectBy(1)),
};
/// See its `hover`.
pub const PREVIOUS: Action = Action {
    label: "Previous photo",
    hover: "Select the photo above in the table",
    shortcut: keys(Modifiers::NONE, Key::ArrowUp),
    command: |state| on_pile(state, Command::SelectBy(-1)),
};
/// See its `hover`.
pub const CHOOSE: Action = Action {
    label: "Export this photo or not",
    hover: "Choose the selected photo for export, or leave it out",
    shortcut: keys(Modifiers::NONE, Key::Space),
    command: |state| {
        let open = state.open.as_ref()?;
        let photo = open.selected?;
        let chosen = *open.history.now().chosen.get(photo)?;
        on_pile(state, Command::Choose(photo, !chosen))
    },
};
/// See its `hover`.
pub const TOP: Action = Action {
    label: "From above",
    hover: "Look straight down, north up",
    shortcut: keys(Modifiers::NONE, Key::T),
    command: |state| on_pile(state, Command::View(ViewChange::Top)),
};
/// See its `hover`.
pub const FRONT: Action = Action {
    label: "From the front",
    hover: "Look to the north, level",
    shortcut: keys(Modifiers::NONE, Key::F),
    command: |state| on_pile(state, Command::View(ViewChange::Front)),
};
/// See its `hover`.
pub const SIDE: Action = Action {
    label: "From the side",
    hover: "Look to the west, level",
    shortcut: keys(Modifiers::NONE, Key::S),
    command: |state| on_pile(state, Command::View(ViewChange::Side)),
};
/// See its `hover`.
pub const FIT: Action = Action {
    label: "Show everything",
    hover: "Bring the whole flight into sight",
    shortcut: keys(Modifiers::NONE, Key::Home),
    command: |state| on_pile(state, Command::View(ViewChange::Fit)),
};
/// See its `hover`.
pub const FIT_SELECTED: Action = Action {
    label: "Show the selected photo",
    hover: "Bring the selected photo's camera and footprint into sight",
    shortcut: keys(Modifiers::NONE, Key::Period),
    command: |state| with_photo(state, Command::View(ViewChange::FitSelected)),
};
/// See its `hover`.
pub const THROUGH: Action = Action {
    label: "Look through the camera",
    hover: "See the surface as the selected photo does, with the photo over it",
    shortcut: keys(Modifiers::NONE, Key::C),
    command: |state| with_photo(state, Command::View(ViewChange::Through)),
};
/// See its `hover`.
pub const MEASURE: Action = Action {
    label: "Measure a distance",
    hover: "Click two points on the surface",
    shortcut: keys(Modifiers::NONE, Key::M),
    command: |state| on_pile(state, Command::ToggleMeasure),
};
/// See its `hover`.
pub const ADD_DISTRIBUTIONS: Action = Action {
    label: "Add size distributions…",
    hover: "Add tables of cumulative percent passing by size: what Split-Desktop or a sieve gave",
    shortcut: keys(Modifiers::COMMAND, Key::D),
    command: |_| Some(Command::Ask(Some(Asking::AddDistributions))),
};
/// See its `hover`.
pub const PASTE_TABLE: Action = Action {
    label: "Paste table…",
    hover: "Add a table of size distributions that was copied from a spreadsheet or a text",
    shortcut: keys(SHIFT, Key::D),
    command: |_| Some(Command::Ask(Some(Asking::PasteTable))),
};
/// See its `hover`.
pub const ADD_KNOWN: Action = Action {
    label: "Add the flight's known fragments",
    hover: "Add reference.csv beside the flight on the screen: the sieve curve of its fragments",
    shortcut: None,
    command: |state| {
        state.known_fragments()?;
        Some(Command::Distributions(DistributionCommand::AddKnown))
    },
};
/// See its `hover`.
pub const REMOVE_ALL: Action = Action {
    label: "Remove all size distributions",
    hover: "Take every file and table from the page of size distributions; undo brings them back",
    shortcut: None,
    command: |state| {
        let some = !state.distributions.sources().is_empty();
        some.then_some(Command::Distributions(DistributionCommand::RemoveAll))
    },
};
/// See its `hover`.
pub const SAVE_FIGURE: Action = Action {
    label: "Save figure…",
    hover: "Write the figure of the size distributions as an SVG or PNG",
    shortcut: None,
    command: |state| with_distributions(state, Asking::SaveFigure),
};
/// See its `hover`.
pub const SAVE_REPORT: Action = Action {
    label: "Save report…",
    hover: "Write the figure and all tables of methods held against the reference as an HTML page",
    shortcut: None,
    command: |state| {
        let compared = state.distributions.computed.as_ref()?.comparison.is_some();
        compared.then_some(Command::Ask(Some(Asking::SaveReport)))
    },
};
/// See its `hover`.
pub const PILE: Action = Action {
    label: "Pile",
    hover: "Show the flight over the pile",
    shortcut: keys(Modifiers::COMMAND, Key::Num1),
    command: |_| Some(Command::Page(Page::Pile)),
};
/// See its `hover`.
pub const SIZE_DISTRIBUTIONS: Action = Action {
    label: "Size distributions",
    hover: "Show size distributions: fits, the reference, repeatability",
    shortcut: keys(Modifiers::COMMAND, Key::Num2),
    command: |_| Some(Command::Page(Page::SizeDistributions)),
};
fn begin_tracing(state: &State, kind: ScaleObjectKind) -> Option<Command> {
    let open = state.open.as_ref()?;
    let possible = open.selected.is_some() && open.trace_size(kind).is_some();
    possible.then_some(Command::Trace(Trace::Begin(kind)))
}

/// See its `hover`.
pub const TRACE_SPHERE: Action = Action {
    label: "Trace sphere",
    hover: "Mark the outline of a sphere of known size on the photo, to compare its scale",
    shortcut: None,
    command: |state| begin_tracing(state, ScaleObjectKind::Sphere),
};
/// See its `hover`.
pub const TRACE_BAR: Action = Action {
    label: "Trace bar",
    hover: "Mark the two ends of a bar of known length on the photo, to compare its scale",
    shortcut: None,
    command: |state| begin_tracing(state, ScaleObjectKind::Bar),
};
/// See its `hover`.
pub const FINISH_TRACING: Action = Action {
    label: "Finish the outline",
    hover: "Make a scale object of the points; a click on the first one does the same",
    shortcut: keys(Modifiers::NONE, Key::Enter),
    command: |state| {
        let tracing = state.open.as_ref()?.tracing.as_ref()?;
        let is_complete = tracing.is_complete();
        is_complete.then_some(Command::Trace(Trace::Finish))
    },
};
/// See its `hover`.
pub const REMOVE_POINT: Action = Action {
    label: "Remove the last point",
    hover: "Take the last point of the outline back",
    shortcut: keys(Modifiers::NONE, Key::Backspace),
    command: |state| {
        let tracing = state.open.as_ref()?.tracing.as_ref()?;
        let has_points = !tracing.outline.is_empty();
        has_points.then_some(Command::Trace(Trace::RemoveLast))
    },
};
/// See its `hover`.
pub const GIVE_UP_TRACING: Action = Action {
    label: "Give up tracing",
    hover: "Forget the points of the outline",
    shortcut: keys(Modifiers::NONE, Key::Escape),
    command: |state| {
        state.open.as_ref()?.tracing.as_ref()?;
        Some(Command::Trace(Trace::GiveUp))
    },
};
/// See its `hover`.
pub const LOG: Action = Action {
    label: "Log",
    hover: "Show or hide everything that was said",
    shortcut: keys(Modifiers::COMMAND, Key::L),
    command: |_| Some(Command::ToggleLog),
};
/// See its `hover`.
pub const KEYS: Action = Action {
    label: "Keys and mouse",
    hover: "Which keys do what",
    shortcut: keys(Modifiers::NONE, Key::F1),
    command: |_| Some(Command::Ask(Some(Asking::Keys))),
};
/// See its `hover`.
pub const ABOUT: Action = Action {
    label: "About fragscale",
    hover: "What this program is",
    shortcut: None,
    command: |_| Some(Command::Ask(Some(Asking::About))),
};

/// The menus, in their order. An empty place is a line between entries.
pub const MENUS: [(&str, &[Option<Action>]); 5] = [
    (
        "File",
        &[
            Some(OPEN),
            Some(OPEN_FILE),
            Some(OPEN_FOLDER),
            Some(ADD),
            Some(GEOREFERENCE),
            Some(OPEN_SAMPLE),
            None,
            Some(ADD_DISTRIBUTIONS),
            Some(PASTE_TABLE),
            Some(ADD_KNOWN),
            Some(SAVE_FIGURE),
            Some(SAVE_REPORT),
            None,
            Some(SAVE),
            Some(SAVE_AS),
            None,
            Some(EXPORT),
            Some(PICTURE),
            None,
            Some(CLOSE),
            Some(QUIT),
        ],
    ),
    (
        "Edit",
        &[
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
        ],
    ),
    (
        "View",
        &[
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
        ],
    ),
    (
        "Photo",
        &[
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
        ],
    ),
    ("Help", &[Some(KEYS), Some(ABOUT)]),
];

/// All actions of the menus.
pub fn all() -> impl Iterator<Item = Action> {
    MENUS
        .into_iter()
        .flat_map(|(_, entries)| entries.iter().copied())
        .flatten()
}

/// The commands of the shortcuts that were pressed in this frame. Keys without Ctrl belong to a text
/// field while one has the focus.
pub fn pressed(state: &State, context: &egui::Context) -> Vec<Command> {
    if state.held_back.is_some() {
        // A question waits for its answer first.
        return Vec::new();
    }
    let typing = context.egui_wants_keyboard_input();
    // A text field has an undo of its own.
    let editing = context.text_edit_focused();
    let mut actions: Vec<Action> = all().filter(|action| action.shortcut.is_some()).collect();
    // Ctrl+Shift+Z before Ctrl+Z: egui takes the first that fits, and more modifiers fit less.
    actions.sort_by_key(|action| {
        let shift = action.shortcut.is_some_and(|keys| keys.modifiers.shift);
        std::cmp::Reverse(shift)
    });
    let mut commands = Vec::new();
    for action in actions {
        let Some(shortcut) = action.shortcut else {
            continue;
        };
        let undoes = [UNDO.shortcut, REDO.shortcut].contains(&action.shortcut);
        if (typing && !shortcut.modifiers.command) || (editing && undoes) {
            continue;
        }
        if let Some(command) = (action.command)(state)
            && context.input_mut(|input| input.consume_shortcut(&shortcut))
        {
            commands.push(command);
        }
    }
    commands
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn no_two_actions_share_keys_or_a_name() {
        let mut names = HashSet::new();
        let mut shortcuts = HashSet::new();
        for action in all() {
            assert!(names.insert(action.label), "{} twice", action.label);
            assert!(action.hover.len() > 5, "{} says nothing", action.label);
            if let Some(keys) = action.shortcut {
                assert!(
                    shortcuts.insert(format!("{keys:?}")),
                    "{} shares its keys",
                    action.label
                );
            }
        }
    }
}
