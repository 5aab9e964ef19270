//! What the outlines of all photos come to together.

use egui::Ui;

use crate::command::Command;
use crate::delineation::intervals::SizeInterval;
use crate::delineation::mass::ByMass;
use crate::exports::{self, PhotoOfSizes};
use crate::fragments::FragmentStep;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::rows::pairs;
use crate::state::State;
use crate::tasks::Task;

/// Over the sizes of fragments: they are not those of a fitted function.
pub(super) fn as_measured(of: &str, ui: &mut Ui) {
    let hover = "P20 to P80 are read off the curve as measured. Size distributions fits a function to this curve: its percentiles are a \
                 little beside these";
    ui.strong(format!("{of}, by mass, as measured"))
        .on_hover_text(hover);
}

/// What fragments come to, in the unit of lengths.
pub(super) fn size_rows(
    state: &State,
    open: &OpenFlight,
    by_mass: &ByMass,
    intervals: &[SizeInterval],
) -> Vec<(&'static str, String)> {
    let unit = state.preferences.unit();
    let factor = open.flight().parts().unit.in_units_of(unit);
    let sizes = PhotoOfSizes {
        photo: "",
        by_mass,
        intervals,
        scale: None,
    };
    let behind = format!(" {unit}");
    let size = |percent: f64| {
        let size = sizes.size_in_words(percent, factor, &behind);
        size.unwrap_or_else(|| "below what is seen".to_owned())
    };
    let percent = exports::percent;
    vec![
        ("P20", size(20.0)),
        ("P50", size(50.0)),
        ("P80", size(80.0)),
        ("Whole fragments", by_mass.whole.to_string()),
        ("Cut by an edge", by_mass.cut.to_string()),
        ("Area not outlined", percent(by_mass.unfound)),
        ("Of the mass, fines", percent(by_mass.fines)),
        (
            "Nothing said below",
            format!("{} {unit}", significant_digits(by_mass.limit * factor, 2)),
        ),
    ]
}

/// What the outlines of all photos come to.
pub(super) fn of_all_photos(
    state: &State,
    open: &OpenFlight,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    ui.separator();
    as_measured("All outlined photos", ui);
    let is_busy = state.work.is_running(Task::MEASURE_ALL);
    let all = open.fragments.all.as_ref();
    ui.horizontal_wrapped(|ui| {
        let name = if all.is_some() { "Measure again" } else { "Measure all photos" };
        let button = ui.add_enabled(!is_busy, egui::Button::new(name));
        let hover = "Measure the fragments of every outlined photo and join them: the sizes of the whole flight, as the export writes \
                     them";
        if button.on_hover_text(hover).clicked() {
            commands.push(Command::Fragments(FragmentStep::MeasureAll));
        }
        if all.is_some() {
            let button = ui.button("All to size distributions");
            let hover = "Take the curves of these photos over to the page of size distributions, beside sieves and other methods";
            if button.on_hover_text(hover).clicked() {
                commands.push(Command::Fragments(FragmentStep::TakeAllDistributions));
            }
        }
    });
    let Some(all) = all else {
        return;
    };
    if open.fragments_made_of() != all.made_of {
        let changed = "Outlines, masks or decisions were changed since: measure again.";
        ui.colored_label(ui.visuals().warn_fg_color, changed);
    }
    let [count, of] = all.photos;
    let mut rows = match &all.sizes {
        Some((by_mass, intervals)) => size_rows(state, open, by_mass, intervals),
        None => Vec::new(),
    };
    rows.push(("Photos", format!("{count} of {of}")));
    pairs("fragments of all photos", rows, ui);
    say(&all.notes, ui);
}

/// What is to be said of fragments.
pub(super) fn say(notes: &[String], ui: &mut Ui) {
    for note in notes {
        let note = egui::RichText::new(note).color(ui.visuals().warn_fg_color);
        ui.add(egui::Label::new(note).wrap());
    }
}
