//! A mission beside the flight that came of it, as numbers and as lines of the picture.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;

use super::lines::{GOOD, KEEP_OUT, TROUBLED, WAY, pyramid};
use crate::camera::Camera;
use crate::exports::{FlownReport, flown_warnings};
use crate::flight::Flight;
use crate::geometry::Bounds;
use crate::opening::ComparedFlight;
use crate::plan::Drone;
use crate::render::PlannedLine;
use crate::units::LengthUnit;

/// The side of a camera, in the size of the flight.
const CAMERA: f64 = 0.025;

/// A mission beside the flight on the screen.
pub struct FlownMission {
    /// The mission's file.
    pub file: PathBuf,
    /// What came of it.
    pub compared: ComparedFlight,
    /// What is to be said beside the numbers, one sentence each.
    pub warnings: Vec<String>,
    /// As lines of the picture.
    pub(super) lines: Arc<Vec<PlannedLine>>,
}

impl FlownMission {
    /// What the exports say of it.
    pub fn report<'a>(&'a self, flight: &'a str, unit: LengthUnit) -> FlownReport<'a> {
        FlownReport {
            flight,
            unit,
            planned: &self.compared.planned,
            photos: &self.compared.photos,
            flown: &self.compared.flown,
        }
    }

    pub(super) fn of(file: &Path, compared: ComparedFlight, flight: &Flight) -> Self {
        let parts = flight.parts();
        let camera = parts.cameras.first().cloned();
        let camera = camera.unwrap_or_else(|| Drone::ALL[0].camera());
        let mut flown = Self {
            file: file.to_owned(),
            lines: Arc::new(lines(&compared, &camera)),
            compared,
            warnings: Vec::new(),
        };
        // A mission that is only looked at has no photos that could be missing.
        if !flown.compared.photos.is_empty() {
            flown.warnings = flown_warnings(&flown.report(&parts.name, parts.unit));
        }
        flown.warnings.extend(flown.compared.notes.iter().cloned());
        flown
    }
}

/// The planned and the flown path, every photo with its way from the plan, and those that were not taken.
fn lines(compared: &ComparedFlight, camera: &Camera) -> Vec<PlannedLine> {
    let planned: Vec<DVec3> = (compared.planned.iter())
        .map(|plan| plan.pose.center)
        .collect();
    let all: Vec<DVec3> = planned.iter().chain(&compared.places).copied().collect();
    let size = Bounds::of(&all).map_or(1.0, |bounds| bounds.size().length());
    let line = |points: Vec<DVec3>, color: [u8; 3], width: f64| PlannedLine {
        points,
        color,
        width,
    };
    let mut lines = vec![
        line(planned, WAY[1], 1.5),
        line(compared.places.clone(), GOOD, 1.5),
    ];
    for (plan, residual) in compared.planned.iter().zip(&compared.flown.residuals) {
        let flown = residual.and_then(|residual| compared.places.get(residual.photo));
        let color = match flown {
            Some(_) => WAY[1],
            None => KEEP_OUT,
        };
        lines.push(line(pyramid(camera, &plan.pose, CAMERA * size), color, 1.4));
        if let Some(flown) = flown {
            lines.push(line(vec![plan.pose.center, *flown], TROUBLED, 2.5));
        }
    }
    lines
}
