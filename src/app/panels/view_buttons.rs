//! The buttons over the viewport: views, the look through a camera, the distance tool.

use crate::actions::{self, Action};
use crate::command::{Command, ViewChange};
use crate::open_flight::Measure;
use crate::open_flight::survey::SurveyTool;
use crate::photo_view::Middle;
use crate::size_distributions::Page;
use crate::state::State;

/// A viewport that is narrower, points, has signs in place of the longer words, so that the row does not fill it.
const NARROW: f32 = 640.0;

/// Draws the buttons.
pub fn view_buttons(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let is_narrow = ui.available_width() < NARROW;
    if is_narrow {
        // All in one row beside both panels at 1280 points.
        ui.spacing_mut().button_padding.x = 6.0;
        ui.spacing_mut().item_spacing.x = 4.0;
    }
    let text = |words: &'static str, sign: &'static str| match is_narrow {
        true => sign,
        false => words,
    };
    let mut button = |action: Action, text: &str, on: bool, ui: &mut egui::Ui| {
        let command = (action.command)(state);
        let button = ui.add_enabled(command.is_some(), egui::Button::selectable(on, text));
        button.widget_info(|| {
            egui::WidgetInfo::selected(egui::Role::Button, command.is_some(), on, action.label)
        });
        let keys = action.keys_in_words(ui.ctx());
        let hover = match keys {
            Some(keys) => format!("{} ({keys})", action.hover),
            None => action.hover.to_owned(),
        };
        if button.on_hover_text(hover).clicked() {
            commands.extend(command);
        }
    };
    let is_plan = state.page == Page::Plan;
    let through = match is_plan {
        true => open.planning.through,
        false => open.looking.through.is_some(),
    };
    button(actions::view::FIT, "Fit", false, ui);
    // Only where it shows something else.
    if open.extent.bulk != open.extent.surface {
        button(actions::view::FIT_ALL, "Fit all", false, ui);
    }
    button(actions::view::TOP, "Top", false, ui);
    button(actions::view::FRONT, "Front", false, ui);
    button(actions::view::SIDE, "Side", false, ui);
    button(
        actions::view::THROUGH,
        text("Through camera", "📷"),
        through,
        ui,
    );
    if is_plan {
        return;
    }
    let middle = state.middle;
    let photo = actions::view::PHOTO_ALONE;
    button(photo, text("Photo", "🖼"), middle == Middle::Photo, ui);
    let both = actions::view::PHOTO_BESIDE;
    button(both, text("Photo beside", "🗗"), middle == Middle::Both, ui);
    button(
        actions::photo::MEASURE,
        text("Measure", "📏"),
        open.pointer.measure != Measure::Off,
        ui,
    );
    let points = open.pointer.picked.is_on;
    button(actions::survey::POINTS, text("Points", "📍"), points, ui);
    let drawn = open.pointer.drawn.as_ref().map(|drawn| drawn.tool);
    let profile = drawn == Some(SurveyTool::Profile);
    button(actions::survey::PROFILE, text("Profile", "📈"), profile, ui);
    let volume = drawn == Some(SurveyTool::Volume);
    button(actions::survey::VOLUME, text("Volume", "🗻"), volume, ui);
    let clip = open.clip.is_on || open.clip.is_open;
    button(actions::survey::CLIP, text("Clip", "✂"), clip, ui);
}

/// How much of the photo lies over a look through its camera.
pub fn blend_slider(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let mut blend = open.looking.blend;
    ui.horizontal(|ui| {
        ui.label("Surface");
        ui.spacing_mut().slider_width = 120.0;
        let slider = ui.add(egui::Slider::new(&mut blend, 0.0..=1.0).show_value(false));
        slider.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Slider, true, "Photo over the view")
        });
        if slider
            .on_hover_text("How much of the photo lies over the view")
            .changed()
        {
            commands.push(Command::View(ViewChange::Blend(blend)));
        }
        ui.label("photo");
    });
}
