//! The flight's health as a strip: each thing green, or with its remedy as a button. What it says is
//! `opening::flight_health`'s.

use egui::RichText;

use crate::actions;
use crate::command::Command;
use crate::flight::Verdict;
use crate::opening::{Health, HealthFinding, HealthItem};
use crate::panels::inspector::Offer;
use crate::panels::verdict::{verdict_color, verdict_sign};
use crate::state::State;
use crate::tasks::photos::STILL_COMPARING;

/// Draws the strip.
pub fn health(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    // What is bad comes first.
    let grave = |finding: &&HealthFinding| finding.health != Health::Bad;
    let mut findings: Vec<&HealthFinding> = open.health.iter().collect();
    findings.sort_by_key(grave);
    ui.horizontal_wrapped(|ui| {
        // What mends two things is offered once.
        let mut offered = Vec::new();
        for finding in findings {
            item(state, finding, &mut offered, ui, commands);
        }
    });
}

fn item(
    state: &State,
    finding: &HealthFinding,
    offered: &mut Vec<&'static str>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let HealthFinding {
        item,
        health,
        short,
        says,
        remedy,
    } = finding;
    // As pending as holes are, and not what is known in the end.
    let has_colours = state.open.as_ref().is_some_and(|open| {
        let surface = &open.flight().parts().surface;
        !surface.colors().is_empty()
    });
    let is_unknown = *item == HealthItem::Colours && *health == Health::Unknown && has_colours;
    let (short, says) = match is_unknown && state.compares_photos() {
        true => ("…", format!("{STILL_COMPARING}.")),
        false => (short.as_str(), says.clone()),
    };
    let visuals = ui.visuals();
    let (sign, color) = match health {
        Health::Good => (
            verdict_sign(Verdict::Trust),
            verdict_color(Verdict::Trust, visuals),
        ),
        Health::Unknown => ("–", visuals.weak_text_color()),
        Health::Bad => (
            verdict_sign(Verdict::Check),
            verdict_color(Verdict::Check, visuals),
        ),
    };
    let text = RichText::new(format!("{sign} {}: {short}", item.as_str())).color(color);
    let label = ui.add(egui::Label::new(text).selectable(false).extend());
    label.widget_info(|| {
        let label = format!("{}: {says}", name(*item));
        egui::WidgetInfo::labeled(egui::Role::Status, true, label)
    });
    label.on_hover_text(says.as_str());
    let mut is_new = |label: &'static str| {
        let is_new = !offered.contains(&label);
        offered.push(label);
        is_new
    };
    if let Some(offer) = remedy.and_then(|remedy| Offer::of(state, remedy))
        && is_new(offer.name)
    {
        let button = ui.small_button(offer.name);
        button.widget_info(|| {
            let label = format!("{}: {}", name(*item), offer.name);
            egui::WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        let hover = format!("{says}\n{}", offer.hover);
        if button.on_hover_text(hover).clicked() {
            commands.push(offer.command);
        }
    }
    let is_of_place = matches!(item, HealthItem::Unit | HealthItem::CoordinateSystem);
    let action = actions::file::CONTROL_POINTS;
    if is_of_place
        && *health == Health::Bad
        && let Some(command) = (action.command)(state)
        && is_new(action.label)
    {
        let button = ui.small_button(action.label);
        button.widget_info(|| {
            let label = format!("{}: {}", name(*item), action.label);
            egui::WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        if button.on_hover_text(action.hover).clicked() {
            commands.push(command);
        }
    }
    ui.add_space(6.0);
}

fn name(item: HealthItem) -> &'static str {
    match item {
        HealthItem::Unit => "Unit",
        HealthItem::CoordinateSystem => "Coordinate system",
        HealthItem::Poses => "Poses",
        HealthItem::UpAxis => "Up axis",
        HealthItem::Colours => "Colours",
        HealthItem::Distance => "Distance",
        HealthItem::Exif => "EXIF",
        HealthItem::Holes => "Holes",
        HealthItem::Points => "Points",
        HealthItem::Photos => "Photo files",
    }
}
