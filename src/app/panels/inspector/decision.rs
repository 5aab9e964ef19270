//! What the engineer decides of the selected photo, with her note.

use crate::command::Command;
use crate::flight::{DecisionKind, PhotoReview};
use crate::open_flight::OpenFlight;

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
    let saved = reviewed.decision.map_or("", |decision| &decision.note);
    let id = ui.scope_id().with(("note", open.number, photo));
    // What is being typed; what undo brings back is shown where nothing is.
    let typed: Option<String> = ui.data(|data| data.get_temp(id));
    let mut note = typed.unwrap_or_else(|| saved.to_owned());
    let field = egui::TextEdit::singleline(&mut note).hint_text("Note: why");
    let field = ui.add(field.desired_width(f32::INFINITY));
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Note on the photo");
        info.current_text_value = Some(note.clone());
        info
    });
    if decided.is_none() && !note.is_empty() {
        let text = "A note is kept with a decision: accept the photo, or leave it out.";
        let text = egui::RichText::new(text).color(ui.visuals().warn_fg_color);
        ui.add(egui::Label::new(text).wrap());
    }
    let mut decide = |kind: Option<DecisionKind>, ui: &egui::Ui| {
        let decision = kind.map(|kind| (kind, note.clone()));
        commands.push(Command::Decide(photo, decision));
        ui.data_mut(|data| data.remove_temp::<String>(id));
    };
    if field.lost_focus() && note != saved && decided.is_some() && since.is_empty() {
        decide(decided, ui);
    } else if field.changed() {
        ui.data_mut(|data| data.insert_temp(id, note.clone()));
    }
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
            decide(Some(DecisionKind::Accepted), ui);
        }
        let left_out = decided == Some(DecisionKind::LeftOut);
        let leave_out = ui.add(egui::Button::new("Leave out").selected(left_out));
        leave_out.widget_info(|| labelled("Leave this photo out", true));
        let hover = "It does not go along into the export, whatever its verdict";
        if leave_out.on_hover_text(hover).clicked() {
            decide(Some(DecisionKind::LeftOut), ui);
        }
        if decided.is_some() {
            let take_back = ui.button("Take back");
            take_back.widget_info(|| labelled("Take the decision back", true));
            let hover = "Decide nothing: the photo goes along if nothing speaks against it";
            if take_back.on_hover_text(hover).clicked() {
                decide(None, ui);
            }
        }
    });
}

fn labelled(label: &str, enabled: bool) -> egui::WidgetInfo {
    egui::WidgetInfo::labeled(egui::Role::Button, enabled, label)
}
