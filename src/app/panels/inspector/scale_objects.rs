//! The inspector's section of scale objects: tracing one, and what it says beside the point cloud.

use crate::actions;
use crate::command::Command;
use crate::flight::{ComparedObject, ScaleObject, Verdict};
use crate::names::unbroken;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::open_flight::tracing::{Trace, Tracing};
use crate::panels::field::{being_typed, in_field, number_field, number_of, settled, text_field};
use crate::panels::rows::Rows;
use crate::panels::verdict::{or_dash, verdict_color};
use crate::panels::{shown_lengths, shown_per};
use crate::scale::{ScaleObjectKind, Traced};
use crate::state::State;

/// With points on less of the outline than this, degrees, the other side is a guess.
const SHORT_ARC: f64 = 180.0;

/// A standard error above this share says little.
const VAGUE: f64 = 0.02;

/// Points that are further off the outline than this, pixels, are on something else.
const FAR_OFF_PX: f64 = 2.0;

/// What is said of the field of a size.
const SIZE: &str = "As it was measured; flight.toml keeps it in the unit of the flight's world";

/// A size in the world's unit, of which `factor` times as many are shown: with twelve digits, so that 3 in are written as 0.0762 m.
fn in_world(shown: f64, factor: f64) -> f64 {
    let world = shown / factor;
    format!("{world:.11e}").parse().unwrap_or(world)
}

/// Draws the section.
pub(super) fn scale_objects(
    state: &State,
    open: &OpenFlight,
    photo: usize,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.separator();
    let objects: Vec<(usize, &ScaleObject)> = open.objects_of(photo).collect();
    let is_wanted = open.objects.tracing.is_some() || !objects.is_empty();
    egui::CollapsingHeader::new("Scale object")
        .id_salt(("scale object", photo))
        .default_open(is_wanted)
        .open(open.objects.tracing.is_some().then_some(true))
        .show(ui, |ui| {
            if open.objects.tracing.is_some() {
                being_traced(state, ui, commands);
            } else {
                for (action, kind) in [
                    (actions::photo::TRACE_SPHERE, ScaleObjectKind::Sphere),
                    (actions::photo::TRACE_BAR, ScaleObjectKind::Bar),
                ] {
                    begin(state, open, action, kind, ui, commands);
                }
            }
            for ((place, object), number) in objects.into_iter().zip(1_usize..) {
                card(state, open, place, object, number, ui, commands);
            }
        });
}

/// A row with the size that is known and the button that begins.
fn begin(
    state: &State,
    open: &OpenFlight,
    action: actions::Action,
    kind: ScaleObjectKind,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let size = open.trace_size(kind);
    let (name, label) = match kind {
        ScaleObjectKind::Sphere => ("Diameter", "Diameter of the next sphere"),
        ScaleObjectKind::Bar => ("Length", "Length of the next bar"),
    };
    ui.horizontal_wrapped(|ui| {
        // The field is left by the click on the button, which has to be there before.
        let typed = being_typed(ui, label).and_then(|typed| number_of(&typed).ok());
        let is_size = |size: f64| size > 0.0;
        let can_begin = (action.command)(state).is_some() || typed.is_some_and(is_size);
        let button = ui.add_enabled(can_begin, egui::Button::new(action.label));
        let button = button.on_disabled_hover_text("Type its size first");
        let begins = button.on_hover_text(action.hover).clicked();
        ui.label(name);
        let (unit, factor) = shown_lengths(state, open);
        let text = size.map_or_else(String::new, |size| in_field(size * factor));
        let typed = text_field(ui, label, SIZE, &text, 60.0);
        ui.label(unit);
        let is_left = typed.is_some();
        let size = settled(ui, label, typed);
        if let Some(size) = size {
            commands.push(Command::Trace(Trace::Size(kind, in_world(size, factor))));
        }
        // Not by the size of before where another one was typed that is none.
        if begins && (!is_left || size.is_some_and(is_size)) {
            commands.push(Command::Trace(Trace::Begin(kind)));
        }
    });
}

/// What can be done while the outline grows.
fn being_traced(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let Some(tracing) = &open.objects.tracing else {
        return;
    };
    ui.strong(next_step(tracing));
    if let Some(so_far) = scale_so_far(state, open, tracing) {
        ui.label(so_far);
    }
    ui.weak("The wheel zooms, dragging moves the photo or a point.");
    ui.horizontal_wrapped(|ui| {
        for (action, text) in [
            (actions::photo::FINISH_TRACING, "Done"),
            (actions::photo::REMOVE_POINT, "Last point back"),
            (actions::photo::LEAVE, "Give up"),
        ] {
            let command = (action.command)(state);
            let button = ui.add_enabled(command.is_some(), egui::Button::new(text));
            let keys = action.shortcut.map(|keys| ui.ctx().format_shortcut(&keys));
            let hover = format!("{} ({})", action.hover, keys.unwrap_or_default());
            if button.on_hover_text(hover).clicked() {
                commands.extend(command);
            }
        }
    });
}

