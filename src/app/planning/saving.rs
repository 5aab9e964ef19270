//! Mission and table of the plan as files: what the command `plan` writes.

use std::sync::Arc;

use super::{MadePlan, PlanStep, no_system};
use crate::command::{Command, Destination};
use crate::exports::{
    FlightSheet, MissionFormat, PlanReport, WrittenMission, flight_sheet, flights_for, plan_csv,
    plan_json, write_missions,
};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::plan::{Told, is_over_ground, missions};
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Writing a mission, or the plan's table.
    pub const SAVE_PLAN: Self = Self::new("Writing the plan").writing();
}

impl State {
    /// The plan of what is asked for now; else says why there is none.
    fn plan_to_save(&mut self) -> Option<Arc<MadePlan>> {
        self.asking = None;
        if self.is_busy(Task::SAVE_PLAN) {
            return None;
        }
        let planning = &self.open.as_ref()?.planning;
        let made = planning.made.clone().filter(|_| planning.is_of_now());
        if made.is_none() {
            let text = "the plan is still being made, or cannot be; write it when it is there";
            self.say(Severity::Error, text);
        }
        made
    }

    fn take_written_plan(&mut self, made: &MadePlan) {
        if let Some(open) = &mut self.open {
            open.planning.take_written(made);
        }
    }

    /// Writes the missions; asks before a file is replaced.
    pub(super) fn save_mission(&mut self, to: Destination) {
        let Some(made) = self.plan_to_save() else {
            return;
        };
        let Some(open) = &self.open else {
            return;
        };
        let name = open.flight().parts().name.clone();
        let asked = &made.asked;
        let told = Told {
            name,
            drone: asked.drone.and_then(|drone| drone.codes),
            unit: open.flight().parts().unit,
            speed: asked.flying.speed,
            settle: asked.flying.settle,
            by_battery: asked.flying.battery.is_some(),
        };
        let target = MissionFormat::of(&to.path)
            .and_then(|format| {
                format.check_drone(asked.drone.as_ref())?;
                Ok(format)
            })
            .and_then(|format| match &made.no_way {
                Some(why) => Err(Fault::new(why, "change the plan")),
                None if made.ways.is_empty() => {
                    let what = "nobody says where the drone takes off";
                    Err(Fault::new(what, "set the take-off"))
                }
                None => Ok(format),
            })
            .and_then(|format| {
                let crs = open.files.crs.clone().ok_or_else(no_system)?;
                is_over_ground(told.unit, &Crs::understand(&crs)?)?;
                Ok((format, crs))
            });
        let (format, crs) = match target {
            Ok(target) => target,
            Err(fault) => {
                let error = FileError::new(&to.path, fault);
                return self.say(Severity::Error, &error.to_string());
            }
        };
        let read = self.read();
        let command = |to| Command::Plan(PlanStep::SaveMission(to));
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let flown = made.clone();
        let work = move |progress: &Progress| -> Result<WrittenMission, FileError> {
            progress.stage("writing");
            let Destination { path, replace } = to;
            let at = |fault| FileError::new(&path, fault);
            let ways = (&*flown.plan, &flown.ways[..]);
            let (ways, said) = flights_for(&[format], ways, &flown.pace, &told).map_err(at)?;
            let crs = Crs::understand(&crs).map_err(at)?;
            let missions = missions(&flown.plan, &ways, &crs, &told).map_err(at)?;
            let mut written = write_missions(&missions, &path, &read, replace)?;
            written.notes.splice(0..0, said);
            Ok(written)
        };
        self.start(Task::SAVE_PLAN, work, move |state, written| match written {
            Ok(written) => {
                state.take_written_plan(&made);
                for note in &written.notes {
                    state.say(Severity::Warning, note);
                }
                for path in written.files {
                    state.take_written(Ok(path));
                }
            }
            Err(error) => state.say(Severity::Error, &error.to_string()),
        });
    }

    /// Writes the plan's table, or the page to print; asks before a file is replaced.
    pub(super) fn save_plan_table(&mut self, to: Destination) {
        let Some(made) = self.plan_to_save() else {
            return;
        };
        let Some(open) = &self.open else {
            return;
        };
        let parts = open.flight().parts();
        let report = PlanReport {
            flight: &parts.name,
            world: parts.unit,
            scales: self.preferences.unit(),
            plan: &made.plan,
            ways: &made.ways,
            pace: made.pace,
            is_nominal: made.asked.drone.is_some(),
            sun: made.sun.as_ref().map(|(sun, shadows)| (sun, shadows)),
        };
        let ending = |wanted: &str| {
            let ending = to.path.extension();
            ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
        };
        let sheet = FlightSheet {
            report: &report,
            drone: made.asked.drone.map(|drone| drone.title),
            settle: made.asked.flying.settle,
            crs: open.files.crs.as_deref(),
            warnings: &made.warnings,
        };
        let text = match () {
            () if ending("html") => flight_sheet(&sheet).map_err(|fault| fault.to_string()),
            () if ending("json") => plan_json(&report).map_err(|error| error.to_string()),
            () => plan_csv(&report).map_err(|error| error.to_string()),
        };
        let text = match text {
            Ok(text) => text,
            Err(error) => return self.say(Severity::Error, &error),
        };
        let read = self.read();
        let command = |to| Command::Plan(PlanStep::SaveTable(to));
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("writing");
            let Destination { path, replace } = to;
            match files::write(&path, text.as_bytes(), Kind::Result, &read, replace) {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_PLAN, work, move |state, written| {
            if written.is_ok() {
                state.take_written_plan(&made);
            }
            state.take_written(written);
        });
    }
}
