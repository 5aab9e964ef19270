//! How sure the engineer is of what scales are computed from: the fields of `[uncertainty]`. An empty
//! one is not stated here; then what the package states stands in it as a hint.

use glam::DVec3;

use crate::command::Command;
use crate::flight::{FlightParts, FlightSettings, Photo};
use crate::numbers::significant_digits;
use crate::panels::field::hinted_field;
use crate::scale::{PoseErrors, StatedErrors};
use crate::state::State;

/// The width of the fields' names, points.
const NAMES: f32 = 100.0;

/// The width of a field, into which three numbers fit, points.
const FIELD: f32 = 130.0;

/// Draws the fields.
pub(super) fn stated_errors(
    state: &State,
    now: &FlightSettings,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    let parts = open.flight().parts();
    let package = parts.package_errors;
    ui.strong("How sure it is: standard deviations");
    ui.label("What is empty is taken from the package, else it is not counted.");
    let unit = now.unit_of_lengths();
    let mut next = now.errors;
    for (place, name, label, unit, hint, hover) in [
        (
            Place::Axes(&mut next.pose.position),
            "Camera position",
            "Standard deviation of camera positions",
            unit,
            hint_of_axes(parts, package.pose.position, |errors| errors.position),
            "Of camera centres, the same along each axis, or three numbers for x, y and z",
        ),
        (
            Place::Axes(&mut next.pose.angle),
            "Camera angle",
            "Standard deviation of camera angles",
            "°",
            hint_of_axes(parts, package.pose.angle, |errors| errors.angle),
            "Of rotations about each camera axis, or three numbers for x, y and z",
        ),
        (
            Place::Number(&mut next.focal),
            "Focal length",
            "Standard deviation of focal lengths",
            "%",
            hint_of(package.focal),
            "Of fx and fy together",
        ),
        (
            Place::Number(&mut next.surface),
            "Surface",
            "Standard deviation of the surface",
            unit,
            hint_of(package.surface),
            "Of a surface point along its ray; what lies between points is estimated besides",
        ),
        (
            Place::Number(&mut next.world_scale),
            "World's scale",
            "Standard deviation of the world's scale",
            "%",
            hint_of(package.world_scale),
            "Of all lengths",
        ),
    ] {
        ui.horizontal_wrapped(|ui| {
            let size = egui::vec2(NAMES, ui.spacing().interact_size.y);
            let beside = egui::Layout::left_to_right(egui::Align::Center);
            ui.allocate_ui_with_layout(size, beside, |ui| {
                ui.set_min_width(NAMES);
                ui.label(name).on_hover_text(hover);
            });
            // With room for the unit behind it.
            let width = (ui.available_width() - 28.0).clamp(40.0, FIELD);
            if let Some(typed) = hinted_field(ui, label, hover, &place.text(), &hint, width)
                && let Err(why) = place.take(&typed)
            {
                commands.push(Command::Report(format!("{name}: {why}")));
            }
            ui.label(unit);
        });
    }
    if of_the_poses(&parts.photos) {
        ui.weak("Where the table of poses states a photo's, that comes first.");
    }
    if next != now.errors {
        commands.push(Command::Set(FlightSettings {
            errors: next,
            ..now.clone()
        }));
    }
}

/// Where a field's number goes.
enum Place<'a> {
    Number(&'a mut Option<f64>),
    Axes(&'a mut Option<DVec3>),
}

impl Place<'_> {
    fn text(&self) -> String {
        match self {
            Self::Number(number) => number.map_or_else(String::new, |number| number.to_string()),
            Self::Axes(axes) => axes.map_or_else(String::new, axes_text),
        }
    }

    /// Takes what was typed, or says why it cannot.
    fn take(self, typed: &str) -> Result<(), String> {
        let numbers = numbers(typed)?;
        let wrong = |what: &str| Err(format!("'{}' is {what}", typed.trim()));
        match (self, &numbers[..]) {
            (Self::Number(place), []) => *place = None,
            (Self::Axes(place), []) => *place = None,
            (Self::Number(place), [number]) => *place = Some(*number),
            (Self::Axes(place), [number]) => *place = Some(DVec3::splat(*number)),
            (Self::Axes(place), [x, y, z]) => *place = Some(DVec3::new(*x, *y, *z)),
            (Self::Number(_), _) => return wrong("more than one number; type one"),
            (Self::Axes(_), _) => return wrong("neither one number nor three; type one or three"),
        }
        Ok(())
    }
}