/// The scale that the points give already.
fn scale_so_far(state: &State, open: &OpenFlight, tracing: &Tracing) -> Option<String> {
    let parts = open.flight().parts();
    let camera = open.flight().camera(parts.photos.get(open.selected?)?);
    let size = open.trace_size(tracing.kind)?;
    let traced = Traced::new(camera, tracing.kind, size, &tracing.outline).ok()?;
    let (per, factor) = shown_per(state, open);
    let scale = traced.scale(camera, parts.image)? * factor;
    let error = match traced {
        Traced::Sphere(sphere) => sphere.relative_error,
        Traced::Bar(_) => None,
    };
    let error = error.map(|error| format!(" ± {:.1} %", error * 100.0));
    Some(unbroken(&format!(
        "{} {per}{}",
        significant_digits(scale, 4),
        error.unwrap_or_default()
    )))
}

/// What to do next.
fn next_step(tracing: &Tracing) -> String {
    match (tracing.kind, tracing.outline.len()) {
        (ScaleObjectKind::Sphere, 0) => "Click points on the sphere's edge, all around".to_owned(),
        (ScaleObjectKind::Sphere, count) if tracing.is_complete() => {
            format!("{count} points; Enter when they go all around")
        }
        (ScaleObjectKind::Sphere, count) => format!("{count} of at least 3 points, better 8"),
        (ScaleObjectKind::Bar, 0) => "Click one end of the bar".to_owned(),
        (ScaleObjectKind::Bar, _) => "Click its other end".to_owned(),
    }
}

/// A scale object with its numbers.
fn card(
    state: &State,
    open: &OpenFlight,
    place: usize,
    object: &ScaleObject,
    number: usize,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let (unit, factor) = shown_lengths(state, open);
    let title = format!("{} {number}", object.kind.as_str());
    egui::Frame::group(ui.style()).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.strong(format!("{number}: {}", object.kind.as_str()));
            ui.label(object.kind.size_name());
            let label = format!("Size of {title}");
            let typed = number_field(ui, &label, SIZE, object.size * factor, unit);
            if let Some(size) = typed.filter(|&size| size > 0.0) {
                let size = in_world(size, factor);
                commands.extend(open.change_object(place, |object| object.size = size));
            }
        });
        match open.compared(object) {
            None => {
                ui.weak("computing…");
            }
            Some(ComparedObject {
                traced: Err(fault), ..
            }) => {
                ui.colored_label(doubtful(ui), fault.to_string());
            }
            Some(compared) => numbers(state, open, compared, &title, ui, commands),
        }
        ui.horizontal_wrapped(|ui| {
            let mut mask = object.mask;
            let label = "Mask in export";
            let check = ui.checkbox(&mut mask, label);
            check.widget_info(|| {
                let label = format!("Mask {title} in export");
                egui::WidgetInfo::selected(egui::Role::CheckBox, true, object.mask, label)
            });
            let hover = "Paint it blue in the exported photo, so that it is not taken for rock";
            if check.on_hover_text(hover).changed() {
                commands.extend(open.change_object(place, |object| object.mask = mask));
            }
            let delete = ui.button("Delete");
            delete.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Delete {title}"))
            });
            if delete.clicked() {
                let mut settings = open.settings();
                settings.scale_objects.remove(place);
                commands.push(Command::Set(settings));
            }
        });
    });
}

fn doubtful(ui: &egui::Ui) -> egui::Color32 {
    verdict_color(Verdict::Check, ui.visuals())
}

