//! The fragment that is looked at, the doubtful ones, and what all of them come to.

use std::collections::BTreeSet;

use egui::{Role, Ui, WidgetInfo};

use super::all_photos::{as_measured, say, size_rows};
use crate::command::{Asking, Command};
use crate::delineation::measures::Fragment;
use crate::fragments::{FragmentStep, MeasuredFragments, PhotoOutlines};
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::rows::pairs;
use crate::state::State;
use crate::tasks::Task;

/// The height of a row of the doubtful ones.
const ROW: f32 = 20.0;

/// How much of the panel they take; beside the measures of a selected one less, and in a low panel, so that what all come to stays in
/// sight.
const ROWS: f32 = 160.0;
const FEW_ROWS: f32 = 66.0;
const LOW: f32 = 480.0;

/// Draws all of it.
pub(super) fn found(
    state: &State,
    open: &OpenFlight,
    photo: usize,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let Some(of) = open.fragments.of(photo) else {
        if state.work.is_running(Task::READ_OUTLINES) {
            ui.weak("Reading the saved outlines…");
            return;
        }
        if state.work.is_running(Task::OUTLINE)
            && let Some(before) = open.fragments.before(photo)
        {
            ui.weak(match before {
                0 => "Outlining…".to_owned(),
                1 => "Its turn to be outlined is next.".to_owned(),
                _ => format!("{before} photos are outlined before this one."),
            });
            return;
        }
        ui.label("Nothing is outlined in this photo yet.");
        ui.weak(
            "Press 'Outline this photo'. Then correct what is wrong: every change can be undone, and the numbers follow. \
             Saving the flight saves the outlines beside it.",
        );
        return;
    };
    // How far to trust them goes before what they come to.
    say(of.notes(), ui);
    let measured = of.measured();
    if let Some(number) = open.fragments.selected {
        selected(state, open, of, measured, number, ui, commands);
        ui.separator();
    }
    doubtful(of, open.fragments.selected, ui, commands);
    ui.separator();
    match measured {
        Some(measured) => all(state, open, (of, measured), ui, commands),
        None if state.work.is_running(Task::MEASURE_FRAGMENTS) => {
            ui.weak("Measuring…");
        }
        None => {
            ui.weak("Not measured: see the log.");
        }
    }
}

/// The fragment that is looked at.
fn selected(
    state: &State,
    open: &OpenFlight,
    of: &PhotoOutlines,
    measured: Option<&MeasuredFragments>,
    number: u32,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        ui.strong(format!("Fragment {number}"));
        ui.label(match of.now().sure(number) {
            Some(sure) => format!("{:.0} % sure", 100.0 * sure),
            None => "looked at".to_owned(),
        });
    });
    ui.horizontal_wrapped(|ui| {
        for (name, step, hover) in [
            (
                "Right",
                FragmentStep::IsRight,
                "It is right as it is: on to the next doubtful one (Enter)",
            ),
            (
                "Delete",
                FragmentStep::Delete,
                "It is no fragment: its pixels are fines (Delete)",
            ),
            (
                "No rock",
                FragmentStep::NoRock,
                "A ball or a machine: neither a fragment nor fines (Ctrl+Delete)",
            ),
        ] {
            let button = ui.button(name).on_hover_text(hover);
            let label = format!("{name}: this fragment");
            button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
            if button.clicked() {
                commands.push(Command::Fragments(step));
            }
        }
    });
    match measured.and_then(|measured| measured.fragment(number)) {
        _ if of.on_objects().is_some_and(|on| on.contains(&number)) => {
            ui.weak("It lies on a scale object: no rock, and not measured.");
        }
        Some(fragment) => measures(state, open, fragment, ui),
        None => {
            ui.weak("Being measured…");
        }
    }
}

fn measures(state: &State, open: &OpenFlight, fragment: &Fragment, ui: &mut Ui) {
    let Some(world) = &fragment.world else {
        ui.weak("Too little of it lies on the surface to be measured.");
        return;
    };
    let unit = state.preferences.unit();
    let factor = open.flight().parts().unit.in_units_of(unit);
    let length = |length: f64| format!("{} {unit}", significant_digits(length * factor, 3));
    let area = |area: f64| format!("{} {unit}²", significant_digits(area * factor * factor, 3));
    let mut rows = vec![
        ("Sieve size", length(world.sieve_size)),
        (
            "Length × breadth",
            format!(
                "{} × {}",
                length(world.rectangle[0]),
                length(world.rectangle[1])
            ),
        ),
        ("Widest", length(world.widths[1])),
        ("Circle of its area", length(world.diameter)),
        ("Inscribed circle", length(world.inscribed)),
        ("Area", area(world.area)),
        ("On the surface", area(world.surface_area)),
        (
            "Stands out",
            world.height.map_or_else(|| "–".to_owned(), length),
        ),
        ("Roundness", significant_digits(world.roundness, 2)),
    ];
    if fragment.is_cut {
        rows.push(("Cut by the edge", "its size does not count".to_owned()));
    }
    pairs("fragment measures", rows, ui);
}