/// The standard deviations in a text, with spaces or semicolons between them; a comma is a decimal one.
fn numbers(typed: &str) -> Result<Vec<f64>, String> {
    let words = typed.split(|c: char| c.is_whitespace() || c == ';');
    let words = words.map(|word| word.trim_end_matches(',').replace(',', "."));
    words
        .filter(|word| !word.is_empty())
        .map(|word| match word.parse::<f64>() {
            Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
            _ => Err(format!(
                "'{word}' is no standard deviation; type 0 or more, or nothing where it is not known"
            )),
        })
        .collect()
}

fn axes_text(axes: DVec3) -> String {
    match axes == DVec3::splat(axes.x) {
        true => axes.x.to_string(),
        false => axes.to_array().map(|axis| axis.to_string()).join(" "),
    }
}

/// What the package states, as a hint in the empty field.
fn hint_of(package: Option<f64>) -> String {
    package.map_or_else(
        || "not stated".to_owned(),
        |number| format!("package: {}", significant_digits(number, 2)),
    )
}

/// The same of poses: of all photos, or from the least to the most that it states of each.
fn hint_of_axes(
    parts: &FlightParts,
    of_all: Option<DVec3>,
    of: fn(&PoseErrors) -> Option<DVec3>,
) -> String {
    let photos = parts.photos.iter();
    let each = photos.filter_map(|photo| of(&photo.package_errors));
    let each: Vec<DVec3> = each.chain(of_all).collect();
    let ends = each
        .iter()
        .map(|axes| (axes.min_element(), axes.max_element()));
    let ends = ends.reduce(|(a, b), (low, high)| (a.min(low), b.max(high)));
    match ends {
        None => hint_of(None),
        Some((low, high)) => {
            let [low, high] = [low, high].map(|end| significant_digits(end, 2));
            match low == high {
                true => format!("package: {low}"),
                false => format!("package: {low} to {high}"),
            }
        }
    }
}

fn of_the_poses(photos: &[Photo]) -> bool {
    let nothing = StatedErrors::default().pose;
    photos.iter().any(|photo| photo.errors != nothing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_they_are_typed() {
        assert_eq!(numbers(""), Ok(vec![]));
        assert_eq!(numbers(" 0,02 "), Ok(vec![0.02]));
        assert_eq!(numbers("0.02, 0.02, 0.05"), Ok(vec![0.02, 0.02, 0.05]));
        assert_eq!(numbers("1;2 ; 3"), Ok(vec![1.0, 2.0, 3.0]));
        for wrong in ["-0.1", "about", "nan", "inf", "0.02,0.02,0.05"] {
            assert!(numbers(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_field_takes_as_many_numbers_as_it_holds() {
        let (mut number, mut axes) = (None, None);
        assert!(Place::Axes(&mut axes).take("1 2 3").is_ok());
        assert_eq!(axes, Some(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(Place::Axes(&mut axes).text(), "1 2 3");
        assert!(Place::Axes(&mut axes).take("1 2").is_err());
        assert!(Place::Number(&mut number).take("1 2").is_err());
        assert!(Place::Number(&mut number).take("0").is_ok());
        assert_eq!(number, Some(0.0));
        assert!(Place::Axes(&mut axes).take("").is_ok());
        assert_eq!(axes, None);
    }
}
