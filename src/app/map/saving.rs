//! The plan as a file: what the command `map` writes.

use super::making::pixels_of;
use crate::command::{Command, Destination};
use crate::exports::{MeasuredOutline, Plan, PlanFormat, PlanRequest, taken_in_words};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::map::MapCommand;
use crate::open_flight::survey::SurveyTool;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Writing the map.
    pub const SAVE_MAP: Self = Self::new("Writing the map").writing();
}

impl State {
    /// Writes the map; asks before a file is replaced.
    pub(super) fn save_map(&mut self, to: Destination, pixel: Option<f64>) {
        self.asking = None;
        if self.is_busy(Task::SAVE_MAP) {
            return;
        }
        let Some(open) = &self.open else {
            return;
        };
        let format = match PlanFormat::of(&to.path) {
            Ok(format) => format,
            Err(fault) => {
                let error = FileError::new(&to.path, fault);
                self.say(Severity::Error, &error.to_string());
                return;
            }
        };
        let Some(made) = open.map.of_now() else {
            let text = "the map is still being made; write it when it is there";
            self.say(Severity::Error, text);
            return;
        };
        let times = open.pictures.times.iter().flatten();
        let taken = taken_in_words(times.map(String::as_str));
        let plan = made.plan.clone();
        let (review, files) = (open.review.clone(), open.files.photo_files.clone());
        let drawn = open.pointer.drawn.as_ref();
        let measured = drawn.filter(|drawn| drawn.points.len() > 1).map(|drawn| {
            let corners = drawn.points.iter().map(|point| point.truncate());
            MeasuredOutline {
                points: corners.collect(),
                is_polygon: drawn.tool == SurveyTool::Volume,
            }
        });
        let (read, unit) = (self.read(), self.preferences.unit());
        let command = |to| Command::Map(MapCommand::Save { to, pixel });
        if !self.may_write(&to, Kind::Result, &read, command) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("drawing and writing the map");
            let Destination { path, replace } = to;
            let finer = pixel.filter(|pixel| *pixel != plan.raster.pixel);
            let with_pixel = match finer {
                None => Ok((*plan).clone()),
                Some(_) => {
                    let request = PlanRequest {
                        pixel: finer,
                        ground: plan.ground_kind,
                        crs: plan.crs.as_deref(),
                        taken: None,
                    };
                    let pixels = |photo: usize| pixels_of(&files, photo);
                    Plan::new(&review, request, &pixels, progress)
                }
            };
            let plan = with_pixel.map(|plan| Plan {
                taken,
                measured: measured.into_iter().collect(),
                ..plan
            });
            let written: Result<(), Fault> = plan
                .and_then(|plan| format.bytes(&plan, unit))
                .and_then(|bytes| files::write(&path, &bytes, Kind::Result, &read, replace));
            match written {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_MAP, work, Self::take_written);
    }
}
