//! Time effort: the paper's Table I, from a file, and the program's own measured steps.

use super::results::{sentence, warning};
use super::table::{Table, number};
use crate::app::command::{Asking, Command};
use crate::app::size_distributions::{DistributionCommand, measured};
use crate::app::state::State;
use crate::fragmentation::{Effort, TimeSum};

/// Draws the tables.
pub(super) fn effort(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let distributions = &state.distributions;
    ui.horizontal(|ui| {
        let add = ui.button("Add times…");
        let hover = "A table of the time that each step took; it can also be dropped while this tab is \
                     shown";
        if add.on_hover_text(hover).clicked() {
            commands.push(Command::Ask(Some(Asking::AddEffort)));
        }
        if let Some(file) = &distributions.effort {
            let remove = ui.small_button("✖");
            let label = format!("Remove {}", file.name);
            remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if remove.on_hover_text(&label).clicked() {
                let command = DistributionCommand::RemoveEffort;
                commands.push(Command::Distributions(command));
            }
            ui.label(&file.name);
        }
    });
    if let Some(file) = &distributions.effort {
        for text in &file.warnings {
            warning(text, ui);
        }
        table(&format!("Time effort: {}", file.name), &file.effort).show(ui, commands);
    }
    match measured::effort(&distributions.measured) {
        Ok(effort) if effort.of_all().known > 0 => {
            table("Measured by this program", &effort).show(ui, commands);
            sentence(
                "What this window took by itself, the last time each; the engineer's own time is not \
                 in it.",
                ui,
            );
        }
        Ok(_) => sentence(
            "Open a flight, and how long opening, computing and exporting take stands here.",
            ui,
        ),
        Err(fault) => warning(&fault.to_string(), ui),
    }
}

/// Steps by trials, with totals and averages.
fn table(name: &str, effort: &Effort) -> Table {
    // Seconds for what a program does, minutes for what people do.
    let minutes = effort.of_all().total >= 600.0;
    let unit = if minutes { "min" } else { "s" };
    let time =
        |seconds: Option<f64>| number(seconds.map(|s| if minutes { s / 60.0 } else { s }), 3);
    let mut table = Table::new(format!("{name}, {unit}"));
    table.column("Step", "");
    for column in effort.columns() {
        let column = if column.is_empty() { "time" } else { column };
        table.column(column, "");
    }
    table.column("Total", "Of the times that are known");
    table.column("Average", "Of the times that are known");
    let row = |name: &str, times: Vec<Option<f64>>, sum: TimeSum| {
        let mut row = vec![name.to_owned()];
        row.extend(times.into_iter().map(time));
        row.push(time((sum.known > 0).then_some(sum.total)));
        row.push(time(sum.average()));
        row
    };
    let columns = effort.columns().len();
    for (place, step) in effort.steps().iter().enumerate() {
        let times = (0..columns).map(|column| effort.seconds(place, column));
        table.row(row(step, times.collect(), effort.of_step(place)));
    }
    let totals = (0..columns).map(|column| {
        let sum = effort.of_column(column);
        (sum.known > 0).then_some(sum.total)
    });
    table.row(row("Total", totals.collect(), effort.of_all()));
    table
}
