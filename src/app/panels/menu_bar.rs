//! The menu: every action, by its name.

use std::path::Path;

use crate::actions::file::OPEN_SAMPLE;
use crate::actions::{Action, MENUS, turning};
use crate::command::Command;
use crate::names;
use crate::panels::Scrolled;
use crate::state::State;
use crate::state::preferences::Theme;

/// Draws the menu bar.
pub fn menu_bar(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    egui::MenuBar::new().ui(ui, |ui| {
        for (name, entries) in MENUS {
            let menu = ui.menu_button(name, |ui| {
                // In a low window, or at 200 %, the last entries would lie below its edge. A bar that is always seen:
                // nothing else says that there is more.
                ui.spacing_mut().scroll = egui::style::ScrollStyle::solid();
                let below_bar = ui.ctx().content_rect().bottom() - ui.min_rect().top();
                ui.set_max_height(below_bar - LOWER_EDGE);
                ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
                egui::ScrollArea::vertical()
                    .max_height(below_bar - LOWER_EDGE)
                    .show_focused(ui, |ui| entries_of(state, name, entries, ui, commands));
            });
            // As everywhere: the first menu, from which arrows lead to the others.
            if name == MENUS[0].0 && ui.input(|input| input.key_pressed(egui::Key::F10)) {
                menu.response.request_focus();
            }
        }
    });
}

/// Left between a long menu and the window's lower edge, points.
const LOWER_EDGE: f32 = 12.0;

fn entries_of(
    state: &State,
    name: &str,
    entries: &[Option<Action>],
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    for entry in entries {
        match entry {
            None => {
                ui.separator();
            }
            Some(action) if is_turning(action) => {
                // All of them where the first one stands.
                if action.label == turning::OPPOSITE.label {
                    turning_menu(state, ui, commands);
                }
            }
            Some(action) => entry_of(state, *action, ui, commands),
        }
        if entry.is_some_and(|action| action.label == OPEN_SAMPLE.label) {
            recent(state, ui, commands);
        }
    }
    if name == "View" {
        ui.separator();
        appearance(state, ui, commands);
    }
}

fn is_turning(action: &Action) -> bool {
    let mut turning = turning::MENU.iter();
    turning.any(|other| other.label == action.label)
}

/// What the keypad does, too: keys that few look for in a menu, in a menu that is long without them.
fn turning_menu(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.menu_button("Turn", |ui| {
        ui.style_mut().wrap_mode = Some(egui::TextWrapMode::Extend);
        for action in turning::MENU {
            entry_of(state, action, ui, commands);
        }
    });
}

fn entry_of(state: &State, action: Action, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let command = (action.command)(state);
    let mut button = egui::Button::new(action.label);
    if let Some(keys) = action.keys_in_words(ui.ctx()) {
        button = button.shortcut_text(keys);
    }
    let entry = ui.add_enabled(command.is_some(), button);
    if entry.on_hover_text(action.hover).clicked() {
        commands.extend(command);
        ui.close();
    }
}

/// The width of a recent flight's name, points.
pub(super) const RECENT_WIDTH: f32 = 400.0;

fn recent(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let recent = &state.preferences.recent;
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Recent flights", |ui| {
            for path in recent {
                let font = egui::TextStyle::Button.resolve(ui.style());
                let path_shown = short(path);
                let button = ui.button(&*names::fitted(ui, &path_shown, &font, RECENT_WIDTH));
                if button.on_hover_text(path.display().to_string()).clicked() {
                    commands.push(Command::Open(path.clone()));
                    ui.close();
                }
            }
        });
    });
}

/// The last two parts of a path: enough to tell flights apart.
pub(super) fn short(path: &Path) -> String {
    let parts: Vec<_> = path.components().rev().take(2).collect();
    let parts: Vec<_> = parts
        .into_iter()
        .rev()
        .map(|part| part.as_os_str().to_string_lossy())
        .collect();
    parts.join("/")
}

fn appearance(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.menu_button("Theme", |ui| {
        for (theme, name) in [
            (Theme::System, "As the system"),
            (Theme::Light, "Light"),
            (Theme::Dark, "Dark"),
        ] {
            if ui
                .radio(state.preferences.theme == theme, name)
                .on_hover_text("Colours of the window")
                .clicked()
            {
                commands.push(Command::Theme(theme));
            }
        }
    });
    ui.menu_button("Size", |ui| {
        for percent in [100_u8, 125, 150, 175, 200] {
            let factor = f32::from(percent) / 100.0;
            let now = (ui.ctx().zoom_factor() - factor).abs() < 0.01;
            if ui
                .radio(now, format!("{percent} %"))
                .on_hover_text("Size of everything in the window")
                .clicked()
            {
                commands.push(Command::Zoom(factor));
            }
        }
    });
}
