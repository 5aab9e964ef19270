//! QGroundControl's .plan (its developer guide, "Plan File Format"). It opens none without geofence and
//! rally points, even empty ones. Latitude comes before longitude, and lines end in LF alone.

use serde::Serialize;

use fragscale_core::plan::Mission;

use super::mavlink::{Command, commands, home};
use crate::fault::Fault;

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PlanFile {
    file_type: &'static str,
    ground_station: &'static str,
    version: u32,
    geo_fence: GeoFence,
    rally_points: RallyPoints,
    mission: MissionPart,
}

#[derive(Serialize)]
struct GeoFence {
    version: u32,
    circles: [(); 0],
    polygons: Vec<FencePolygon>,
}

#[derive(Serialize)]
struct FencePolygon {
    version: u32,
    inclusion: bool,
    polygon: Vec<[f64; 2]>,
}

#[derive(Serialize)]
struct RallyPoints {
    version: u32,
    points: [(); 0],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct MissionPart {
    version: u32,
    firmware_type: u32,
    vehicle_type: u32,
    cruise_speed: f64,
    hover_speed: f64,
    global_plan_altitude_mode: u32,
    planned_home_position: [f64; 3],
    items: Vec<Item>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Item {
    auto_continue: bool,
    command: u32,
    do_jump_id: usize,
    frame: u32,
    params: [f64; 7],
    r#type: &'static str,
    #[serde(flatten)]
    altitude: Option<Altitude>,
}

/// What QGroundControl shows of an item that has a place.
#[derive(Serialize)]
#[serde(rename_all = "PascalCase")]
struct Altitude {
    #[serde(rename = "AMSLAltAboveTerrain")]
    above_terrain: Option<f64>,
    altitude: f64,
    altitude_mode: u32,
}

/// What a plan has where nobody says how fast; QGroundControl asks for a number.
const SOME_SPEED: f64 = 5.0;

const ARDUPILOT: u32 = 3;
const QUADROTOR: u32 = 2;

/// The file of a mission.
pub(super) fn bytes(mission: &Mission, notes: &mut Vec<String>) -> Result<Vec<u8>, Fault> {
    let home = home(mission, notes)?;
    let elevation = home.elevation.map_or(0.0, |height| height.metres);
    let commands = commands(mission, notes)?;
    let modes: Vec<u32> = commands.iter().filter_map(altitude_mode).collect();
    let first = modes.first().copied().unwrap_or(RELATIVE);
    let is_one = modes.iter().all(|mode| *mode == first);
    let speed = mission.speed.unwrap_or(SOME_SPEED);
    let items = commands.into_iter().zip(1..).map(|(command, number)| Item {
        auto_continue: true,
        command: command.command,
        do_jump_id: number,
        frame: command.frame,
        altitude: altitude_mode(&command).map(|mode| Altitude {
            above_terrain: None,
            altitude: command.parameters[6],
            altitude_mode: mode,
        }),
        params: command.parameters,
        r#type: "SimpleItem",
    });
    let polygons = mission.fences.iter().map(|fence| FencePolygon {
        version: 1,
        inclusion: fence.keep_in,
        polygon: fence.corners.clone(),
    });
    let file = PlanFile {
        file_type: "Plan",
        ground_station: "fragscale",
        version: 1,
        geo_fence: GeoFence {
            version: 2,
            circles: [],
            polygons: polygons.collect(),
        },
        rally_points: RallyPoints {
            version: 2,
            points: [],
        },
        mission: MissionPart {
            version: 2,
            firmware_type: ARDUPILOT,
            vehicle_type: QUADROTOR,
            cruise_speed: speed,
            hover_speed: speed,
            global_plan_altitude_mode: if is_one { first } else { MIXED },
            planned_home_position: [home.latitude, home.longitude, elevation],
            items: items.collect(),
        },
    };
    let text = serde_json::to_string_pretty(&file).map_err(|error| {
        let what = format!("it cannot be written as JSON ({error})");
        Fault::new(what, "plan the mission again")
    })?;
    Ok((text + "\n").into_bytes())
}

/// QGroundControl's `AltitudeMode`s of places.
const MIXED: u32 = 0;
const RELATIVE: u32 = 1;
const ABSOLUTE: u32 = 2;
const TERRAIN: u32 = 4;

fn altitude_mode(command: &Command) -> Option<u32> {
    match (command.command, command.frame) {
        (16 | 22, 0) => Some(ABSOLUTE),
        (16 | 22, 10) => Some(TERRAIN),
        (16 | 22, _) => Some(RELATIVE),
        _ => None,
    }
}
