//! The points: names, surveyed places, how well their marks agree; of the chosen one its marks, and the photos that
//! should show it.

use egui::RichText;
use glam::DVec3;

use super::{adding, crs_row, residual};
use crate::command::Command;
use crate::control::{ControlPoint, POOR_PX};
use crate::control_points::ControlStep;
use crate::files::last_segment;
use crate::names::unbroken;
use crate::open_flight::OpenFlight;
use crate::panels::field::{field_of, text_field};

/// Photos that are offered at most.
const MOST_OFFERED: usize = 24;

/// Draws them.
pub(super) fn points(open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    crs_row(open, ui, commands);
    adding(ui, commands);
    let list = open.control_list();
    if list.points.is_empty() {
        ui.weak(
            "Add a point, or load a list. Then click where a photo shows it. In other photos a line says where it \
             can be, and after two marks a ring where it should be.",
        );
    }
    for (place, point) in list.points.iter().enumerate() {
        let is_chosen = open.control.chosen == Some(place);
        let frame = egui::Frame::new().inner_margin(4.0).corner_radius(3.0);
        let frame = match is_chosen {
            true => frame
                .fill(ui.visuals().faint_bg_color)
                .stroke(ui.visuals().selection.stroke),
            false => frame,
        };
        frame.show(ui, |ui| {
            one(open, place, point, is_chosen, ui, commands);
        });
    }
}

fn one(
    open: &OpenFlight,
    place: usize,
    point: &ControlPoint,
    is_chosen: bool,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let name = &point.name;
    ui.horizontal(|ui| {
        let choose = ui.radio(is_chosen, "");
        choose.widget_info(|| {
            let label = format!("Mark {name}");
            egui::WidgetInfo::selected(egui::Role::RadioButton, true, is_chosen, label)
        });
        let hover = "Clicks in the photo view mark this point";
        if choose.on_hover_text(hover).clicked() {
            commands.push(Command::Control(ControlStep::Choose(Some(place))));
        }
        let label = format!("Name of control point {}", place + 1);
        let hover = "What the point is called; click to write another name";
        if let Some(name) = text_field(ui, &label, hover, name, 64.0) {
            commands.push(Command::Control(ControlStep::Rename(place, name)));
        }
        let text = point.position.map(written).unwrap_or_default();
        let label = format!("Surveyed place of {name}");
        let hover = "East, north and height, typed or pasted from a table; empty for an end of a scale bar alone";
        // Its own margin and the button behind it; else the panel would grow.
        let width = (ui.available_width() - 52.0).max(60.0);
        let (key, hint) = (("surveyed place", place), "x y z, not surveyed");
        if let Some(typed) = field_of(ui, key, &label, hover, &text, hint, width) {
            commands.push(match read(&typed) {
                Ok(position) => Command::Control(ControlStep::Survey(place, position)),
                Err(why) => Command::Report(format!("{name}: {why}")),
            });
        }
        let remove = ui.small_button("✖");
        let label = format!("Remove control point {name}");
        remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
        if remove.on_hover_text(format!("{label}; undo brings it back")).clicked() {
            commands.push(Command::Control(ControlStep::Remove(place)));
        }
    });
    fits(open, place, point, ui);
    if is_chosen {
        marks(open, place, point, ui, commands);
        seen_in(open, point, ui, commands);
    }
}

/// How well the marks agree, and the point with its survey.
fn fits(open: &OpenFlight, place: usize, point: &ControlPoint, ui: &mut egui::Ui) {
    let warn = ui.visuals().warn_fg_color;
    ui.horizontal_wrapped(|ui| {
        ui.add_space(20.0);
        let marks = match point.marks.len() {
            1 => "1 mark".to_owned(),
            count => format!("{count} marks"),
        };
        match open.control.found.points.get(place) {
            Some(Ok(found)) => {
                let rms = found.rms_px();
                let text = RichText::new(format!("{marks}, {rms:.2} px"));
                ui.label(match rms > POOR_PX {
                    true => text.color(warn),
                    false => text,
                });
            }
            Some(Err(why)) if point.marks.len() > 1 => {
                ui.colored_label(warn, format!("{marks}: {why}"));
            }
            _ => {
                ui.weak(marks);
            }
        }
        if let Some((found, length, used)) = residual(open, &point.name) {
            let unit = found.unit;
            match used {
                true => ui.label(unbroken(&format!("{length:.3} {unit} off"))),
                false => {
                    let text = unbroken(&format!("{length:.3} {unit} off, not used"));
                    ui.colored_label(warn, text)
                }
            };
        }
    });
}

