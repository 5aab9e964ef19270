//! Keys, and what this program is.

use egui::{Key, Modifiers};

use super::{Action, keys};
use crate::command::{Asking, Command};

actions! {
    KEYS {
        label: "Keys and mouse",
        hover: "Which keys do what",
        shortcut: keys(Modifiers::NONE, Key::F1),
        command: |_| Some(Command::Ask(Some(Asking::Keys))),
    }
    ABOUT {
        label: "About fragscale",
        hover: "What this program is",
        shortcut: None,
        command: |_| Some(Command::Ask(Some(Asking::About))),
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[Some(KEYS), Some(ABOUT)];
