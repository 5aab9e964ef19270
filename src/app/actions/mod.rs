//! Named actions: the menu's entry, the shortcut and the tooltip of each are this one entry.

/// Actions by their names: what one does is said once, for its tooltip and for its documentation.
macro_rules! actions {
    ($($name:ident {
        label: $label:literal,
        hover: $hover:literal,
        shortcut: $shortcut:expr,
        $(keypad: $keypad:expr,)?
        $(also: $also:expr,)?
        command: $command:expr,
    })*) => {$(
        #[doc = $hover]
        pub const $name: Action = Action {
            label: $label,
            hover: $hover,
            shortcut: $shortcut,
            keypad: actions!(@keypad $($keypad)?),
            also: actions!(@also $($also)?),
            command: $command,
        };
    )*};
    (@keypad) => { None };
    (@keypad $key:expr) => { Some($key) };
    (@also) => { None };
    (@also $keys:expr) => { $keys };
}

pub mod edit;
pub mod file;
pub mod help;
pub mod photo;
pub mod review;
pub mod survey;
pub mod turning;
pub mod view;

use egui::{Key, KeyboardShortcut, Modifiers};

use crate::command::{Asking, Command};
use crate::fragments::{FragmentStep, Fragments};
use crate::planning::Planning;
use crate::size_distributions::Page;
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
    /// Its digit on the numeric keypad, as in CloudCompare and Blender; egui does not tell it from the
    /// digits over the letters.
    pub keypad: Option<Key>,
    /// Its keys in other programs.
    pub also: Option<KeyboardShortcut>,
    /// What it sends; `None` where it makes no sense now, and the entry is grey.
    pub command: fn(&State) -> Option<Command>,
}

impl Action {
    /// Its keys as text, for menus and tooltips: "T or 7".
    pub fn keys_in_words(&self, context: &egui::Context) -> Option<String> {
        let shortcut = self.shortcut.map(|keys| context.format_shortcut(&keys));
        let keypad = self.keypad.map(|key| key.name().to_owned());
        match (shortcut, keypad) {
            (Some(shortcut), Some(keypad)) => Some(format!("{shortcut} or {keypad}")),
            (shortcut, keypad) => shortcut.or(keypad),
        }
    }

    fn all_keys(self) -> impl Iterator<Item = KeyboardShortcut> {
        let keypad = |key| KeyboardShortcut::new(Modifiers::NONE, key);
        let others = self.keypad.map(keypad).into_iter().chain(self.also);
        self.shortcut.into_iter().chain(others)
    }
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

/// What is done with the view of the surface: over the pile, or under the flight plan.
fn in_viewport(state: &State, command: Command) -> Option<Command> {
    let in_sight = matches!(state.page, Page::Pile | Page::Plan);
    in_sight.then(|| with_flight(state, command)).flatten()
}

/// The flight plan, while its page is shown.
fn on_plan(state: &State) -> Option<&Planning> {
    let open = state.open.as_ref().filter(|_| state.page == Page::Plan)?;
    Some(&open.planning)
}

/// What is done with a photo's fragments, while their page is shown.
fn on_fragments(
    state: &State,
    step: impl FnOnce(&Fragments) -> Option<FragmentStep>,
) -> Option<Option<Command>> {
    let open = state
        .open
        .as_ref()
        .filter(|_| state.page == Page::Fragments)?;
    Some(step(&open.fragments).map(Command::Fragments))
}

/// What is done with the table of photos beside it, or beside the map.
fn beside_photos(state: &State, command: Command) -> Option<Command> {
    let in_sight = matches!(state.page, Page::Pile | Page::Map | Page::Fragments);
    in_sight.then(|| with_flight(state, command)).flatten()
}

fn with_photo(state: &State, command: Command) -> Option<Command> {
    let open = state.open.as_ref().filter(|_| state.page == Page::Pile)?;
    open.selected.map(|_| command)
}

/// The menus, in their order. An empty place is a line between entries.
pub const MENUS: [(&str, &[Option<Action>]); 6] = [
    ("File", file::MENU),
    ("Edit", edit::MENU),
    ("View", view::MENU),
    ("Photo", photo::MENU),
    ("Review", review::MENU),
    ("Help", help::MENU),
];

/// All actions of the menus.
pub fn all() -> impl Iterator<Item = Action> {
    MENUS
        .into_iter()
        .flat_map(|(_, entries)| entries.iter().copied())
        .flatten()
}

/// What belongs to a button, a list or a slider that has the focus; other keys do not.
const IN_FOCUS: [Key; 13] = [
    Key::Enter,
    Key::Space,
    Key::Tab,
    Key::Escape,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
    Key::PageUp,
    Key::PageDown,
    Key::Home,
    Key::End,
    Key::Delete,
];

/// The keys that belong to the part of the window that has the focus; none where nothing has it.
pub(crate) fn keys_of_focus(context: &egui::Context) -> &'static [Key] {
    match context.memory(|memory| memory.focused().is_some()) {
        true => &IN_FOCUS,
        false => &[],
    }
}

/// Whether letters belong to a field that is typed into, or to an open menu.
pub(crate) fn keys_are_taken(context: &egui::Context) -> bool {
    context.text_edit_focused() || egui::Popup::is_any_open(context)
}

/// The commands of the shortcuts that were pressed in this frame. Keys without Ctrl belong to a text
/// field while one has the focus.
pub fn pressed(state: &State, context: &egui::Context) -> Vec<Command> {
    if state.held_back.is_some() {
        // A question waits for its answer first.
        return Vec::new();
    }
    let taken = keys_are_taken(context);
    let of_focus = keys_of_focus(context);
    // A text field has an undo of its own.
    let editing = context.text_edit_focused();
    let keys_of = |action: Action| action.all_keys().map(move |keys| (action, keys));
    let mut actions: Vec<(Action, KeyboardShortcut)> = all().flat_map(keys_of).collect();
    // Ctrl+Shift+Z before Ctrl+Z: egui takes the first that fits, and more modifiers fit less.
    actions.sort_by_key(|(_, keys)| std::cmp::Reverse(keys.modifiers.shift));
    let mut commands = Vec::new();
    for (action, shortcut) in actions {
        let undoes = [edit::UNDO.shortcut, edit::REDO.shortcut].contains(&action.shortcut);
        // An open menu is closed by it first.
        let closes = shortcut.logical_key == Key::Escape && egui::Popup::is_any_open(context);
        let belongs_elsewhere = taken || of_focus.contains(&shortcut.logical_key);
        // In a field it takes a word away, in many a program.
        let erases = editing && action.shortcut == file::CLOSE.shortcut;
        if closes
            || (belongs_elsewhere && !shortcut.modifiers.command)
            || (editing && undoes)
            || erases
        {
            continue;
        }
        let Some(command) = (action.command)(state) else {
            // Else redo, where there is nothing to do again, would be taken for undo.
            if undoes && shortcut.modifiers.shift {
                context.input_mut(|input| input.consume_shortcut(&shortcut));
            }
            continue;
        };
        if context.input_mut(|input| input.consume_shortcut(&shortcut)) {
            commands.push(command);
            // The letter of a key that brings the cursor into a field is no part of what is written there.
            context.input_mut(|input| {
                input
                    .events
                    .retain(|event| !matches!(event, egui::Event::Text(_)));
            });
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
            for keys in action.all_keys() {
                assert!(
                    shortcuts.insert(format!("{keys:?}")),
                    "{} shares its keys",
                    action.label
                );
            }
        }
    }
}
