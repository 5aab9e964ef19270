//! What is done every day, one click each.

use super::rows::text_width;
use super::verdict::{verdict_of_now, why_pending};
use crate::actions;
use crate::command::Command;
use crate::flight::Verdict;
use crate::names;
use crate::open_flight::OpenFlight;
use crate::size_distributions::Page;
use crate::state::State;
use crate::units::LengthUnit;

/// The units that scales are wanted in.
const UNITS: [LengthUnit; 5] = [
    LengthUnit::Millimetre,
    LengthUnit::Centimetre,
    LengthUnit::Metre,
    LengthUnit::Inch,
    LengthUnit::Foot,
];

/// A bar that is narrower, points, says less; so much more is needed for each verdict that not every flight has.
const NARROW: f32 = 1280.0;
const VERDICT: f32 = 90.0;
/// In one that is narrower yet a verdict that no photo has does not stand in words.
const NARROWEST: f32 = 1160.0;
/// What a separator takes of a row beside the gap behind it, points: egui's own.
const SEPARATOR: f32 = 6.0;
/// Widths are rounded to whole pixels; so much is left for that.
const ROUNDING: f32 = 1.0;

/// Draws the tool bar.
pub fn tool_bar(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let verdicts = verdicts(state);
    let more = verdicts.len().saturating_sub(USUAL.len()) as f32;
    let width = ui.available_width() - more * VERDICT;
    let is_narrow = width < NARROW;
    ui.horizontal_wrapped(|ui| {
        pages(state, ui, commands);
        ui.separator();
        if state.page == Page::SizeDistributions {
            for (action, text) in [
                (actions::file::ADD_DISTRIBUTIONS, "Add…"),
                (actions::file::PASTE_TABLE, "Paste…"),
                (actions::file::ADD_KNOWN, "Known fragments"),
                (actions::edit::UNDO, "⟲"),
                (actions::edit::REDO, "⟳"),
                (actions::file::SAVE_FIGURE, "Save figure…"),
                (actions::file::SAVE_REPORT, "Save report…"),
                (actions::file::SAVE_TABLE, "Save table…"),
            ] {
                action_button(state, action, text, ui, commands);
            }
            return;
        }
        for (action, text) in [
            (actions::file::OPEN, "Open"),
            (actions::file::SAVE, "Save flight"),
            (actions::edit::UNDO, "⟲"),
            (actions::edit::REDO, "⟳"),
        ] {
            action_button(state, action, text, ui, commands);
        }
        ui.separator();
        // Export stays in the first row of a window that is not wide.
        let words = match is_narrow {
            true => "px per",
            false => "Scales in px per",
        };
        // Not half of it at the end of a row.
        ui.add(egui::Label::new(names::unbroken(words)).extend());
        for unit in UNITS {
            let chosen = state.preferences.unit() == unit;
            let button = ui.selectable_label(chosen, unit.symbol());
            let button = button.on_hover_text(what_is_in(state, unit));
            button.widget_info(|| {
                let label = format!("Pixels per {unit}");
                egui::WidgetInfo::selected(egui::Role::RadioButton, true, chosen, label)
            });
            if button.clicked() {
                commands.push(Command::Unit(unit));
            }
        }
        ui.separator();
        let Some(open) = &state.open else {
            return;
        };
        let chosen = open.chosen_count();
        let export = format!("Export {chosen}");
        for (text, verdict, shown) in counts(state, &verdicts, width >= NARROWEST, &export, ui) {
            let (_, color) = verdict_of_now(state, verdict, ui.visuals());
            let text = egui::RichText::new(text).color(color);
            let button = ui.selectable_label(shown, text);
            let hover = format!("Show only the photos with the verdict \"{verdict}\"");
            let button = button.on_hover_text(match why_pending(state, verdict) {
                Some(why) => format!("{hover}\n{why}"),
                None => hover,
            });
            button.widget_info(|| {
                let label = format!("Only photos: {verdict}");
                egui::WidgetInfo::selected(egui::Role::Button, true, shown, label)
            });
            if button.clicked() {
                commands.push(Command::FilterVerdict((!shown).then_some(verdict)));
            }
        }
        ui.separator();
        let export = egui::Button::new(egui::RichText::new(export).strong());
        let export = ui.add_enabled(chosen > 0, export);
        export.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, chosen > 0, "Export chosen photos")
        });
        let export = match why_pending(state, Verdict::Trust) {
            Some(why) => export.on_hover_text(format!("{}\n{why}", actions::file::EXPORT.hover)),
            None => export.on_hover_text(actions::file::EXPORT.hover),
        };
        if export.on_disabled_hover_text(why_no_export(open)).clicked() {
            commands.extend((actions::file::EXPORT.command)(state));
        }
    });
}

/// What a unit of the bar is for: scales alone, as lengths on the pile are in the unit of its coordinates.
fn what_is_in(state: &State, unit: LengthUnit) -> String {
    let scales = format!("Show and export scales in pixels per {unit}");
    match &state.open {
        Some(open) => {
            let lengths = open.flight().parts().unit_of_lengths();
            format!("{scales}. Lengths and coordinates of the pile stay in {lengths}")
        }
        None => scales,
    }
}

