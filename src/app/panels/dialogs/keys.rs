//! Which keys do what: those of the menus, and the others.

use crate::actions;
use crate::panels::accessible::scrolled_by_keys;
use crate::panels::fragments::tool_keys;

pub(super) fn keys(ui: &mut egui::Ui) {
    // The list is longer than a small screen is high.
    let most = (ui.ctx().content_rect().height() - 90.0).max(100.0);
    let area = egui::ScrollArea::vertical();
    let area = area.max_height(most).min_scrolled_height(most);
    scrolled_by_keys("List of keys", area, ui, list_of_keys);
}

/// Keys that are no menu's.
const OTHER_KEYS: [(&str, &str); 6] = [
    ("Go to the menus", "F10"),
    ("Larger, smaller, 100 %", "Ctrl++, Ctrl+-, Ctrl+0"),
    ("Go to the next button or field, or back", "Tab, Shift+Tab"),
    ("Leave it: arrows and space are the photos' again", "Escape"),
    ("Press a button, open a list", "Space or Enter"),
    (
        "Delete or accept while a fragment is selected",
        "Delete, Enter",
    ),
];

fn list_of_keys(ui: &mut egui::Ui) {
    // Long words go on below, where the window is narrow.
    let column = (ui.available_width() / 2.0 - 12.0).max(60.0);
    let said = |text: String, ui: &mut egui::Ui| {
        ui.add(egui::Label::new(text).wrap());
    };
    egui::Grid::new("keys")
        .striped(true)
        .num_columns(2)
        .min_col_width(column)
        .max_col_width(column)
        .show(ui, |ui| {
            for (what, how) in [
                ("Turn the view", "drag with the left button"),
                (
                    "Move the view",
                    "drag with the right or middle button, or Shift and left",
                ),
                ("Come closer to the cursor", "wheel, or pinch"),
                ("Turn around a place", "double click on it"),
                ("Select a photo", "click its camera or its footprint"),
            ] {
                said(what.to_owned(), ui);
                said(how.to_owned(), ui);
                ui.end_row();
            }
            for action in actions::all() {
                if let Some(keys) = action.keys_in_words(ui.ctx()) {
                    said(action.label.trim_end_matches('…').to_owned(), ui);
                    said(keys, ui);
                    ui.end_row();
                }
            }
            for (what, keys) in OTHER_KEYS {
                said(what.to_owned(), ui);
                said(keys.to_owned(), ui);
                ui.end_row();
            }
            for (tool, keys) in tool_keys(ui.ctx()) {
                said(format!("Fragments: {tool}"), ui);
                said(keys, ui);
                ui.end_row();
            }
        });
}
