//! The foot of the window: what is being done, where the mouse points, the last line of the log.

use crate::actions;
use crate::command::Command;
use crate::names;
use crate::open_flight::Measure;
use crate::size_distributions::Page;
use crate::state::State;

/// How long the bar of a job is, points.
const BAR: f32 = 90.0;

/// What a job has beside its words and its bar: gaps, the button that cancels it, a line.
const BESIDE_BAR: f32 = 60.0;

/// What is left for the log's button, and for the count of jobs that have no room.
const LOG: f32 = 150.0;

/// Draws the status bar.
pub fn status_bar(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        // On the other pages the mouse points at something else.
        if let Some(open) = state.open.as_ref().filter(|_| state.page == Page::Pile) {
            let unit = open.flight().parts().unit_of_lengths();
            if let Some(point) = open.pointer.hover {
                let text = format!(
                    "x {:.3}  y {:.3}  z {:.3} {unit}",
                    point.x, point.y, point.z
                );
                let label = ui.label(text.clone());
                let label = label.on_hover_text("Where the mouse points on the surface");
                label.context_menu(|ui| {
                    if ui.button("Copy coordinates").clicked() {
                        commands.push(Command::Copy(format!(
                            "{}\t{}\t{}",
                            point.x, point.y, point.z
                        )));
                        ui.close();
                    }
                });
                ui.separator();
            }
            match open.pointer.measure {
                Measure::Off => {}
                Measure::First => {
                    ui.label("Distance: click the first point");
                    ui.separator();
                }
                measure @ (Measure::Second(_) | Measure::Both(..)) => {
                    if let [a, b] = measure.points(open.pointer.hover)[..] {
                        let way = b - a;
                        let text = format!(
                            "Distance {:.3} {unit} (level {:.3}, up {:.3})",
                            way.length(),
                            way.truncate().length(),
                            way.z
                        );
                        let hover =
                            "Ctrl+C copies all three with all digits once both points are clicked";
                        ui.label(text).on_hover_text(hover);
                    } else {
                        ui.label("Distance: click the second point");
                    }
                    ui.separator();
                }
            }
        }
        jobs(state, ui, commands);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let text = match state.warnings().count() {
                0 => "Log".to_owned(),
                1 => "Log: 1 warning".to_owned(),
                many => format!("Log: {many} warnings"),
            };
            let button = ui.selectable_label(state.preferences.log_open, text);
            button.widget_info(|| {
                let open = state.preferences.log_open;
                egui::WidgetInfo::selected(egui::Role::Button, true, open, "Show log")
            });
            if button.on_hover_text(actions::view::LOG.hover).clicked() {
                commands.push(Command::ToggleLog);
            }
            if let Some(line) = state.last_said() {
                names::name(ui, &line.text);
            }
        });
    });
}

/// The jobs under way, each with how far it is; those that have no room are counted.
fn jobs(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let running: Vec<_> = state.work.running().collect();
    for (place, (task, (sentence, fraction))) in running.iter().enumerate() {
        let wide = super::rows::text_width(ui, task.in_words) + BAR + BESIDE_BAR;
        let room = ui.available_width() - LOG;
        if wide > room {
            let left = &running[place..];
            let words: Vec<&str> = left.iter().map(|(task, _)| task.in_words).collect();
            let count = format!("+{}", left.len());
            ui.add(egui::Label::new(count).extend())
                .on_hover_text(format!("Also under way: {}", words.join(", ")));
            return;
        }
        ui.label(task.in_words);
        let bar = egui::ProgressBar::new(*fraction as f32);
        ui.add(bar.desired_width(BAR).desired_height(14.0))
            .on_hover_text(sentence);
        if task.can_be_cancelled {
            let cancel = ui.small_button("✖");
            let label = format!("Cancel {}", task.in_words.to_lowercase());
            cancel.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if cancel.on_hover_text(&label).clicked() {
                commands.push(Command::Cancel(*task));
            }
        }
        ui.separator();
    }
}
