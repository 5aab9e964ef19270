//! What the engineer decides of the selected photo, with her note.

use crate::command::{Command, Tab};
use crate::flight::{DecisionKind, PhotoReview};
use crate::open_flight::OpenFlight;
use crate::panels::field::note::NoteField;
use crate::reviewing::note_field;

/// Draws the decision, the note, and what can be decided.
pub(super) fn decision(
    open: &OpenFlight,
    photo: usize,
    reviewed: PhotoReview<'_>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    if let Some(decision) = reviewed.decision {
        ui.add(egui::Label::new(egui::RichText::new(decision.to_string()).italics()).wrap());
    }
    let since = reviewed.reasons_since_accepted();
    if !since.is_empty() {
        let kinds = match since.len() {
            1 => "1 reason for doubt has".to_owned(),
            count => format!("{count} reasons for doubt have"),
        };
        let text = format!(
            "⚠ It was accepted for other reasons: {kinds} come since. It does not go along until you accept it again."
        );
        let text = egui::RichText::new(text).color(ui.visuals().warn_fg_color);
        ui.add(egui::Label::new(text).wrap());
    }
    let decided = reviewed.decision.map(|decision| decision.kind);
    let field = NoteField {
        id: note_field(Tab::Photo),
        label: "Note on the photo",
        hint: "Note: why",
        enter: None,
    };
    let note = field.show(open, photo, ui, commands);
    if decided.is_none() && !note.is_empty() {
        let text = "A note is kept with a decision: accept the photo, or leave it out.";
        let text = egui::RichText::new(text).color(ui.visuals().warn_fg_color);
        ui.add(egui::Label::new(text).wrap());
    }
    let mut decide = |kind: Option<DecisionKind>| {
        let decision = kind.map(|kind| (kind, note.clone()));
        commands.push(Command::Decide(photo, decision));
    };
    ui.horizontal_wrapped(|ui| {
        let why_not = open.why_not_accepted(&reviewed);
        let can_accept = why_not.is_none();
        let accepted = decided == Some(DecisionKind::Accepted) && since.is_empty();
        let accept = egui::Button::new("Accept").selected(accepted);
        let hover = why_not.unwrap_or(
            "Checked, accepted: it goes along into the export, with this note and today's date",
        );
        let accept = ui.add_enabled(can_accept, accept);
        accept.widget_info(|| labelled("Accept this photo", can_accept));
        let accept = accept.on_hover_text(hover).on_disabled_hover_text(hover);
        if accept.clicked() {
            decide(Some(DecisionKind::Accepted));
        }
        let left_out = decided == Some(DecisionKind::LeftOut);
        let leave_out = ui.add(egui::Button::new("Leave out").selected(left_out));
        leave_out.widget_info(|| labelled("Leave this photo out", true));
        let hover = "It does not go along into the export, whatever its verdict";
        if leave_out.on_hover_text(hover).clicked() {
            decide(Some(DecisionKind::LeftOut));
        }
        if decided.is_some() {
            let take_back = ui.button("Take back");
            take_back.widget_info(|| labelled("Take the decision back", true));
            let hover = "Decide nothing: the photo goes along if nothing speaks against it";
            if take_back.on_hover_text(hover).clicked() {
                decide(None);
            }
        }
    });
}

fn labelled(label: &str, enabled: bool) -> egui::WidgetInfo {
    egui::WidgetInfo::labeled(egui::Role::Button, enabled, label)
}
