//! A mission of any ground station against the flight that came of it: what the command `flown` and the window say.

use std::path::Path;

use fragscale_core::plan::{Flown, PlannedPose, Taken, ground_at, planned_poses};
use glam::{DVec2, DVec3};

use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::Flight;
use crate::formats::{MissionFile, read_mission};
use crate::geodesy::{Crs, CrsKind, geoid_height};
use crate::geometry::median_with_deviation;
use crate::jobs::Progress;
use crate::units::LengthUnit;

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

/// Compares missions with the flight that came of them: one, or one of each battery in their order. `take_off` is where the drone took off in the world, where the mission does not say
/// it, or was not followed.
///
/// # Errors
/// With the mission's file: where it cannot be read, has no photos, or says less than a pose. With the flight's: where its
/// coordinate system is not known, or its surface cannot be triangulated. Where the work was cancelled.
pub fn compare_flown(
    missions: &[impl AsRef<Path>],
    of: FlightOfMission<'_>,
    take_off: Option<DVec2>,
    progress: &Progress,
) -> Result<ComparedFlight, FileError> {
    let in_flight = |fault: Fault| FileError::new(of.file, fault);
    let crs = of.crs.ok_or_else(|| {
        let what = "nobody says in which coordinate system its places are";
        in_flight(Fault::new(what, "say it in flight.toml (world.crs)"))
    })?;
    let crs = Crs::understand(crs).map_err(in_flight)?;
    let parts = of.flight.parts();
    let ground = |place| ground_at(&parts.surface, place);
    let (mut planned, mut notes) = (Vec::new(), Vec::new());
    for mission in missions {
        let mission = mission.as_ref();
        let in_mission = |fault: Fault| FileError::new(mission, fault);
        let MissionFile {
            mission: told,
            notes: own,
            ..
        } = read_mission(mission)?;
        let poses = planned_poses(&told, &crs, take_off, ground).map_err(in_mission)?;
        if poses.is_empty() {
            let what = "it has no photos to compare with";
            let remedy = "give the mission of this flight";
            return Err(in_mission(Fault::new(what, remedy)));
        }
        planned.extend(poses);
        notes.extend(own);
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
    notes.extend(heights_off(&planned, &flown, &crs, parts.unit));
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

/// Photos that are higher or lower than their plans by less, metres, may be so by the drone's own heights.
const HEIGHT_OFF: f64 = 5.0;
/// As many times as far as they are from each other: they are off alike.
const ALIKE: f64 = 5.0;
/// Within so many metres of the geoid's height above the ellipsoid it may be that, where that is twice as much.
const OF_GEOID: f64 = 3.0;

/// That all photos are higher or lower than their plans by the same, in a sentence: heights that count from two datums, or a
/// take-off elsewhere.
fn heights_off(
    planned: &[PlannedPose],
    flown: &Flown,
    crs: &Crs,
    unit: LengthUnit,
) -> Option<String> {
    let residuals = flown.residuals.iter().flatten();
    let mut heights: Vec<f64> = residuals.map(|own| own.offset.z * unit.metres()).collect();
    let [middle, apart] = median_with_deviation(&mut heights)?;
    if heights.len() < 3 || middle.abs() < HEIGHT_OFF.max(ALIKE * apart) {
        return None;
    }
    let place = crs.to_geographic(planned.first()?.pose.center)?;
    let geoid = geoid_height(place.latitude, place.longitude);
    let higher = if middle > 0.0 { "higher" } else { "lower" };
    // Where both lie near each other a drone's own heights are as much off.
    let may_be = geoid.abs() > 2.0 * OF_GEOID && (middle.abs() - geoid.abs()).abs() < OF_GEOID;
    let why = match may_be {
        true => format!(
            "it may have taken off elsewhere, or heights count from two datums: the geoid lies {:.1} m off the ellipsoid there; look from what those of photos and surface count",
            geoid.abs()
        ),
        false => "look whether it took off where the mission says, and whether the heights of photos and surface count from the same".to_owned(),
    };
    Some(format!(
        "all photos are {:.1} m {higher} than planned: {why}",
        middle.abs()
    ))
}

#[cfg(test)]
mod tests {
    use fragscale_core::plan::Residual;

    use super::*;
    use crate::camera::Pose;

    /// What is said of three photos over a place east of 300 km that are so much higher than planned.
    fn said(east: f64, higher: f64) -> String {
        let center = DVec3::new(east, 6_600_000.0, 100.0);
        let planned = PlannedPose {
            name: String::new(),
            pose: Pose::from_tilt_pan(center, [90.0, 0.0]),
        };
        let residual = Residual {
            photo: 0,
            offset: DVec3::new(0.0, 0.0, higher),
            tilt: 0.0,
            pan: 0.0,
            turn: 0.0,
            shared: None,
        };
        let flown = Flown {
            residuals: vec![Some(residual); 3],
            unplanned: Vec::new(),
        };
        let crs = Crs::understand("EPSG:32753").unwrap();
        heights_off(&[planned], &flown, &crs, LengthUnit::Metre).unwrap()
    }

    /// In South Australia the geoid crosses the ellipsoid: where both are nearly one, a take-off that is 5 m off is not laid to them.
    #[test]
    fn a_geoid_that_lies_near_the_ellipsoid_is_no_cause() {
        let crs = Crs::understand("EPSG:32753").unwrap();
        let geoid = |east: f64| {
            let place = crs.to_geographic(DVec3::new(east, 6_600_000.0, 0.0));
            place.map(|place| geoid_height(place.latitude, place.longitude))
        };
        let east = |least: f64, most: f64| {
            let places = (0..600).map(|at| 200_000.0 + 1000.0 * f64::from(at));
            let mut near = places.filter(|east| {
                geoid(*east).is_some_and(|height| (least..most).contains(&height.abs()))
            });
            near.next().unwrap()
        };
        let near = said(east(3.0, 5.9), 5.2);
        assert!(!near.contains("geoid"), "{near}");
        let off = east(7.0, 12.0);
        let far = said(off, geoid(off).unwrap().abs());
        assert!(far.contains("geoid") && far.contains("may"), "{far}");
    }
}
