//! Planned against flown on the page of the plan: a mission beside the flight on the screen, compared as the command
//! `flown` does, and written as it writes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{FlownMission, PlanStep, PlanTool};
use crate::command::{Command, Destination};
use crate::exports::{DrawingFormat, FlownFigure, FlownReport, flown_csv, flown_json};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::{self, FileError};
use crate::jobs::Progress;
use crate::opening::{FlightOfMission, StatedTakeOff, compare_flown};
use crate::size_distributions::Page;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Comparing a mission with the flight.
    pub const FLOWN: Self = Self::new("Planned against flown").of_flight();
}

impl State {
    /// Whether a file that was dropped is a mission, and a flight is there to compare it with: then does so. Or areas of a
    /// map on the page of the plan: then takes them.
    pub(crate) fn drop_on_flight(&mut self, paths: &[PathBuf]) -> bool {
        let ([path], Some(open)) = (paths, &self.open) else {
            return false;
        };
        match formats::detect(path) {
            Ok(formats::Kind::Mission) => {
                self.page = Page::Plan;
                self.plan_step(PlanStep::Compare(path.clone()));
                true
            }
            Err(_) if self.page == Page::Plan && formats::holds_areas(path) => {
                let tool = match open.planning.tool {
                    PlanTool::KeepOut => PlanTool::KeepOut,
                    _ => PlanTool::Area,
                };
                let text = path.display().to_string();
                self.plan_step(PlanStep::ReadAreas(tool, text));
                true
            }
            _ => false,
        }
    }

    /// Compares a mission with the flight on the screen.
    pub(super) fn compare_mission(&mut self, path: PathBuf) {
        let Some(open) = &self.open else {
            return;
        };
        let flight = open.flight().clone();
        let crs = open.files.crs.clone();
        let of_plan = open.planning.now().and_then(|now| now.take_off);
        let file = (open.files.origin.flight_file())
            .map_or_else(|| PathBuf::from(&flight.parts().name), Path::to_owned);
        let work = move |progress: &Progress| {
            let of = FlightOfMission {
                file: &file,
                flight: &flight,
                crs: crs.as_deref(),
            };
            // Nobody gave that of the plan on the screen for this mission: it stands in for none.
            let take_off = of_plan.map(StatedTakeOff::InPlaceOfNone);
            let compared = compare_flown(&[&path], of, take_off, progress)?;
            Ok::<_, FileError>(FlownMission::of(&path, compared, &flight))
        };
        self.start(Task::FLOWN, work, |state, flown| match flown {
            Ok(flown) => {
                state.mended(Task::FLOWN);
                if let Some(open) = &mut state.open {
                    open.planning.flown = Some(Arc::new(flown));
                }
            }
            Err(error) => state.say_until_mended(Task::FLOWN, &error.to_string()),
        });
    }

    /// Writes the comparison, as the name's ending says: its table (CSV or JSON), its figure, or both as a page.
    pub(super) fn save_flown(&mut self, to: Destination) {
        self.asking = None;
        if self.is_busy(Task::SAVE_PLAN) {
            return;
        }
        let Some(open) = &self.open else {
            return;
        };
        let Some(flown) = open.planning.flown.clone() else {
            return;
        };
        let parts = open.flight().parts();
        let report = flown.report(&parts.name, parts.unit);
        let bytes = match bytes(&flown, &report, &to.path) {
            Ok(bytes) => bytes,
            Err(fault) => {
                let error = FileError::new(&to.path, fault);
                return self.say(Severity::Error, &error.to_string());
            }
        };
        let mut read = self.read();
        read.add(&flown.file);
        let command = |to| Command::Plan(PlanStep::SaveFlown(to));
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("writing");
            let Destination { path, replace } = to;
            match files::write(&path, &bytes, Kind::Result, &read, replace) {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_PLAN, work, Self::take_written);
    }
}

fn bytes(flown: &FlownMission, report: &FlownReport<'_>, path: &Path) -> Result<Vec<u8>, Fault> {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let figure = FlownFigure {
        report,
        places: &flown.compared.places,
        is_on_map: flown.compared.is_on_map,
    };
    let failed = |error: &dyn std::fmt::Display| {
        Fault::new(format!("it cannot be written ({error})"), "free memory")
    };
    match ending.to_str() {
        Some("csv") => Ok(flown_csv(report).map_err(|error| failed(&error))?.into()),
        Some("json") => Ok(flown_json(report).map_err(|error| failed(&error))?.into()),
        Some("html" | "htm") => Ok(figure.page(&flown.warnings)?.into()),
        _ => match DrawingFormat::of(path) {
            Ok(format) => figure.bytes(format),
            Err(_) => {
                let what = "its name does not say what is to be written";
                let remedy = "let it end in .csv or .json (table), .svg, .pdf or .png (figure), or .html (both)";
                Err(Fault::new(what, remedy))
            }
        },
    }
}
