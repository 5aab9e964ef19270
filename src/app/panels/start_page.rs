//! The first page: the sample flight, recent flights, and what can be opened.

use super::menu_bar::{RECENT_WIDTH, short};
use crate::actions;
use crate::command::{Asking, Command};
use crate::from_photos::FromPhotosStep;
use crate::names;
use crate::panels::Scrolled;
use crate::panels::working::working;
use crate::size_distributions::Page;
use crate::state::State;

/// Draws the start page.
pub fn start_page(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    egui::ScrollArea::vertical().show_focused(ui, |ui| {
        ui.vertical_centered(|ui| {
            ui.add_space((ui.available_height() * 0.08).min(60.0));
            ui.heading(egui::RichText::new("fragscale").size(34.0));
            ui.label("Image scales for blast fragmentation photos, from the flight itself");
            ui.add_space(18.0);
            let big = |text: &str| {
                egui::Button::new(egui::RichText::new(text).size(16.0))
                    .min_size(egui::vec2(260.0, 36.0))
            };
            let sample = ui.add(big(actions::file::OPEN_SAMPLE.label));
            if sample
                .on_hover_text(actions::file::OPEN_SAMPLE.hover)
                .clicked()
            {
                commands.push(Command::OpenSample);
            }
            ui.add_space(4.0);
            let open = ui.add(big("Open…"));
            open.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, true, "Open a flight")
            });
            if open.on_hover_text(actions::file::OPEN.hover).clicked() {
                commands.push(Command::Ask(Some(Asking::Open)));
            }
            ui.add_space(4.0);
            let new = ui.add(big(actions::file::FROM_PHOTOS.label));
            new.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, true, "New flight from photos")
            });
            let new = new.on_hover_text(actions::file::FROM_PHOTOS.hover);
            if new.clicked() {
                commands.push(Command::FromPhotos(FromPhotosStep::Ask(None)));
            }
            ui.add_space(4.0);
            let sizes = ui.add(big("Size distributions"));
            let sizes = sizes.on_hover_text(actions::view::SIZE_DISTRIBUTIONS.hover);
            if sizes.clicked() {
                commands.push(Command::Page(Page::SizeDistributions));
            }
            ui.add_space(14.0);
            ui.weak(
                "or drop it on this window, with its cloud and photos where they lie elsewhere:",
            );
            ui.weak(
                "flight.toml · Metashape · Pix4D · RealityCapture · ContextCapture · OpenDroneMap",
            );
            ui.weak("COLMAP · VisualSFM · Bundler · Meshroom · ROS · a folder of drone photos");
            ui.weak("or tables of size distributions (CSV)");
            if state.is_opening() {
                ui.add_space(14.0);
                working(ui);
            }
            ui.add_space(18.0);
            if !state.preferences.recent.is_empty() {
                ui.strong("Recent flights");
                for path in &state.preferences.recent {
                    let font = egui::TextStyle::Body.resolve(ui.style());
                    let width = RECENT_WIDTH.min(ui.available_width());
                    let name = short(path);
                    let link = ui.link(&*names::fitted(ui, &name, &font, width));
                    if link.on_hover_text(path.display().to_string()).clicked() {
                        commands.push(Command::Open(path.clone()));
                    }
                }
            }
        });
    });
}