/// Those that nobody looked at, the most doubtful first.
fn doubtful(of: &PhotoOutlines, selected: Option<u32>, ui: &mut Ui, commands: &mut Vec<Command>) {
    let doubtful = &of.doubtful;
    ui.horizontal_wrapped(|ui| {
        ui.label(format!(
            "{} fragments that nobody looked at",
            doubtful.len()
        ));
        let next = ui.add_enabled(!doubtful.is_empty(), egui::Button::new("Next"));
        let hover = "Show the most doubtful one behind this (N)";
        next.widget_info(|| {
            WidgetInfo::labeled(Role::Button, !doubtful.is_empty(), "Next doubtful fragment")
        });
        if next.on_hover_text(hover).clicked() {
            commands.push(Command::Fragments(FragmentStep::NextDoubtful));
        }
    });
    let on_objects = match of.on_objects().map_or(0, BTreeSet::len) {
        0 => None,
        1 => Some("1 fragment lies on a scale object: no rock, nothing to look at".to_owned()),
        count => Some(format!(
            "{count} fragments lie on scale objects: no rock, nothing to look at"
        )),
    };
    if let Some(on_objects) = on_objects {
        let hover = "More than half of it is within the outline of a scale object that is masked; its size counts nowhere";
        ui.add(egui::Label::new(egui::RichText::new(on_objects).weak()).wrap())
            .on_hover_text(hover);
    }
    if doubtful.is_empty() {
        return;
    }
    let is_low = ui.clip_rect().height() < LOW;
    let height = match selected.is_some() || is_low {
        true => FEW_ROWS,
        false => ROWS,
    };
    let mut list = egui::ScrollArea::vertical()
        .id_salt("doubtful fragments")
        .max_height(height)
        .auto_shrink([false, true]);
    // Where another one is selected, the list goes to it.
    let id = ui.scope_id().with("doubtful fragment shown");
    let before = ui.data(|data| data.get_temp::<Option<u32>>(id));
    ui.data_mut(|data| data.insert_temp(id, selected));
    let at = doubtful
        .iter()
        .position(|(number, _)| selected == Some(*number));
    if let (true, Some(at)) = (before != Some(selected), at) {
        let row = ROW + ui.spacing().item_spacing.y;
        // No farther than to the last one, where it would spring back.
        let most = (doubtful.len() as f32 * row - height).max(0.0);
        list = list.vertical_scroll_offset((at as f32 * row - height / 2.0).clamp(0.0, most));
    }
    list.show_rows(ui, ROW, doubtful.len(), |ui, rows| {
        for (number, sure) in &doubtful[rows] {
            let on = selected == Some(*number);
            let text = format!("{number}: {:.0} % sure", 100.0 * sure);
            if ui.selectable_label(on, text).clicked() {
                commands.push(Command::Fragments(FragmentStep::Show(*number)));
            }
        }
    });
}

/// What all of them come to.
fn all(
    state: &State,
    open: &OpenFlight,
    (of, measured): (&PhotoOutlines, &MeasuredFragments),
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let by_mass = match &measured.by_mass {
        Ok(by_mass) => by_mass,
        Err(fault) => {
            ui.colored_label(ui.visuals().warn_fg_color, fault.to_string());
            return;
        }
    };
    let mut rows = size_rows(state, open, by_mass, &measured.intervals);
    rows.push(("Outlined by", outlined_by(&of.by().engine)));
    as_measured("This photo", ui);
    ui.horizontal_wrapped(|ui| take_along(state, ui, commands));
    pairs("fragments by mass", rows, ui);
    say(&measured.notes, ui);
}

/// What outlined a photo first: the engine as it is chosen above, or as its file names it.
fn outlined_by(engine: &str) -> String {
    match engine {
        "" => "not known".to_owned(),
        name => name.to_owned(),
    }
}

/// What is done with them.
fn take_along(state: &State, ui: &mut Ui, commands: &mut Vec<Command>) {
    let button = ui.button("To size distributions");
    let hover = "Take this photo's curve over to the page of size distributions, beside sieves and other methods";
    if button.on_hover_text(hover).clicked() {
        commands.push(Command::Fragments(FragmentStep::TakeDistribution));
    }
    let is_busy = state.work.is_running(Task::EXPORT_FRAGMENTS);
    let button = ui.add_enabled(!is_busy, egui::Button::new("Export fragments…"));
    let hover = "Write outlines, tables and a report of all photos that are outlined, corrected as they are now";
    if button.on_hover_text(hover).clicked() {
        commands.push(Command::Ask(Some(Asking::ExportFragments)));
    }
}
