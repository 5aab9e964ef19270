//! The log, which keeps every warning, and the last error over the viewport.

use crate::command::{Asking, Command};
use crate::from_photos::FromPhotosStep;
use crate::names;
use crate::state::{LogLine, Severity, State};

/// Draws the log.
pub fn log_panel(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        ui.strong("Log");
        let copy = ui.button("Copy log");
        if copy.on_hover_text("Copy every line of the log").clicked() {
            let lines: Vec<&str> = state.log.iter().map(|line| line.text.as_str()).collect();
            commands.push(Command::Copy(lines.join("\n")));
        }
        if ui
            .button("Hide log")
            .on_hover_text("Close the log")
            .clicked()
        {
            commands.push(Command::ToggleLog);
        }
    });
    let height = ui.text_style_height(&egui::TextStyle::Body);
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .stick_to_bottom(true)
        .show_rows(ui, height, state.log.len(), |ui, rows| {
            for line in &state.log[rows] {
                let color = match line.severity {
                    Severity::Note => ui.visuals().text_color(),
                    Severity::Warning => ui.visuals().warn_fg_color,
                    Severity::Error => ui.visuals().error_fg_color,
                };
                let text = format!("{} {}", sign(line), line.text);
                names::styled(ui, &text, egui::TextStyle::Body, |text| text.color(color));
            }
        });
}

fn sign(line: &LogLine) -> &'static str {
    match line.severity {
        Severity::Note => "ℹ",
        Severity::Warning => "⚠",
        Severity::Error => "✖",
    }
}

/// The last error, until it is put away.
pub fn notice(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(line) = &state.notice else {
        return;
    };
    egui::Frame::new()
        .fill(ui.visuals().extreme_bg_color)
        .stroke(egui::Stroke::new(1.0, ui.visuals().error_fg_color))
        .inner_margin(8)
        .corner_radius(4)
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                let put_away = ui.button("✖");
                put_away.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, true, "Put the message away")
                });
                if put_away.on_hover_text("Put the message away").clicked() {
                    commands.push(Command::DismissNotice);
                }
                let text = egui::RichText::new(&line.text).color(ui.visuals().error_fg_color);
                ui.add(egui::Label::new(text).wrap());
            });
            // The small window that asks for a surface has it, too.
            if state.asking != Some(Asking::Add) {
                reconstruct_offer(state, ui, commands);
            }
        });
}

/// Photos that could not be opened as a flight can be reconstructed: a button for that.
pub(super) fn reconstruct_offer(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(photos) = &state.from_photos.offered else {
        return;
    };
    let button = ui.button("Reconstruct…");
    let hover =
        "Find from the photos themselves where they were taken, with a cloud of what they show";
    if button.on_hover_text(hover).clicked() {
        let step = FromPhotosStep::Ask(Some(photos.clone()));
        commands.push(Command::FromPhotos(step));
    }
}
