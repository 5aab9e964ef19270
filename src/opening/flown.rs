//! A mission of any ground station against the flight that came of it: what the command `flown` and the window say.

use std::path::Path;

use fragscale_core::plan::{Flown, Mission, PlannedPose, Taken, ground_at, planned_poses};
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
    /// What the missions' files say and nobody reads, and what speaks against the comparison, one sentence each.
    pub notes: Vec<String>,
}

/// Compares missions with the flight that came of them: one, or one of each battery in their order. `take_off` is where the drone
/// took off in the world, where the mission does not say it, or was not followed.
///
/// # Errors
/// With the mission's file: where it cannot be read, has no photos, says less than a pose, or lies kilometres from the flight or
/// from `take_off`. With the flight's: where its coordinate system is not known, or its surface cannot be triangulated. Where the
/// work was cancelled.
pub fn compare_flown(
    missions: &[impl AsRef<Path>],
    of: FlightOfMission<'_>,
    take_off: Option<StatedTakeOff>,
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
    let on_earth = |place: DVec3| {
        let place = crs.to_geographic(place)?;
        Some(DVec2::new(place.latitude, place.longitude))
    };
    let flown_at = parts.photos.iter().map(|photo| photo.pose.center);
    let flown_at: Vec<DVec2> = flown_at.filter_map(on_earth).collect();
    let (mut planned, mut notes) = (Vec::new(), Vec::new());
    for mission in missions {
        let mission = mission.as_ref();
        let in_mission = |fault: Fault| FileError::new(mission, fault);
        let MissionFile {
            mission: told,
            notes: own,
            ..
        } = read_mission(mission)?;
        is_near(&told, &flown_at).map_err(in_mission)?;
        let take_off = take_off.and_then(|stated| stated.of(&told));
        if let Some(place) = take_off.and_then(|place| on_earth(place.extend(0.0))) {
            takes_off_near(&told, place).map_err(in_mission)?;
            let said = takes_off_elsewhere(&told, place);
            notes.extend(said.map(|said| format!("{}: {said}", mission.display())));
        }
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
    notes.extend(places_off(&flown, parts.unit));
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

/// Where the drone took off in the world, x and y, as it is said beside its mission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedTakeOff {
    /// Whatever the mission says.
    Given(DVec2),
    /// Where the mission says none.
    InPlaceOfNone(DVec2),
}

impl StatedTakeOff {
    fn of(self, mission: &Mission) -> Option<DVec2> {
        match self {
            Self::Given(place) => Some(place),
            Self::InPlaceOfNone(place) => mission.take_off.is_none().then_some(place),
        }
    }
}

/// Whether the mission lies where the flight was flown. Photos that are called as the planned ones would else be told to be
/// kilometres off, as if anybody flew so.
fn is_near(mission: &Mission, flown_at: &[DVec2]) -> Result<(), Fault> {
    let mut nearest: Option<f64> = None;
    for place in flown_at {
        let kilometres = mission.to_nearest_stop(*place);
        if kilometres.is_none_or(|kilometres| kilometres <= Mission::FARTHEST) {
            return Ok(());
        }
        nearest = nearest.into_iter().chain(kilometres).reduce(f64::min);
    }
    let Some(nearest) = nearest else {
        return Ok(());
    };
    let what = format!(
        "the mission lies {} from the flight",
        kilometres_in_words(nearest)
    );
    let remedy = "look whether it is another pit's, or whether the coordinates of one of both are swapped or of another system (world.crs)";
    Err(Fault::new(what, remedy))
}

/// Whether the mission can be flown from a place where somebody says that the drone took off.
fn takes_off_near(mission: &Mission, place: DVec2) -> Result<(), Fault> {
    let kilometres = mission.to_nearest_stop(place);
    let Some(kilometres) = kilometres.filter(|kilometres| *kilometres > Mission::FARTHEST) else {
        return Ok(());
    };
    let what = format!(
        "its nearest stop lies {} from the take-off that is given",
        kilometres_in_words(kilometres)
    );
    let remedy = "give the place of the take-off in the flight's coordinates, x first";
    Err(Fault::new(what, remedy))
}

/// A take-off that is typed is off that of the file by less, kilometres, where both mean one place.
const ONE_PLACE: f64 = 0.01;

/// That the mission says another take-off than the one that is given, in a sentence: heights count from there.
fn takes_off_elsewhere(mission: &Mission, place: DVec2) -> Option<String> {
    let kilometres = mission.to_take_off(place)?;
    (kilometres > ONE_PLACE).then(|| {
        format!(
            "the take-off that is given is taken; its own lies {} from it: look from which of both the drone took off",
            kilometres_in_words(kilometres)
        )
    })
}

fn kilometres_in_words(kilometres: f64) -> String {
    match kilometres {
        ..1.0 => format!("{:.0} m", 1000.0 * kilometres),
        ..10.0 => format!("{kilometres:.1} km"),
        _ => format!("{kilometres:.0} km"),
    }
}

/// Photos that are off their plans by more, metres, are so by no receiver.
const PLACE_OFF: f64 = 50.0;

/// That photos were taken far from their plans though they are called like them, in a sentence.
fn places_off(flown: &Flown, unit: LengthUnit) -> Option<String> {
    let residuals = flown.residuals.iter().flatten();
    let off = residuals.map(|own| own.offset.truncate().length() * unit.metres());
    let [middle, _] = median_with_deviation(&mut off.collect::<Vec<f64>>())?;
    (middle > PLACE_OFF).then(|| {
        format!(
            "photos are {middle:.0} m off their plans (the median): look whether this flight is of that mission, and whether both are \
             of one coordinate system"
        )
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
    use fragscale_core::plan::{Height, Residual, Stop, TakeOff};

    use super::*;
    use crate::camera::Pose;

    /// Three photos that are so far off their plans.
    fn off_by(offset: DVec3) -> Flown {
        let residual = Residual {
            photo: 0,
            offset,
            tilt: 0.0,
            pan: 0.0,
            turn: 0.0,
            shared: None,
        };
        Flown {
            residuals: vec![Some(residual); 3],
            unplanned: Vec::new(),
        }
    }

    #[test]
    fn photos_that_are_called_like_others_elsewhere_are_said() {
        let of = |x, unit| places_off(&off_by(DVec3::new(x, 0.0, 900.0)), unit);
        assert_eq!(of(9.0, LengthUnit::Metre), None);
        let said = of(-1500.0, LengthUnit::Metre).unwrap();
        assert!(said.contains("1500 m off"), "{said}");
        assert_eq!(of(-100.0, LengthUnit::Foot), None);
    }

    /// What is said of three photos over a place east of 300 km that are so much higher than planned.
    fn said(east: f64, higher: f64) -> String {
        let center = DVec3::new(east, 6_600_000.0, 100.0);
        let planned = PlannedPose {
            name: String::new(),
            pose: Pose::from_tilt_pan(center, [90.0, 0.0]),
        };
        let flown = off_by(DVec3::new(0.0, 0.0, higher));
        let crs = Crs::understand("EPSG:32753").unwrap();
        heights_off(&[planned], &flown, &crs, LengthUnit::Metre).unwrap()
    }

    /// A degree of longitude at 60 N is 55.6 km on a sphere with a radius of 6371 km, and one of latitude 111.2 km.
    fn mission() -> Mission {
        Mission {
            name: "bench".to_owned(),
            take_off: Some(TakeOff {
                latitude: 60.0,
                longitude: 8.0,
                elevation: None,
            }),
            stops: vec![Stop {
                latitude: 60.0,
                longitude: 8.0,
                height: Height::above_take_off(30.0),
                heading: None,
                gimbal_pitch: None,
                settle: 0.0,
                photo: None,
            }],
            ..Mission::default()
        }
    }

    /// Of a flight the photo that is nearest counts; of one without a place, and of a mission without a stop, nothing is said.
    #[test]
    fn a_mission_of_another_pit_is_refused() {
        let at = DVec2::new;
        let near = [at(61.0, 8.0), at(60.01, 8.0)];
        assert_eq!(is_near(&mission(), &near), Ok(()));
        assert_eq!(is_near(&mission(), &[]), Ok(()));
        assert_eq!(is_near(&Mission::default(), &near), Ok(()));
        let far = is_near(&mission(), &[at(61.0, 8.0), at(60.0, 8.1)]).unwrap_err();
        assert_eq!(far.what, "the mission lies 5.6 km from the flight");
        let far = is_near(&mission(), &[at(61.0, 8.0)]).unwrap_err();
        assert_eq!(far.what, "the mission lies 111 km from the flight");
    }

    #[test]
    fn a_take_off_elsewhere_is_said_or_refused() {
        let at = |north: f64| DVec2::new(60.0 + north / 111_195.0, 8.0);
        for (north, said) in [(5.0, None), (300.0, Some("lies 300 m from it"))] {
            assert_eq!(takes_off_near(&mission(), at(north)), Ok(()));
            let told = takes_off_elsewhere(&mission(), at(north));
            match said {
                None => assert_eq!(told, None),
                Some(said) => assert!(told.as_ref().unwrap().contains(said), "{told:?}"),
            }
        }
        let far = takes_off_near(&mission(), at(7300.0)).unwrap_err();
        assert!(far.what.contains("7.3 km from the take-off"), "{far}");
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
