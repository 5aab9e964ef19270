//! What is computed of the flight on the screen: scales, footprints, the viewport's geometry.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::work::Task;
use crate::fault::Fault;
use crate::flight::{Flight, FlightSettings, LookedUp, Outcome};
use crate::jobs::Progress;
use crate::opening;
use crate::render::{Shapes, SurfaceBuffers};
use crate::state::{Severity, State};

impl Task {
    /// Computing scales anew after a setting changed.
    pub const SCALES: Self = Self::new("Scales").of_flight();
    /// Draping footprints.
    pub const VIEWS: Self = Self::new("Footprints").of_flight().to_the_end();
    /// Computing scale fields: best lines, and how sure scales are.
    pub const FIELDS: Self = Self::new("Scale fields").of_flight().to_the_end();
    /// Triangles and points for the viewport.
    pub const GEOMETRY: Self = Self::new("Surface").of_flight().to_the_end();
}

/// Scales after a setting changed, with the settings.
struct Scales {
    flight: Arc<Flight>,
    outcomes: Vec<Outcome>,
    looked_up: LookedUp,
    settings: FlightSettings,
    took: Duration,
}

impl State {
    /// Computes scales, and then footprints and scale fields, with the settings of now.
    pub fn start_scales(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, settings) = (open.flight().clone(), open.settings());
        let files = open.files.photo_files.clone();
        // Footprints under way go on: where these scales are cancelled, they are still wanted.
        let work = move |progress: &Progress| {
            let begun = Instant::now();
            let flight = flight.with_settings(&settings)?;
            let outcomes = flight.scales(progress)?;
            // Heights and laser ranges are held against the unit of now.
            let looked_up = opening::look_up(&flight, &files);
            Ok(Scales {
                flight: Arc::new(flight),
                outcomes,
                looked_up,
                settings,
                took: begun.elapsed(),
            })
        };
        self.start(Task::SCALES, work, Self::take_scales);
    }

    /// Drapes the footprints of the flight as it is computed.
    pub fn start_views(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, outcomes) = (open.flight().clone(), open.review.outcomes().clone());
        let work = move |progress: &Progress| flight.views(&outcomes, progress);
        self.start(Task::VIEWS, work, |state, views| match views {
            Ok(views) => {
                if let Some(open) = &mut state.open {
                    open.take_views(views);
                }
            }
            Err(fault) => state.say(Severity::Error, &fault.to_string()),
        });
    }

    /// Computes the scale fields of the flight as it is computed.
    pub fn start_fields(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (flight, outcomes) = (open.flight().clone(), open.review.outcomes().clone());
        let work = move |progress: &Progress| flight.fields(&outcomes, progress);
        self.start(Task::FIELDS, work, |state, fields| match fields {
            Ok(fields) => {
                if let Some(open) = &mut state.open {
                    open.take_fields(fields);
                }
                // On their rows they are held against the lines.
                state.start_comparing();
            }
            Err(fault) => state.say(Severity::Error, &fault.to_string()),
        });
    }

    /// Has the flight say what the settings of now state of it, and computes the scale fields anew where
    /// they depend on it.
    pub(crate) fn take_stated(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        let (pair, errors) = (open.flight().parts().pair, open.flight().parts().errors);
        open.take_stated();
        let now = open.flight().parts();
        let (is_other_pair, is_other_error) = (now.pair != pair, now.errors != errors);
        if is_other_error {
            self.start_fields();
        }
        if is_other_pair {
            self.start_comparing();
        }
    }

    /// Makes ready what the viewport draws of the surface.
    pub fn start_geometry(&mut self) {
        let (Some(open), Some(gpu)) = (&self.open, self.gpu.clone()) else {
            return;
        };
        let (flight, frame) = (open.flight().clone(), open.extent.frame);
        let work = move |progress: &Progress| {
            let surface = &flight.parts().surface;
            SurfaceBuffers::new(&gpu, &frame, surface, Shapes::BOTH, progress)
        };
        self.start(Task::GEOMETRY, work, |state, geometry| {
            match (geometry, &mut state.open) {
                (Ok(geometry), Some(open)) => open.geometry = Some(Arc::new(geometry)),
                (Ok(_), None) => {}
                (Err(fault), _) => state.say(Severity::Error, &fault.to_string()),
            }
        });
    }

    fn take_scales(&mut self, scales: Result<Scales, Fault>) {
        let Scales {
            flight,
            outcomes,
            looked_up,
            settings,
            took,
        } = match scales {
            Ok(scales) => scales,
            Err(fault) => {
                self.say(Severity::Error, &fault.to_string());
                self.take_back_settings();
                return;
            }
        };
        self.note_step("Computing scales", &flight.parts().name, took);
        // Whatever was wrong with the settings is not any more.
        self.notice = None;
        let Some(open) = &mut self.open else {
            return;
        };
        let before = open.flight().parts();
        let after = flight.parts();
        let other_image = before.image != after.image;
        let unit = after.unit.in_units_of(before.unit);
        // Of one reading of the file the points are the same.
        let other_surface = before.surface.max_edge() != after.surface.max_edge();
        let said_before = &open.review.looked_up().warnings;
        let said = looked_up.warnings_of(open.files.path.display());
        let new: Vec<String> = said
            .zip(&looked_up.warnings)
            .filter(|(_, bare)| !said_before.contains(bare))
            .map(|(warning, _)| warning)
            .collect();
        open.take_scales(flight, outcomes, looked_up, settings);
        if unit != 1.0 {
            open.planning.take_unit(unit);
            self.work.cancel(Task::PLAN);
        }
        for warning in new {
            self.say(Severity::Warning, &warning);
        }
        if other_surface {
            // What was planned and measured over the surface of before says nothing of this one.
            if let Some(open) = &mut self.open {
                open.planning.over_another_surface();
                open.fragments = std::mem::take(&mut open.fragments).of_another_surface();
            }
            for task in [
                Task::PLAN,
                Task::FLOWN,
                Task::MEASURE_FRAGMENTS,
                Task::MEASURE_ALL,
            ] {
                self.work.cancel(task);
            }
            self.measure_fragments();
            self.start_geometry();
            self.start_picker();
        }
        if other_image {
            self.load_full_photo_anew();
            self.load_preview();
            self.start_thumbnails();
        }
        if let Some(open) = &mut self.open {
            // Stated otherwise while these scales were computed.
            open.take_stated();
        }
        self.start_views();
        self.start_fields();
        self.start_comparing();
        self.load_tint_anew();
        self.load_corners();
    }

    /// Where neither scales nor the file are on their way any more, a change of the settings that
    /// was not computed goes.
    pub(crate) fn take_back_settings(&mut self) {
        let on_the_way = self.work.is_running(Task::SCALES) || self.work.is_running(Task::OPEN);
        if let Some(open) = &mut self.open
            && !on_the_way
        {
            open.take_back_settings();
        }
    }
}
