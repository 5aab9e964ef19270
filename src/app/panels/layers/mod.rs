//! What the viewport shows, in one small panel.

mod beside;
mod color_range;

use super::field::combo_box;
use crate::command::Command;
use crate::render::{ColorBy, Scope};
use crate::state::State;
use crate::state::layers::Layers;

/// Draws the switches.
pub fn layers_panel(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let now = state.preferences.layers;
    let mut next = now;
    ui.horizontal(|ui| {
        ui.checkbox(&mut next.mesh, "Surface")
            .on_hover_text("The triangles that rays meet");
        ui.checkbox(&mut next.wireframe, "Edges")
            .on_hover_text("The triangles' edges");
    });
    ui.horizontal(|ui| {
        ui.checkbox(&mut next.cloud, "Points")
            .on_hover_text("The cloud");
        ui.add_enabled_ui(next.cloud, |ui| {
            let slider = egui::Slider::new(&mut next.point_size, 0.25..=4.0).show_value(false);
            ui.spacing_mut().slider_width = 70.0;
            let slider = ui.add(slider);
            slider.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Slider, true, "Size of points")
            });
            slider.on_hover_text("Size of points");
        });
    });
    let list = egui::ComboBox::from_id_salt("colour by")
        .selected_text(color_name(next.color_by))
        .width(150.0)
        .show_ui(ui, |ui| {
            for by in [
                ColorBy::Rgb,
                ColorBy::Elevation,
                ColorBy::Slope,
                ColorBy::Scale,
            ] {
                ui.selectable_value(&mut next.color_by, by, color_name(by));
            }
        })
        .response
        .on_hover_text("What the colours of surface and points mean");
    combo_box(&list, "Colour by", color_name(now.color_by));
    color_range::color_range(state, ui, commands);
    ui.checkbox(&mut next.eye_dome, "Relief shading")
        .on_hover_text("Eye-dome lighting: edges in depth are darkened");
    ui.checkbox(&mut next.project_photo, "Photo on the surface")
        .on_hover_text("The selected photo projected onto the surface that it sees");
    ui.separator();
    egui::Grid::new("scopes").num_columns(2).show(ui, |ui| {
        for (scope, name, hover) in [
            (&mut next.frusta, "Cameras", "Where the photos were taken"),
            (
                &mut next.images,
                "Photos",
                "The photos on the cameras' image planes",
            ),
            (
                &mut next.corner_rays,
                "Corner rays",
                "From the camera through the image corners to the surface",
            ),
            (
                &mut next.outlines,
                "Outlines",
                "The image outlines on the surface",
            ),
            (
                &mut next.fills,
                "Footprints",
                "The image areas on the surface",
            ),
        ] {
            ui.label(name).on_hover_text(hover);
            ui.horizontal(|ui| {
                for (value, word) in [
                    (Scope::None, "none"),
                    (Scope::Selected, "one"),
                    (Scope::All, "all"),
                ] {
                    let chosen = *scope == value;
                    let button = ui.selectable_label(chosen, word);
                    button.widget_info(|| {
                        let label = format!("{name}: {word}");
                        egui::WidgetInfo::selected(egui::Role::RadioButton, true, chosen, label)
                    });
                    if button.on_hover_text(hover).clicked() {
                        *scope = value;
                    }
                }
            });
            ui.end_row();
        }
    });
    ui.separator();
    ui.checkbox(&mut next.flight_line, "Flight line")
        .on_hover_text("Through the camera centres in the photos' order");
    ui.checkbox(&mut next.ground, "Ground")
        .on_hover_text("The plane that rays fall back to");
    ui.horizontal(|ui| {
        ui.checkbox(&mut next.axes, "Axes")
            .on_hover_text("Directions of x, y (north) and z");
        ui.checkbox(&mut next.scale_bar, "Scale bar")
            .on_hover_text("A bar of known length");
    });
    ui.checkbox(&mut next.orthographic, "Parallel view")
        .on_hover_text("Without perspective: the scale bar is true everywhere (5)");
    ui.horizontal(|ui| {
        if ui
            .button("Corner-ray figure")
            .on_hover_text("The layers of the paper's figure: all cameras, rays and outlines")
            .clicked()
        {
            next = now.corner_ray_figure();
        }
        if ui
            .button("Usual layers")
            .on_hover_text("Back to what fragscale comes with")
            .clicked()
        {
            next = Layers::default();
        }
    });
    ui.separator();
    beside::beside(state, ui, commands);
    if next != now {
        commands.push(Command::Layers(next));
    }
}

fn color_name(by: ColorBy) -> &'static str {
    match by {
        ColorBy::Rgb => "Colours as read",
        ColorBy::Elevation => "Elevation",
        ColorBy::Slope => "Slope",
        ColorBy::Scale => "Scale of the photo",
    }
}
