//! Where mission and table of the flight plan go.

use crate::command::{Command, Dialog};
use crate::panels::path_field::path_to_write;
use crate::planning::PlanStep;
use crate::state::State;

pub(super) fn mission(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    ui.label(
        "The name's ending says for whom: .kmz for DJI, .plan for QGroundControl, .waypoints for Mission Planner, .csv for \
         Litchi; .kml and .geojson to look at. Each battery has a file of its own.",
    );
    let drone = open.planning.now().and_then(|asked| asked.drone);
    if drone.and_then(|drone| drone.codes).is_none() {
        ui.weak("DJI's files name the drone: for .kmz choose one of DJI's as the camera.");
    }
    let start = open.files.proposed(Some("mission.kmz"));
    let browse = [("Browse…", Dialog::new_file("Save mission", "mission.kmz"))];
    if let Some(path) = path_to_write(state, ui, &start, &browse, "Write mission", commands) {
        commands.push(Command::Plan(PlanStep::SaveMission(path.into())));
    }
}

/// What is written of a plan beside its mission.
#[derive(Clone, Copy)]
pub(super) enum PlanFile {
    /// Every photo, as CSV or JSON.
    Table,
    /// A page to print.
    Sheet,
    /// A mission against the flight that came of it.
    Flown,
}

pub(super) fn plan_table(
    file: PlanFile,
    state: &State,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(open) = &state.open else {
        return;
    };
    let (what, dialog, name, write) = match file {
        PlanFile::Table => (
            "Every photo with what it will show, as 'fragscale plan' writes it: .csv, or .json.",
            Dialog::new_file("Save table", "plan.csv"),
            "plan.csv",
            "Write table",
        ),
        PlanFile::Sheet => (
            "Map, numbers, checklist and photos, to print from a browser: .html.",
            Dialog::new_file("Save page", "plan.html"),
            "plan.html",
            "Write page",
        ),
        PlanFile::Flown => (
            "Planned against flown, as 'fragscale flown' writes it: a table (.csv, .json), the figure (.svg, .pdf, .png), or \
             a page with both (.html).",
            Dialog::new_file("Save comparison", "flown.html"),
            "flown.html",
            "Write comparison",
        ),
    };
    ui.label(what);
    let start = open.files.proposed(Some(name));
    let browse = [("Browse…", dialog)];
    if let Some(path) = path_to_write(state, ui, &start, &browse, write, commands) {
        let to = path.into();
        commands.push(Command::Plan(match file {
            PlanFile::Table | PlanFile::Sheet => PlanStep::SaveTable(to),
            PlanFile::Flown => PlanStep::SaveFlown(to),
        }));
    }
}
