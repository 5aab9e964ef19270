//! A mission of any ground station against the flight that came of it: what the command `flown` and the window say.

use std::path::Path;

use fragscale_core::plan::{Flown, PlannedPose, Taken, ground_at, planned_poses};
use glam::{DVec2, DVec3};

use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::Flight;
use crate::formats::{MissionFile, read_mission};
use crate::geodesy::{Crs, CrsKind};
use crate::jobs::Progress;

/// The flight that came of a mission.
#[derive(Debug, Clone, Copy)]
pub struct FlightOfMission<'a> {
    /// Which file it is, for what is wrong with it.
    pub file: &'a Path,
    /// The flight.
    pub flight: &'a Flight,
    /// The coordinate system of its places, where it is known.
    pub crs: Option<&'a str>,
}

/// A mission beside the flight that came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedFlight {
    /// Its photos as they were planned.
    pub planned: Vec<PlannedPose>,
    /// How far each was from its plan.
    pub flown: Flown,
    /// The names of the photos that were taken.
    pub photos: Vec<String>,
    /// Where each of them was taken.
    pub places: Vec<DVec3>,
    /// Whether y of the world is the north of a map.
    pub is_on_map: bool,
    /// What the mission's file says and nobody reads, one sentence each.
    pub notes: Vec<String>,
}

/// Compares a mission with a flight. `take_off` is where the drone took off in the world, where the mission does not say
/// it, or was not followed.
///
/// # Errors
/// With the mission's file: where it cannot be read, has no photos, or says less than a pose. With the flight's: where its
/// coordinate system is not known, or its surface cannot be triangulated. Where the work was cancelled.
pub fn compare_flown(
    mission: &Path,
    of: FlightOfMission<'_>,
    take_off: Option<DVec2>,
    progress: &Progress,
) -> Result<ComparedFlight, FileError> {
    let MissionFile {
        mission: told,
        notes,
        ..
    } = read_mission(mission)?;
    let in_mission = |fault: Fault| FileError::new(mission, fault);
    let in_flight = |fault: Fault| FileError::new(of.file, fault);
    let crs = of.crs.ok_or_else(|| {
        let what = "nobody says in which coordinate system its places are";
        in_flight(Fault::new(what, "say it in flight.toml (world.crs)"))
    })?;
    let crs = Crs::understand(crs).map_err(in_flight)?;
    let parts = of.flight.parts();
    let ground = |place| ground_at(&parts.surface, place);
    let planned = planned_poses(&told, &crs, take_off, ground).map_err(in_mission)?;
    if planned.is_empty() {
        let what = "it has no photos to compare with";
        return Err(in_mission(Fault::new(
            what,
            "give the mission of this flight",
        )));
    }
    let taken: Vec<Taken<'_>> = (parts.photos.iter())
        .map(|photo| Taken {
            name: &photo.name,
            pose: &photo.pose,
            camera: of.flight.camera(photo),
        })
        .collect();
    progress.stage("planned against flown");
    let flown = Flown::compare(&planned, &taken, &parts.surface, progress).map_err(in_flight)?;
    Ok(ComparedFlight {
        photos: parts
            .photos
            .iter()
            .map(|photo| photo.name.clone())
            .collect(),
        places: taken.iter().map(|taken| taken.pose.center).collect(),
        is_on_map: crs.kind() == CrsKind::Projected,
        planned,
        flown,
        notes,
    })
}
