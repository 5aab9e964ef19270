//! The engine, and what the mouse does.

use egui::{Button, Key, Modifiers, Role, Ui, WidgetInfo};

use crate::actions::keys_are_taken;
use crate::command::{Asking, Command};
use crate::fragments::{FragmentStep, FragmentTool};
use crate::open_flight::OpenFlight;
use crate::panels::field::combo_box;
use crate::state::State;
use crate::tasks::Task;

/// A tool with its name, key and what it does.
type Tool = (FragmentTool, &'static str, Modifiers, Key, &'static str);

/// All tools, in the order of their buttons.
const TOOLS: [Tool; 9] = [
    (
        FragmentTool::Select,
        "Select",
        Modifiers::NONE,
        Key::V,
        "Click a fragment to see its measures; drag to move the photo",
    ),
    (
        FragmentTool::Split,
        "Split",
        Modifiers::NONE,
        Key::S,
        "Draw a stroke across a fragment: it becomes two",
    ),
    (
        FragmentTool::Merge,
        "Merge",
        Modifiers::NONE,
        Key::M,
        "Draw a stroke over fragments: they become one",
    ),
    (
        FragmentTool::Grow,
        "Grow",
        Modifiers::NONE,
        Key::G,
        "Click where no fragment is: the likeliest region there becomes one",
    ),
    (
        FragmentTool::Outline,
        "Outline",
        Modifiers::NONE,
        Key::O,
        "Draw about a new fragment, or click its corners and press Enter",
    ),
    (
        FragmentTool::Redraw,
        "Redraw",
        Modifiers::NONE,
        Key::R,
        "Draw another outline of the selected fragment",
    ),
    (
        FragmentTool::Brush,
        "Fines",
        Modifiers::NONE,
        Key::B,
        "Brush over what is fines and not a fragment",
    ),
    (
        FragmentTool::Exclude,
        "Exclude",
        Modifiers::NONE,
        Key::X,
        "Draw about what is no rock: sky, ground, machines",
    ),
    (
        FragmentTool::Include,
        "Include",
        Modifiers::SHIFT,
        Key::X,
        "Draw about what was excluded and may be rock again",
    ),
];

/// Draws engine and tools.
pub(super) fn tools(
    state: &State,
    open: &OpenFlight,
    photo: usize,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let fragments = &open.fragments;
    let mut asked = None;
    let mut send = |step| commands.push(Command::Fragments(step));
    ui.horizontal_wrapped(|ui| {
        let network = &state.network;
        let before = network.known(fragments.engine);
        let mut engine = before;
        let chosen = network.name(engine);
        let hover = "What finds the borders: the learned engine is the better one, the classical one is faster; or a network of yours";
        let combo = egui::ComboBox::from_id_salt("engine")
            .selected_text(chosen)
            .width(80.0)
            .show_ui(ui, |ui| {
                for choice in network.choices() {
                    ui.selectable_value(&mut engine, choice, network.name(choice));
                }
                if ui.selectable_label(false, "Your network…").clicked() {
                    asked = Some(Asking::Network);
                }
            });
        combo_box(&combo.response.on_hover_text(hover), "Engine", chosen);
        if engine != before {
            send(FragmentStep::Engine(engine));
        }
        let runs = state.work.is_running(Task::OUTLINE);
        let text = match fragments.of(photo) {
            _ if runs => "Outlining…",
            None => "Outline this photo",
            Some(_) => "Outline anew",
        };
        let button = ui.add_enabled(!runs, Button::new(text));
        let hover = "Find the fragments of this photo; what is outlined now comes back by undo";
        if button.on_hover_text(hover).clicked() {
            send(FragmentStep::Outline);
        }
        let count = open.flight().parts().photos.len();
        if count > 1 {
            let waiting = fragments.waiting();
            let text = match (runs, waiting) {
                (true, 1..) => format!("{waiting} more"),
                _ => "Outline all".to_owned(),
            };
            let button = ui.add_enabled(!runs, Button::new(text));
            let hover = "Outline every photo that is not outlined yet, one after the other; the log says how far it is, and the \
                         status bar cancels it";
            if button.on_hover_text(hover).clicked() {
                send(FragmentStep::OutlineAll);
            }
        }
        let reads = state.work.is_running(Task::READ_MASKS);
        let button = ui.add_enabled(!reads, Button::new("Outlines of another tool…"));
        let hover = "Take this photo's outlines from a label image (PNG, TIFF), COCO, LabelMe, CVAT or GeoJSON in pixels; such a \
                     file can also be dropped here. Undo brings back what is outlined now";
        if button.on_hover_text(hover).clicked() {
            asked = Some(Asking::Masks);
        }
    });
    ui.horizontal_wrapped(|ui| {
        for (tool, name, modifiers, key, hover) in TOOLS {
            let on = fragments.tool == tool;
            let button = ui.add(Button::selectable(on, name));
            button.widget_info(|| WidgetInfo::selected(Role::RadioButton, true, on, name));
            let keys = egui::KeyboardShortcut::new(modifiers, key);
            let keys = ui.ctx().format_shortcut(&keys);
            if button.on_hover_text(format!("{hover} ({keys})")).clicked() {
                send(FragmentStep::Tool(tool));
            }
        }
    });
    if fragments.tool == FragmentTool::Brush {
        let before = fragments.brush_radius();
        let mut radius = before;
        let slider = egui::Slider::new(&mut radius, 1.0..=200.0)
            .logarithmic(true)
            .suffix(" px");
        let slider = ui.add(slider.text("brush"));
        slider.widget_info(|| WidgetInfo::slider(true, radius, "Brush radius"));
        if radius != before {
            send(FragmentStep::Brush(radius));
        }
    }
    if asked.is_some() {
        commands.push(Command::Ask(asked));
    }
    if let Some(fault) = &fragments.refused {
        ui.colored_label(ui.visuals().warn_fg_color, fault.to_string());
    }
}

/// Every tool with its key, in words.
pub(in crate::panels) fn tool_keys(context: &egui::Context) -> [(&'static str, String); 9] {
    TOOLS.map(|(_, name, modifiers, key, _)| {
        let keys = egui::KeyboardShortcut::new(modifiers, key);
        (name, context.format_shortcut(&keys))
    })
}

/// The tools' keys.
pub(super) fn keys(ui: &Ui, commands: &mut Vec<Command>) {
    if keys_are_taken(ui.ctx()) {
        return;
    }
    if ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::Delete)) {
        commands.push(Command::Fragments(FragmentStep::NoRock));
    }
    // With Shift first: egui takes the first that fits.
    for (tool, _, modifiers, key, _) in TOOLS.into_iter().rev() {
        if ui.input_mut(|input| input.consume_key(modifiers, key)) {
            commands.push(Command::Fragments(FragmentStep::Tool(tool)));
        }
    }
}
