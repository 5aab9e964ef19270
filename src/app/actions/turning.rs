//! Turning the view with the keys of the numeric keypad, as CloudCompare and Blender have them; the
//! standard views themselves are in `view`.

use egui::Key;

use super::{Action, in_viewport};
use crate::command::{Command, ViewChange};
use crate::state::State;
use crate::state::layers::Layers;

/// How far one step turns, degrees.
const STEP: f64 = 15.0;

/// The entries of the menu, below one of their own: with them that of the views is higher than many a window.
pub const MENU: [Action; 6] = [OPPOSITE, PARALLEL, LEFT, RIGHT, UP, DOWN];

fn turn(state: &State, left: f64, up: f64) -> Option<Command> {
    in_viewport(state, Command::View(ViewChange::Turn { left, up }))
}

actions! {
    OPPOSITE {
        label: "From the opposite side",
        hover: "Look from the other side: from below after from above, from the north after from the south",
        shortcut: None,
        keypad: Key::Num9,
        command: |state| in_viewport(state, Command::View(ViewChange::Opposite)),
    }
    PARALLEL {
        label: "Parallel or perspective",
        hover: "Parallel lines of sight, where the scale bar is true everywhere, or perspective again",
        shortcut: None,
        keypad: Key::Num5,
        command: |state| {
            let layers = state.preferences.layers;
            let orthographic = !layers.orthographic;
            in_viewport(state, Command::Layers(Layers { orthographic, ..layers }))
        },
    }
    LEFT {
        label: "Turn to the left",
        hover: "Go 15 degrees to the left around what is in the middle",
        shortcut: None,
        keypad: Key::Num4,
        command: |state| turn(state, STEP, 0.0),
    }
    RIGHT {
        label: "Turn to the right",
        hover: "Go 15 degrees to the right around what is in the middle",
        shortcut: None,
        keypad: Key::Num6,
        command: |state| turn(state, -STEP, 0.0),
    }
    UP {
        label: "Turn up",
        hover: "Go 15 degrees up around what is in the middle, to straight above",
        shortcut: None,
        keypad: Key::Num8,
        command: |state| turn(state, 0.0, STEP),
    }
    DOWN {
        label: "Turn down",
        hover: "Go 15 degrees down around what is in the middle, to straight below",
        shortcut: None,
        keypad: Key::Num2,
        command: |state| turn(state, 0.0, -STEP),
    }
}
