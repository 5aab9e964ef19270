//! QGroundControl's .plan (its developer guide, "Plan File Format"): JSON of version 1 with a mission of
//! version 2, a geofence and rally points. Surveys and scans have the commands that they expand to, if
//! QGroundControl has computed them; their own settings are not read.

use serde::Deserialize;
use serde::de::IgnoredAny;

use fragscale_core::plan::{Fence, Mission, TakeOff};

use super::MissionFile;
use super::mavlink::{Autopilot, Item, Place, home, told};
use crate::fault::Fault;
use crate::text::fields::shown;
use crate::text::json;
use crate::text::notes::Notes;

const EXPORT: &str = "open it in QGroundControl and save it again";

/// Complex items and the versions of them that QGroundControl has written.
const COMPLEX: [(&str, u32, u32); 3] = [
    ("survey", 3, 6),
    ("CorridorScan", 1, 4),
    ("StructureScan", 1, 4),
];

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct PlanFile {
    file_type: Option<String>,
    version: Option<f64>,
    geo_fence: Option<GeoFence>,
    rally_points: Option<RallyPoints>,
    mission: Option<MissionPart>,
}

#[derive(Deserialize)]
struct GeoFence {
    version: Option<f64>,
    #[serde(default)]
    circles: Vec<IgnoredAny>,
    #[serde(default)]
    polygons: Vec<FencePolygon>,
}

#[derive(Deserialize)]
struct FencePolygon {
    inclusion: bool,
    polygon: Vec<[f64; 2]>,
}