/// The marks of the chosen point: a click goes to the photo.
fn marks(
    open: &OpenFlight,
    place: usize,
    point: &ControlPoint,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let name = &point.name;
    let found = open
        .control
        .found
        .points
        .get(place)
        .and_then(|found| found.as_ref().ok());
    // Marks in photos that the flight does not have are in no fit.
    let mut number = 0;
    for (photo, _) in &point.marks {
        let index = (open.flight().parts().photos.iter()).position(|posed| posed.name == *photo);
        let Some(index) = index else {
            ui.weak(format!("{photo}: not in this flight"));
            continue;
        };
        let off = found.and_then(|found| found.residuals_px.get(number).copied().flatten());
        let is_suspect = found.is_some_and(|found| found.suspect == Some(number));
        number += 1;
        ui.horizontal(|ui| {
            ui.add_space(20.0);
            let px = off.map_or_else(String::new, |off| format!("  {off:.2} px"));
            let sign = if is_suspect { "⚠ " } else { "" };
            let mut text = RichText::new(format!("{sign}{photo}{px}"));
            if is_suspect {
                text = text.color(ui.visuals().warn_fg_color);
            }
            let go = ui.selectable_label(open.selected == Some(index), text);
            go.widget_info(|| {
                let says = if is_suspect { ", probably on another thing" } else { "" };
                let label = format!("Mark of {name} in {photo}{px}{says}");
                egui::WidgetInfo::labeled(egui::Role::Button, true, label)
            });
            let hover = match is_suspect {
                true => "The other marks agree without this one: it is probably on another thing. Click to go to the photo",
                false => "Go to the photo; how far the point is from its mark there",
            };
            if go.on_hover_text(hover).clicked() {
                commands.push(Command::Select(Some(index)));
            }
            let remove = ui.small_button("✖");
            let label = format!("Remove the mark of {name} in {photo}");
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if remove.on_hover_text("Take this mark away (Delete in the photo)").clicked() {
                commands.push(Command::Control(ControlStep::Mark {
                    point: place,
                    photo: index,
                    pixel: None,
                }));
            }
        });
    }
}

/// The photos without a mark in which the chosen point should be.
fn seen_in(
    open: &OpenFlight,
    point: &ControlPoint,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let photos = &open.control.found.seen_in;
    if photos.is_empty() {
        if point.marks.len() < 2 {
            ui.weak("Click it in the photo view, in two photos at least. Drag moves a mark, Delete takes it away.");
        }
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.add_space(20.0);
        ui.weak("Seen in");
        for photo in photos.iter().take(MOST_OFFERED) {
            let photo_name = open.name(*photo);
            let go = ui.small_button(last_segment(photo_name));
            go.widget_info(|| {
                let label = format!("{} is seen in {photo_name}", point.name);
                egui::WidgetInfo::labeled(egui::Role::Button, true, label)
            });
            if go
                .on_hover_text("Go to the photo; a ring says where it should be")
                .clicked()
            {
                commands.push(Command::Select(Some(*photo)));
            }
        }
        let more = photos.len().saturating_sub(MOST_OFFERED);
        if more > 0 {
            ui.weak(format!("and {more} more"));
        }
    });
}

/// A place as it is typed.
fn written(place: DVec3) -> String {
    format!("{} {} {}", place.x, place.y, place.z)
}

/// What is typed: three numbers between blanks, tabs, semicolons or commas; between blanks a comma is a decimal one.
/// `None` of nothing.
fn read(typed: &str) -> Result<Option<DVec3>, &'static str> {
    let typed = typed.trim();
    if typed.is_empty() {
        return Ok(None);
    }
    let between_blanks: Vec<String> = typed
        .split(|sign: char| sign.is_whitespace() || sign == ';')
        .map(|field| field.trim_end_matches(','))
        .filter(|field| !field.is_empty())
        .map(|field| field.replace(',', "."))
        .collect();
    let fields = match between_blanks.len() {
        3 => between_blanks,
        _ => typed
            .split(',')
            .map(|field| field.trim().to_owned())
            .collect(),
    };
    let numbers: Result<Vec<f64>, _> = fields.iter().map(|field| field.parse()).collect();
    let numbers: Option<[f64; 3]> = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    let place = numbers
        .map(DVec3::from_array)
        .filter(|place| place.is_finite());
    place
        .map(Some)
        .ok_or("a surveyed place is three numbers: east, north, height")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_as_people_type_them() {
        let place = Ok(Some(DVec3::new(435_205.5, -62.25, 411.0)));
        for typed in [
            "435205.5 -62.25 411",
            "435205.5\t-62.25\t411\n",
            " 435205,5; -62,25; 411 ",
            "435205.5, -62.25, 411",
            "435205.5,-62.25,411",
            "4.352055e5 -62.25 411.0",
        ] {
            assert_eq!(read(typed), place, "{typed}");
        }
        assert_eq!(
            read(&written(DVec3::new(0.1, 1e7 / 3.0, -2.0))),
            Ok(Some(DVec3::new(0.1, 1e7 / 3.0, -2.0)))
        );
        assert_eq!(read("  "), Ok(None));
        for wrong in ["1 2", "1 2 x", "1 2 3 4", "1 2 nan", "1,2"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
