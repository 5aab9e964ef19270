//! A way as the mission that a drone is told: degrees, headings from true north, metres above the take-off.
//!
//! Heights are relative to the take-off, because that needs no datum: the drone measures them with its barometer
//! from where it stood. So the take-off has to be where it was planned; a metre too high there is one everywhere.

use glam::{DVec2, DVec3};

use super::{
    DroneCodes, Fence, Finish, Height, LostSignal, Mission, PhotoOf, Stop, TakeOff, heading,
};
use crate::fault::Fault;
use crate::geodesy::{Crs, CrsKind, Geographic};
use crate::plan::{Plan, Way, lost_signal, return_height};
use crate::units::LengthUnit;

/// Units that differ by less are one: feet and US survey feet differ by 2e-6, metres at UTM's coordinates.
const SAME_UNIT: f64 = 1e-9;

/// What the mission is told beside the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// The mission's name.
    pub name: String,
    /// DJI's numbers of the drone, where they are known.
    pub drone: Option<DroneCodes>,
    /// The unit of the surface's coordinates.
    pub unit: LengthUnit,
    /// Metres a second between stops.
    pub speed: f64,
    /// Seconds between the gimbal's arrival and the shot.
    pub settle: f64,
    /// Whether several ways are those of batteries: their missions are called so.
    pub by_battery: bool,
}

/// Whether a surface counts in the unit of its coordinate system, upwards along z.
///
/// # Errors
/// Where it does not: one of both is wrong.
pub fn is_over_ground(unit: LengthUnit, crs: &Crs) -> Result<(), Fault> {
    let counted = crs.unit_metres();
    if crs.kind() == CrsKind::Geocentric {
        let what = format!(
            "{} counts from the middle of the Earth: its z is not up",
            crs.name()
        );
        let remedy =
            "bring the surface to a system of maps, such as UTM, or state the one that it is in";
        return Err(Fault::new(what, remedy));
    }
    if (unit.metres() / counted - 1.0).abs() <= SAME_UNIT {
        return Ok(());
    }
    let what = format!(
        "the surface's coordinates are in {unit}, and {} counts in units of {counted} m",
        crs.name()
    );
    let remedy = "state the unit and the system that the surface is in";
    Err(Fault::new(what, remedy))
}

/// A mission for each way of a plan over a surface in a coordinate system, with what the name of its file has behind
/// that of the plan: nothing, or the number of the battery or the flight.
///
/// # Errors
/// Where the coordinate system counts in another unit than the surface, or a place of a way lies where it does not hold.
pub fn missions(
    plan: &Plan,
    ways: &[Way],
    crs: &Crs,
    told: &Told,
) -> Result<Vec<(String, Mission)>, Fault> {
    is_over_ground(told.unit, crs)?;
    // Of all ways: the pilot sets one, whatever battery is flown.
    let home = (return_height(plan, ways), lost_signal(plan, ways));
    let numbered = ways.iter().zip(1..).map(|(way, number)| {
        let behind = match (ways.len(), told.by_battery) {
            (0 | 1, _) => String::new(),
            (_, true) => format!("-battery-{number}"),
            (_, false) => format!("-{number}"),
        };
        let name = format!("{}{behind}", told.name);
        let mission = mission(
            plan,
            (way, home),
            crs,
            Told {
                name,
                ..told.clone()
            },
        )?;
        Ok((behind, mission))
    });
    numbered.collect()
}

fn mission(
    plan: &Plan,
    (way, (return_height, lost_signal)): (&Way, (Option<f64>, LostSignal)),
    crs: &Crs,
    told: Told,
) -> Result<Mission, Fault> {
    let off = || {
        let what = format!("the plan lies where {} does not hold", crs.name());
        Fault::new(what, "check the coordinate system of the surface")
    };
    let geographic = |place: DVec3| crs.to_geographic(place).ok_or_else(off);
    let take_off = geographic(way.take_off)?;
    // A surface has its heights in the unit of x and y, whatever unit the system states for them.
    let above = |z: f64| (z - way.take_off.z) * told.unit.metres();
    let mut stops = Vec::with_capacity(way.points.len());
    for point in &way.points {
        let place = geographic(point.place)?;
        let photo = point.photo.and_then(|photo| plan.photos.get(photo));
        let heading = photo.map(|photo| true_heading(photo.pan, crs, place).ok_or_else(off));
        stops.push(Stop {
            latitude: place.latitude,
            longitude: place.longitude,
            height: Height::above_take_off(above(point.place.z)),
            heading: heading.transpose()?,
            gimbal_pitch: photo.map(|photo| -photo.tilt),
            settle: photo.map_or(0.0, |_| told.settle),
            photo: photo.map(|photo| PhotoOf {
                name: Some(photo.name.clone()),
            }),
        });
    }
    let fences = plan.wish.keep_out.iter().map(|area| {
        let corners = area.corners().iter().map(|corner| {
            let place = geographic(corner.extend(way.take_off.z))?;
            Ok([place.latitude, place.longitude])
        });
        Ok(Fence {
            keep_in: false,
            corners: corners.collect::<Result<_, Fault>>()?,
        })
    });
    let mission = Mission {
        name: told.name,
        drone: told.drone,
        take_off: Some(TakeOff {
            latitude: take_off.latitude,
            longitude: take_off.longitude,
            elevation: None,
        }),
        speed: Some(told.speed),
        safe_height: Some(above(way.safe_height)),
        return_height: return_height.map(above),
        finish: Finish::ReturnHome,
        lost_signal: Some(lost_signal),
        stops,
        fences: fences.collect::<Result<_, Fault>>()?,
    };
    mission.check()?;
    Ok(mission)
}

/// A direction of the grid, degrees clockwise from its +y, as degrees from true north.
pub(in crate::plan) fn true_heading(pan: f64, crs: &Crs, place: Geographic) -> Option<f64> {
    let (sine, cosine) = pan.to_radians().sin_cos();
    let on_grid = DVec2::new(sine, cosine).extend(0.0);
    let enu = crs.grid_from_enu(place)?.transpose() * on_grid;
    Some(heading(enu.x.atan2(enu.y).to_degrees()))
}