fn numbers(
    state: &State,
    open: &OpenFlight,
    compared: &ComparedObject,
    title: &str,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(scale) = compared.scale else {
        ui.colored_label(doubtful(ui), "the lens does not see it");
        return;
    };
    let (per, factor) = shown_per(state, open);
    let world = open.flight().parts().unit_of_lengths();
    let in_unit = |scale: f64| significant_digits(scale * factor, 5);
    let percent = |share: f64| format!("{:+.2} %", share * 100.0);
    let error = match &compared.traced {
        Ok(Traced::Sphere(sphere)) => sphere.relative_error,
        _ => None,
    };
    ui.horizontal_wrapped(|ui| {
        ui.vertical(|ui| {
            ui.weak(format!("Uniform scale, {per}"));
            ui.label(egui::RichText::new(in_unit(scale)).size(20.0).strong());
        });
        let copy = ui.button("Copy");
        copy.widget_info(|| {
            let label = format!("Copy the scale of {title}");
            egui::WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        let hover = "Copy the one scale that this object gives the whole photo";
        if copy.on_hover_text(hover).clicked() {
            commands.push(Command::Copy(significant_digits(scale * factor, 6)));
        }
    });
    let place = compared.place;
    let sign = "In percent: how much larger the object's scale is. Where it is larger, fragments come \
                out smaller with it.";
    let found = |scale: Option<f64>| or_dash(scale.map(|scale| scale * factor), 5);
    let off = |share: Option<f64>| share.map(percent).unwrap_or_default();
    let mut rows = vec![
        (
            "Point cloud, on its row",
            format!(
                "What Split-Desktop takes at its height in the photo: linear from the top to the \
                 bottom scale. {sign}"
            ),
            [found(place.between_edges), off(compared.beyond_edges())],
        ),
        (
            "Point cloud, around it",
            format!("Of the surface on a ring around it, half as large again: the median. {sign}"),
            [found(place.around), off(compared.beyond_surroundings())],
        ),
        (
            "Point cloud, under it",
            format!(
                "Of the surface under its middle. Where the cloud shows the object itself, that is \
                 its near side. {sign}"
            ),
            [found(place.on_surface), off(compared.beyond_surface())],
        ),
    ];
    match &compared.traced {
        Ok(Traced::Sphere(sphere)) => {
            let standard_error = match error {
                Some(error) => format!("± {:.2} %", error * 100.0),
                None => "mark more than three points".to_owned(),
            };
            let depth = format!("{} {world}", significant_digits(sphere.center.z, 5));
            for (name, hover, text) in [
                (
                    "Standard error",
                    "Standard error of the scale, from the scatter of the points",
                    standard_error,
                ),
                (
                    "Off the outline",
                    "Of the points from the outline that is drawn, root mean square",
                    format!("{:.2} px", sphere.rms),
                ),
                (
                    "Depth",
                    "Of its centre from the camera's, along the view",
                    depth,
                ),
            ] {
                rows.push((name, hover.to_owned(), [text, String::new()]));
            }
        }
        Ok(Traced::Bar(_)) => {
            let length = place.length_on_surface;
            let (unit, factor) = shown_lengths(state, open);
            let length = length.map(|length| significant_digits(length * factor, 5));
            let text = length.map(|length| format!("{length} {unit}"));
            let hover = "Between the places where the rays of its ends meet the surface. In percent: \
                         how much longer that is than the bar.";
            let texts = [
                text.unwrap_or_else(|| "–".to_owned()),
                off(compared.beyond_length()),
            ];
            rows.push(("Length on the point cloud", hover.to_owned(), texts));
        }
        Err(_) => {}
    }
    let texts = rows.iter().map(|(name, _, [value, off])| {
        let texts = [*name, value, off].map(str::to_owned);
        // In a narrow panel nothing takes no place.
        texts.into_iter().filter(|text| !text.is_empty()).collect()
    });
    let shown = Rows {
        id: title,
        heads: None,
        rows: texts.collect(),
    };
    shown.show(ui, |ui, place, name| {
        let hover = rows.get(place).map_or("", |(_, hover, _)| hover);
        ui.weak(name).on_hover_text(hover);
    });
    for doubt in doubts(&compared.traced) {
        ui.colored_label(doubtful(ui), format!("• {doubt}"));
    }
    if matches!(compared.traced, Ok(Traced::Bar(_))) {
        ui.weak("As if it lay parallel to the image; tilted, it looks shorter.");
    }
}

/// What speaks against a sphere's scale.
fn doubts(traced: &Result<Traced, crate::fault::Fault>) -> Vec<String> {
    let Ok(Traced::Sphere(sphere)) = traced else {
        return Vec::new();
    };
    let mut doubts = Vec::new();
    if sphere.arc < SHORT_ARC {
        doubts.push(format!(
            "the points go only {:.0}° round the outline; mark some on its other side",
            sphere.arc
        ));
    }
    if sphere.rms > FAR_OFF_PX {
        doubts.push(format!(
            "the points are {:.1} px off a sphere's outline; are all on its edge?",
            sphere.rms
        ));
    }
    if let Some(error) = sphere.relative_error.filter(|&error| error > VAGUE) {
        doubts.push(format!(
            "the scale is only good to {:.0} %; mark more points",
            error * 100.0
        ));
    }
    doubts
}
