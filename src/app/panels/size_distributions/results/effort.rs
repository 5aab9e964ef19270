//! Time effort: the paper's Table I, from a file, and the program's own measured steps.

use super::sentence::{sentence, warning};
use crate::command::{Asking, Command};
use crate::fragmentation::{Effort, TimeSum};
use crate::panels::size_distributions::table::{Table, number};
use crate::size_distributions::{DistributionCommand, measured};
use crate::state::State;

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
            crate::names::name(ui, &file.name);
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
    let columns = 0..effort.columns().len();
    for (place, step) in effort.steps().iter().enumerate() {
        let sum = effort.of_step(place);
        let mut row = vec![step.clone()];
        let times = columns.clone().map(|column| effort.seconds(place, column));
        row.extend(times.chain([sum.known_total(), sum.average()]).map(time));
        table.row(row);
    }
    // Where both meet: the average total of a column, that of a step, the average time.
    let all = effort.of_all();
    let of_columns = |of: fn(&TimeSum) -> Option<f64>| {
        let sums = columns.clone().map(|column| effort.of_column(column));
        sums.map(move |sum| of(&sum))
    };
    let mut row = vec!["Total".to_owned()];
    row.extend(of_columns(TimeSum::known_total).map(time));
    row.extend([all.known_total(), effort.of_column_totals().average()].map(time));
    table.row(row);
    let mut row = vec!["Average".to_owned()];
    row.extend(of_columns(TimeSum::average).map(time));
    row.extend([effort.of_step_totals().average(), all.average()].map(time));
    table.row(row);
    table
}
