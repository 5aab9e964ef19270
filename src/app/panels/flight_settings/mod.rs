//! The flight's settings; each change is computed at once and can be undone.

mod files_of_flight;
mod stated_errors;

use crate::command::Command;
use crate::flight::FlightSettings;
use crate::names;
use crate::panels::field::{combo_box, number_field};
use crate::scale::{Ground, ImageKind, ScalePair};
use crate::state::State;
use crate::surface::UpAxis;
use crate::units::LengthUnit;
use files_of_flight::files_of_flight;
use stated_errors::stated_errors;

/// Draws the page.
pub(super) fn flight_settings(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let now = open.settings();
    let mut changes = Vec::new();
    let mut set = |settings: FlightSettings| changes.push(Command::Set(settings));
    let parts = open.flight().parts();
    let heading = egui::TextStyle::Heading;
    names::styled(ui, &parts.name, heading, egui::RichText::strong);
    ui.weak(format!(
        "{} photos, {} points",
        parts.photos.len(),
        parts.surface.vertices().len()
    ));
    ui.weak(format!(
        "Coordinate system: {}",
        open.files
            .crs
            .as_deref()
            .map_or("not stated", |crs| crs.get(..60).unwrap_or(crs))
    ));
    files_of_flight(open, ui);
    ui.horizontal_wrapped(|ui| {
        let changed = open.is_changed();
        let save = ui.add_enabled(changed, egui::Button::new("Save settings"));
        let target = open.files.origin.suggested_file();
        let hover = format!("Write them into {}", target.display());
        if save.on_hover_text(hover).clicked() {
            commands.push(Command::Save);
        }
        if changed {
            ui.weak("not saved yet");
        }
    });
    ui.add_space(8.0);

    ui.strong("Unit of the world's coordinates");
    let unit_now = match now.unit_known {
        true => now.unit.symbol(),
        false => "not known",
    };
    let list = egui::ComboBox::from_id_salt("world unit")
        .selected_text(unit_now)
        .show_ui(ui, |ui| {
            for unit in LengthUnit::ALL {
                if ui
                    .selectable_label(now.unit_known && now.unit == unit, unit.symbol())
                    .clicked()
                {
                    set(FlightSettings {
                        unit,
                        unit_known: true,
                        ..now.clone()
                    });
                }
            }
        })
        .response
        .on_hover_text("Of the cloud and the poses, as your package wrote them");
    combo_box(&list, "Unit of the world's coordinates", unit_now);
    ui.add_space(8.0);

    ui.strong("Ground");
    ui.label("Where a corner's ray misses the surface, it is taken on this level plane.");
    let auto = matches!(now.ground, Ground::Auto);
    if ui
        .radio(auto, "Median elevation under each photo")
        .on_hover_text("The median of the surface's vertices that the photo sees")
        .clicked()
        && !auto
    {
        set(FlightSettings {
            ground: Ground::Auto,
            ..now.clone()
        });
    }
    let z = match now.ground {
        Ground::At(z) => z,
        // To the millimetre: a start to correct, not a measurement.
        Ground::Auto => (open.ground() * 1000.0).round() / 1000.0,
    };
    ui.horizontal_wrapped(|ui| {
        if ui.radio(!auto, "Elevation").clicked() && auto {
            set(FlightSettings {
                ground: Ground::At(z),
                ..now.clone()
            });
        }
        ui.add_enabled_ui(!auto, |ui| {
            let hover = "Elevation of the ground in the world's unit";
            if let Some(z) = number_field(ui, "Ground elevation", hover, z, now.unit_of_lengths()) {
                set(FlightSettings {
                    ground: Ground::At(z),
                    ..now.clone()
                });
            }
        });
    });
    ui.add_space(8.0);

    ui.strong("Scales are for");
    for (image, name, hover) in [
        (
            ImageKind::Undistorted,
            "the undistorted photo",
            "Analyse the undistorted photos of the export in Split-Desktop",
        ),
        (
            ImageKind::AsShot,
            "the photo as shot",
            "Analyse the photos as they came from the camera",
        ),
    ] {
        let chosen = now.image == image;
        if ui.radio(chosen, name).on_hover_text(hover).clicked() && !chosen {
            set(FlightSettings {
                image,
                ..now.clone()
            });
        }
    }
    ui.add_space(8.0);

    ui.strong("Scale for Split-Desktop");
    for (pair, name, hover) in [
        (
            ScalePair::Fitted,
            "best line",
            "The line from top to bottom that lies best through the scale of all pixels",
        ),
        (
            ScalePair::Corners,
            "four corners",
            "As in the paper: the distances between the points that the corners' rays meet",
        ),
    ] {
        let chosen = now.pair == pair;
        if ui.radio(chosen, name).on_hover_text(hover).clicked() && !chosen {
            set(FlightSettings {
                pair,
                ..now.clone()
            });
        }
    }
    ui.add_space(8.0);
    ui.strong("Surface");
    if open.files.origin.surface().is_some() {
        up_axis(&now, ui, &mut set);
    }
    let mut surface = now.surface;
    let mut changed = false;
    let size = open.extent.surface.size().truncate().max_element();
    // One and two significant digits: something to begin with.
    let round = |length: f64| {
        let power = 10_f64.powf(length.max(1e-9).log10().floor());
        (length / power).round() * power
    };
    for (value, name, label, hover, start) in [
        (
            &mut surface.max_edge,
            "Leave out long triangles, edges over",
            "Longest triangle edge",
            "Triangles with a longer edge bridge holes in the cloud: rays pass through them",
            round(size / 20.0),
        ),
        (
            &mut surface.thinning,
            "Thin the cloud, one point in each",
            "Thinning cell",
            "One point stays in each square cell of this size; by default none is dropped",
            round(size / 500.0),
        ),
    ] {
        ui.horizontal_wrapped(|ui| {
            let mut on = value.is_some();
            if ui.checkbox(&mut on, name).on_hover_text(hover).changed() {
                *value = on.then_some(start);
                changed = true;
            }
            if let Some(length) = *value
                && let Some(typed) = number_field(ui, label, hover, length, now.unit_of_lengths())
                && typed > 0.0
            {
                *value = Some(typed);
                changed = true;
            }
        });
    }
    if changed {
        set(FlightSettings {
            surface,
            ..now.clone()
        });
    }
    commands.append(&mut changes);
    ui.add_space(8.0);
    stated_errors(state, &now, ui, commands);
}

/// Which axis of the surface's file points up.
fn up_axis(now: &FlightSettings, ui: &mut egui::Ui, set: &mut impl FnMut(FlightSettings)) {
    ui.horizontal(|ui| {
        ui.label("Up in its file:");
        for axis in [UpAxis::X, UpAxis::Y, UpAxis::Z] {
            let chosen = now.surface_up == axis;
            let button = ui.radio(chosen, axis.name());
            button.widget_info(|| {
                let label = format!("{} is up in the surface's file", axis.name());
                egui::WidgetInfo::selected(egui::Role::RadioButton, true, chosen, label)
            });
            let hover = "Which axis of the surface's file points up: the file is read again";
            if button.on_hover_text(hover).clicked() && !chosen {
                set(FlightSettings {
                    surface_up: axis,
                    ..now.clone()
                });
            }
        }
    });
}
