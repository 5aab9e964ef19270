//! The small windows that ask which files to add and where the figure and the report go.

use std::path::{Path, PathBuf};

use crate::command::{Command, Destination, Dialog};
use crate::panels::path_field::{path_to_write, taken_path};
use crate::size_distributions::DistributionCommand;
use crate::state::State;

/// Which file to add.
pub(in crate::panels) fn add_distributions(
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.label(
        "A table of cumulative percent passing by size: CSV, with one line a point or one column a \
         curve. It can also be dropped on this window.",
    );
    let browse = [("Browse…", Dialog::file("Size distributions"))];
    if let Some(path) = taken_path(state, ui, Path::new(""), &browse, "Add file", commands) {
        commands.push(Command::Distributions(DistributionCommand::Add(vec![path])));
    }
}

/// Which file has the times of steps.
pub(in crate::panels) fn add_effort(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label(
        "A table of the time that each step took: step, time and perhaps method and trial; or a column \
         of times for each trial. Minutes, where it says nothing else.",
    );
    let browse = [("Browse…", Dialog::file("Times of steps"))];
    if let Some(path) = taken_path(state, ui, Path::new(""), &browse, "Add times", commands) {
        commands.push(Command::Distributions(DistributionCommand::AddEffort(path)));
    }
}

/// Where the figure goes.
pub(in crate::panels) fn save_figure(
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.label(
        "The figure for a report: a name that ends in .svg is drawn in lines, .png in pixels.",
    );
    let asked = ["Save figure", "size-distributions.svg", "Write figure"];
    where_to(asked, DistributionCommand::SaveFigure, state, ui, commands);
}

/// Where the report goes.
pub(in crate::panels) fn save_report(
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.label("One HTML page with the figure, all tables and how they were computed.");
    let asked = ["Save report", "size-distributions.html", "Write report"];
    where_to(asked, DistributionCommand::SaveReport, state, ui, commands);
}

/// Where the table goes.
pub(in crate::panels) fn save_table(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label("All curves with one line a point, as they were read: it can be added again, also to 'fragscale psd'.");
    let asked = ["Save table", "size-distributions.csv", "Write table"];
    where_to(asked, DistributionCommand::SaveTable, state, ui, commands);
}

/// The path of what is written: the dialog's title, the usual name, the button.
fn where_to(
    [title, usual, button]: [&'static str; 3],
    command: impl FnOnce(Destination) -> DistributionCommand,
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let browse = [("Browse…", Dialog::new_file(title, usual))];
    let start = beside(state, usual);
    if let Some(path) = path_to_write(state, ui, &start, &browse, button, commands) {
        commands.push(Command::Distributions(command(path.into())));
    }
}

/// A name beside the first file that was added. The bundled flight's folder stays as it came.
fn beside(state: &State, name: &str) -> PathBuf {
    let bundled = crate::state::bundled::sample_flight();
    let mut paths = state
        .distributions
        .sources()
        .iter()
        .filter_map(|s| s.path.as_deref());
    let first = paths.find(|path| path.parent() != bundled.as_deref());
    let path = first.map_or_else(|| PathBuf::from(name), |first| first.with_file_name(name));
    std::path::absolute(&path).unwrap_or(path)
}
