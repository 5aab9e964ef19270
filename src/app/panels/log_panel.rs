//! The log, which keeps every warning, and the last error over the viewport.

use crate::command::{Asking, Command};
use crate::from_photos::FromPhotosStep;
use crate::names;
use crate::state::{LogLine, Severity, State};

/// So many lines of the log are laid out in a frame: what they are high is only known by breaking them. A thousand more
/// would be read by nobody in this panel.
const SHOWN: usize = 300;

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
    egui::ScrollArea::vertical()
        .auto_shrink(false)
        .stick_to_bottom(true)
        .show_viewport(ui, |ui, sight| lines(state, sight, ui));
}

/// The last lines, each in as many rows as it needs; only those in sight are drawn. `sight` counts from the top of the
/// first line.
fn lines(state: &State, sight: egui::Rect, ui: &mut egui::Ui) {
    let first = ui.max_rect().top();
    let (earlier, shown) = state.log.split_at(state.log.len().saturating_sub(SHOWN));
    if !earlier.is_empty() {
        let count = earlier.len();
        ui.weak(format!("{count} earlier lines: Copy log has them all"));
    }
    for line in shown {
        let text = format!("{} {}", sign(line), line.text);
        let shown = egui::RichText::new(names::unbroken(&text)).color(color(line, ui.visuals()));
        // egui remembers how it broke it.
        let mode = Some(egui::TextWrapMode::Wrap);
        let shown = egui::WidgetText::from(shown);
        let shown = shown.into_galley(ui, mode, ui.available_width(), egui::TextStyle::Body);
        let top = ui.cursor().top() - first;
        if top > sight.bottom() || top + shown.size().y < sight.top() {
            ui.allocate_space(shown.size());
            continue;
        }
        let label = ui.add(egui::Label::new(shown).selectable(false));
        label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    }
}

fn color(line: &LogLine, visuals: &egui::Visuals) -> egui::Color32 {
    match line.severity {
        Severity::Note => visuals.text_color(),
        Severity::Warning => visuals.warn_fg_color,
        Severity::Error => visuals.error_fg_color,
    }
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