#[derive(Deserialize)]
struct RallyPoints {
    version: Option<f64>,
    #[serde(default)]
    points: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct MissionPart {
    version: Option<f64>,
    firmware_type: Option<f64>,
    hover_speed: Option<f64>,
    planned_home_position: Option<Vec<Option<f64>>>,
    #[serde(default)]
    items: Vec<PlanItem>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct PlanItem {
    #[serde(rename = "type")]
    kind: String,
    command: Option<u32>,
    frame: Option<u32>,
    params: Option<Vec<Option<f64>>>,
    complex_item_type: Option<String>,
    version: Option<f64>,
    #[serde(rename = "TransectStyleComplexItem")]
    transects: Option<Transects>,
}

#[derive(Deserialize)]
struct Transects {
    #[serde(rename = "Items", default)]
    items: Vec<PlanItem>,
}

/// Reads JSON that is no GeoJSON of ours.
pub(super) fn read(text: &str) -> Result<MissionFile, Fault> {
    let file: PlanFile = json::parse(text.as_bytes())?;
    match file.file_type.as_deref() {
        Some("Plan") => {}
        Some(other) => {
            let what = format!("\"fileType\" is \"{}\", not \"Plan\"", shown(other));
            return Err(Fault::new(what, "give QGroundControl's .plan"));
        }
        None => {
            let what = "JSON without \"fileType\": \"Plan\" is no mission";
            return Err(Fault::new(what, super::KNOWN));
        }
    }
    version("version", file.version, 1.0)?;
    let mission = part("mission", file.mission)?;
    version("mission.version", mission.version, 2.0)?;
    let fence = part("geoFence", file.geo_fence)?;
    version("geoFence.version", fence.version, 2.0)?;
    let rally = part("rallyPoints", file.rally_points)?;
    version("rallyPoints.version", rally.version, 2.0)?;
    let mut notes = Notes::default();
    let mut items = Vec::new();
    for (item, number) in mission.items.iter().zip(1..) {
        add(&mut items, item, number, &mut notes)?;
    }
    // MAV_AUTOPILOT_PX4
    let autopilot = match mission.firmware_type {
        Some(12.0) => Autopilot::Px4,
        _ => Autopilot::ArduPilot,
    };
    let told = told(&items, autopilot, &mut notes)?;
    for (count, what) in [
        (fence.circles.len(), "circles of its geofence"),
        (rally.points.len(), "rally points"),
    ] {
        if count > 0 {
            notes.say(format!("{count} {what} are not read"));
        }
    }
    let planned = take_off(mission.planned_home_position.as_deref());
    let on_ground = told.take_off.map(|[latitude, longitude]| TakeOff {
        latitude,
        longitude,
        elevation: None,
    });
    let fences = fence.polygons.into_iter().map(|polygon| Fence {
        keep_in: polygon.inclusion,
        corners: polygon.polygon,
    });
    let mission = Mission {
        take_off: planned.or(on_ground),
        speed: told
            .speed
            .or(mission.hover_speed.filter(|speed| *speed > 0.0)),
        safe_height: told.safe_height,
        finish: told.finish,
        stops: told.stops,
        fences: fences.collect(),
        ..Mission::default()
    };
    Ok(MissionFile {
        mission,
        format: "a .plan of QGroundControl",
        notes: notes.sentences(),
    })
}

/// A part that every plan has: QGroundControl opens none without.
fn part<T>(name: &str, part: Option<T>) -> Result<T, Fault> {
    part.ok_or_else(|| Fault::new(format!("it has no \"{name}\""), EXPORT))
}

fn version(name: &str, found: Option<f64>, known: f64) -> Result<(), Fault> {
    match found {
        Some(found) if found == known => Ok(()),
        Some(found) => {
            let what = format!("\"{name}\" is {found}, and only {known} is known");
            Err(Fault::new(what, EXPORT))
        }
        None => Err(Fault::new(format!("it has no \"{name}\""), EXPORT)),
    }
}

/// Latitude, longitude, height above mean sea level.
fn take_off(position: Option<&[Option<f64>]>) -> Option<TakeOff> {
    let &[Some(latitude), Some(longitude), ref rest @ ..] = position? else {
        return None;
    };
    let metres = rest.first().copied().flatten();
    home(latitude, longitude, metres.unwrap_or(0.0))
}

/// Adds the commands of item `number`, from 1.
fn add(
    items: &mut Vec<Item>,
    item: &PlanItem,
    number: usize,
    notes: &mut Notes,
) -> Result<(), Fault> {
    match item.kind.as_str() {
        "SimpleItem" => items.push(simple(item, Place::Item(number, None))?),
        "ComplexItem" => {
            let name = item.complex_item_type.as_deref().unwrap_or("complex item");
            if let Some((_, from, to)) = COMPLEX.iter().find(|(known, ..)| *known == name)
                && !(item.version).is_some_and(|v| (f64::from(*from)..=f64::from(*to)).contains(&v))
            {
                let found = item.version.map_or("none".to_owned(), |v| v.to_string());
                let what = format!(
                    "item {number}: the version of a {name} is {found}, and only {from} to {to} are known"
                );
                return Err(Fault::new(what, EXPORT));
            }
            let inner = item.transects.as_ref().map_or(&[][..], |t| &t.items[..]);
            if inner.is_empty() {
                let what = format!("a {} without its waypoints is not read", shown(name));
                notes.at(what, format_args!("item {number}"));
            }
            for (inner, index) in inner.iter().zip(1..) {
                items.push(simple(inner, Place::Item(number, Some(index)))?);
            }
        }
        other => {
            let kind = shown(other);
            let what = format!("item {number}: its \"type\" is \"{kind}\", which is not known");
            return Err(Fault::new(what, EXPORT));
        }
    }
    Ok(())
}

fn simple(item: &PlanItem, place: Place) -> Result<Item, Fault> {
    let lacks = |what: &str| Fault::new(format!("{place} has no \"{what}\""), EXPORT);
    let command = item.command.ok_or_else(|| lacks("command"))?;
    let frame = item.frame.ok_or_else(|| lacks("frame"))?;
    let given = item.params.as_deref().ok_or_else(|| lacks("params"))?;
    if given.len() != 7 {
        let what = format!("{place} has {} \"params\", not 7", given.len());
        return Err(Fault::new(what, EXPORT));
    }
    let mut parameters = [f64::NAN; 7];
    for (parameter, given) in parameters.iter_mut().zip(given) {
        *parameter = given.unwrap_or(f64::NAN);
    }
    Ok(Item {
        command,
        frame,
        parameters,
        place,
    })
}
