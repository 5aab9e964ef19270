//! Every reason to doubt the selected photo's scale.

use super::remedy::{Offer, remedy_button};
use crate::command::Command;
use crate::flight::PhotoReview;
use crate::names::unbroken;
use crate::panels::verdict::verdict_color;
use crate::state::State;

/// Draws the reasons.
pub(super) fn reasons(
    state: &State,
    reviewed: PhotoReview<'_>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    if reviewed.doubts.is_empty() {
        ui.weak(if reviewed.is_looked_at && !state.compares_photos() {
            "No reason for doubt was found."
        } else {
            "Looking for reasons for doubt…"
        });
        return;
    }
    ui.strong("Reasons for doubt");
    let mut offered: Vec<&str> = Vec::new();
    for doubt in reviewed.doubts {
        let text = format!("• {doubt}");
        let color = verdict_color(reviewed.verdict, ui.visuals());
        let whole = egui::RichText::new(unbroken(&text)).color(color);
        let label = ui.add(egui::Label::new(whole).wrap());
        label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
        // Each once, beside the first reason that it helps against.
        let remedy = Offer::against(state, doubt);
        if let Some(remedy) = remedy.filter(|remedy| !offered.contains(&remedy.name)) {
            offered.push(remedy.name);
            remedy_button(remedy, ui, commands);
        }
    }
}