/// Verdicts that stand in the bar with 0, too.
const USUAL: [Verdict; 3] = [Verdict::Trust, Verdict::Check, Verdict::NoScale];

/// Those that stand in the bar, how many photos have each, and whether the table shows these alone.
fn verdicts(state: &State) -> Vec<(Verdict, usize, bool)> {
    let of = |open: &OpenFlight| {
        let counted = Verdict::ALL.into_iter().map(|verdict| {
            let shown = open.table.order.verdict == Some(verdict);
            (verdict, open.table.counts.of(verdict), shown)
        });
        let is_there = |(verdict, count, shown): &(Verdict, usize, bool)| {
            *count > 0 || *shown || USUAL.contains(verdict)
        };
        counted.filter(is_there).collect()
    };
    state.open.as_deref().map(of).unwrap_or_default()
}

/// The texts of the counts, with their verdicts and whether the table shows these alone: so much that the button for the
/// export stays in this row, and a further count moves nothing that lies under the bar. What has no room for whole words says
/// less: first a verdict that no photo has does not stand, then sign and number stand alone.
fn counts(
    state: &State,
    verdicts: &[(Verdict, usize, bool)],
    is_wide: bool,
    export: &str,
    ui: &egui::Ui,
) -> Vec<(String, Verdict, bool)> {
    let texts = |in_words: bool, with_none: bool| {
        let stands = verdicts
            .iter()
            .filter(move |(_, count, shown)| with_none || *count > 0 || *shown);
        let texts = stands.map(move |&(verdict, count, shown)| {
            let (sign, _) = verdict_of_now(state, verdict, ui.visuals());
            let text = match in_words {
                true => format!("{sign} {count} {verdict}"),
                false => format!("{sign} {count}"),
            };
            (text, verdict, shown)
        });
        texts.collect::<Vec<_>>()
    };
    let spacing = ui.spacing();
    let gap = spacing.item_spacing.x;
    let beside_text = 2.0 * spacing.button_padding.x + ROUNDING;
    let button = |text: &str| text_width(ui, text) + beside_text;
    let room = ui.available_size_before_wrap().x - SEPARATOR - gap - button(export);
    let fits = |texts: &[(String, Verdict, bool)]| {
        let widths = texts.iter().map(|(text, ..)| button(text) + gap);
        widths.sum::<f32>() <= room
    };
    let shorter = [
        (true, is_wide),
        (true, false),
        (false, true),
        (false, false),
    ];
    let mut shorter = shorter.map(|(in_words, with_none)| texts(in_words, with_none));
    let fitting = shorter.iter().position(|texts| fits(texts));
    // A second row, which is needed then, has room for the words.
    std::mem::take(&mut shorter[fitting.unwrap_or(1)])
}

/// Why nothing can be exported now.
fn why_no_export(open: &OpenFlight) -> &'static str {
    if open.review.count() == 0 {
        "There are no photos yet: add the cameras of this cloud"
    } else if !open.review.is_looked_at() || !open.is_computed() {
        "Scales, footprints and scale fields are still being computed"
    } else if !open.flight().parts().unit_known {
        "No photo goes along: the model's unit is not known. Georeference it, or set its unit under Flight"
    } else {
        "No photo goes along: none is without doubt, or all were left out. Accept a photo beside its \
         reasons, or tick its box in the table"
    }
}

/// The switch between the flight and the size distributions.
fn pages(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    for (page, name, action) in [
        (Page::Pile, "Pile", actions::view::PILE),
        (Page::Map, "Map", actions::view::MAP),
        (Page::Plan, "Plan", actions::view::PLAN),
        (Page::Fragments, "Fragments", actions::view::FRAGMENTS),
        (
            Page::SizeDistributions,
            "Size distributions",
            actions::view::SIZE_DISTRIBUTIONS,
        ),
    ] {
        // Without a flight there is no map and nothing to plan over.
        if matches!(page, Page::Map | Page::Plan | Page::Fragments) && state.open.is_none() {
            continue;
        }
        let chosen = state.page == page;
        let button = ui
            .selectable_label(chosen, name)
            .on_hover_text(action.hover);
        button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, chosen, name));
        if button.clicked() {
            commands.push(Command::Page(page));
        }
    }
}

/// A button for an action, grey where it makes no sense.
pub(super) fn action_button(
    state: &State,
    action: actions::Action,
    text: &str,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let command = (action.command)(state);
    let button = ui.add_enabled(command.is_some(), egui::Button::new(text));
    let button = button.on_hover_text(action.hover);
    button.widget_info(|| {
        let label = label(text, action);
        egui::WidgetInfo::labeled(egui::Role::Button, command.is_some(), label)
    });
    if button.clicked() {
        commands.extend(command);
    }
}

/// Signs have names for those who do not see them.
fn label(text: &str, action: actions::Action) -> &str {
    let sign = text.chars().all(|c| !c.is_alphabetic());
    if sign { action.label } else { text }
}
