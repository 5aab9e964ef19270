//! The page of the fragments: tools and numbers at the right, outlines and strokes on the photo.
//!
//! ```text
//! tools      the engine, and what the mouse does
//! found      the fragment that is looked at, the doubtful ones, what all of the photo come to
//! all_photos what those of all photos come to
//! on_photo   strokes and clicks on the photo, and what lies over it
//! picture    the outlines as pixels of the screen
//! ```

mod all_photos;
mod found;
mod on_photo;
mod picture;
mod tools;

pub(super) use tools::tool_keys;

pub(in crate::panels) use on_photo::OnPhoto;

use egui::Ui;

use crate::command::Command;
use crate::panels::Scrolled;
use crate::state::State;

/// Draws the panel at the right.
pub fn fragments(state: &State, ui: &mut Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let Some(photo) = open.selected else {
        ui.weak("Select a photo in the table.");
        return;
    };
    tools::tools(state, open, photo, ui, commands);
    ui.separator();
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .show_focused(ui, |ui| {
            found::found(state, open, photo, ui, commands);
            if open.fragments.is_any() {
                all_photos::of_all_photos(state, open, ui, commands);
            }
        });
}
