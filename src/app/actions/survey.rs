//! What is drawn on the surface to measure there.

use egui::{Key, Modifiers};

use super::{Action, keys, on_pile};
use crate::command::Command;
use crate::open_flight::survey::clip::ClipStep;
use crate::open_flight::survey::picked::PickStep;
use crate::open_flight::survey::{SurveyStep, SurveyTool};

actions! {
    PROFILE {
        label: "Profile along a line",
        hover: "Draw a line on the surface: its profile, crest, toe and angle of repose",
        shortcut: keys(Modifiers::NONE, Key::L),
        command: |state| on_pile(state, Command::Survey(SurveyStep::Toggle(SurveyTool::Profile))),
    }
    POINTS {
        label: "Pick points",
        hover: "Click points on the surface: a list with their coordinates to copy and save",
        shortcut: keys(Modifiers::NONE, Key::K),
        command: |state| on_pile(state, Command::Pick(PickStep::Toggle)),
    }
    CLIP {
        label: "Clipping box",
        hover: "Show only what lies in a box: its limits, its turn, or the footprint of the selected photo. \
                Scales never depend on it",
        shortcut: keys(Modifiers::NONE, Key::X),
        command: |state| on_pile(state, Command::Clip(ClipStep::Toggle)),
    }
    VOLUME {
        label: "Volume inside a polygon",
        hover: "Draw a polygon on the surface: area and volume over its rim or a level",
        shortcut: keys(Modifiers::NONE, Key::V),
        command: |state| on_pile(state, Command::Survey(SurveyStep::Toggle(SurveyTool::Volume))),
    }
}
