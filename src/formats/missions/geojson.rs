//! Our own GeoJSON (RFC 7946) of a mission, which `exports::missions` writes: features of points for the
//! take-off and the stops, of polygons for fences; what they say besides their places is in `properties`.
//! Heights are there and not in the coordinates, whose third number would count from the ellipsoid.

use serde::Deserialize;

use fragscale_core::plan::{
    Above, DroneCodes, Fence, Finish, Height, LostSignal, Mission, PayloadCodes, PhotoOf, Stop,
    TakeOff,
};

use super::MissionFile;
use crate::fault::Fault;
use crate::text::fields::shown;
use crate::text::json;
use crate::text::notes::Notes;

const WRITE: &str = "write the mission again";

/// Whether JSON says that it is ours: fragscale's key is the second.
pub(super) fn is_ours(text: &str) -> bool {
    let head: String = text
        .chars()
        .take(200)
        .filter(|c| !c.is_whitespace())
        .collect();
    head.starts_with("{\"type\":\"FeatureCollection\",\"fragscale\":\"mission")
}

#[derive(Deserialize)]
struct Collection {
    fragscale: String,
    #[serde(default)]
    name: String,
    speed_m_per_s: Option<f64>,
    safe_height_m: Option<f64>,
    return_height_m: Option<f64>,
    finish: String,
    lost_signal: Option<String>,
    drone: Option<Drone>,
    features: Vec<Feature>,
}

#[derive(Deserialize)]
struct Drone {
    drone: u32,
    drone_sub: u32,
    payload: Option<Payload>,
}

#[derive(Deserialize)]
struct Payload {
    payload: u32,
    payload_sub: u32,
    position: u32,
}

#[derive(Deserialize)]
struct Feature {
    geometry: Geometry,
    properties: Properties,
}

#[derive(Deserialize)]
#[serde(tag = "type", content = "coordinates")]
enum Geometry {
    Point([f64; 2]),
    #[expect(dead_code, reason = "only maps show it")]
    LineString(Vec<[f64; 2]>),
    Polygon(Vec<Vec<[f64; 2]>>),
}

#[derive(Deserialize)]
struct Properties {
    what: String,
    height_m: Option<f64>,
    above: Option<String>,
    heading_deg: Option<f64>,
    gimbal_pitch_deg: Option<f64>,
    settle_s: Option<f64>,
    photo: Option<bool>,
    photo_name: Option<String>,
}

/// Reads a collection that [`is_ours`].
pub(super) fn read(text: &str) -> Result<MissionFile, Fault> {
    let file: Collection = json::parse(text.as_bytes())?;
    if file.fragscale != "mission 1" {
        let what = format!(
            "\"fragscale\" is \"{}\", not \"mission 1\"",
            shown(&file.fragscale)
        );
        return Err(Fault::new(what, "read it with a newer fragscale"));
    }
    let finish = Finish::ALL
        .into_iter()
        .find(|own| own.as_str() == file.finish);
    let finish = finish.ok_or_else(|| {
        let what = format!("\"finish\" is \"{}\"", shown(&file.finish));
        Fault::new(what, "write return home, hover, land or first stop")
    })?;
    let lost_signal = file.lost_signal.as_deref().map(|lost| {
        let found = LostSignal::ALL.into_iter().find(|own| own.as_str() == lost);
        found.ok_or_else(|| {
            let what = format!("\"lost_signal\" is \"{}\"", shown(lost));
            Fault::new(what, "write return home, hover, land or go on")
        })
    });
    let lost_signal = lost_signal.transpose()?;
    let drone = file.drone.map(|codes| DroneCodes {
        drone: codes.drone,
        drone_sub: codes.drone_sub,
        payload: codes.payload.map(|codes| PayloadCodes {
            payload: codes.payload,
            payload_sub: codes.payload_sub,
            position: codes.position,
        }),
    });
    let mut mission = Mission {
        name: file.name,
        drone,
        speed: file.speed_m_per_s,
        safe_height: file.safe_height_m,
        return_height: file.return_height_m,
        finish,
        lost_signal,
        ..Mission::default()
    };
    let mut notes = Notes::default();
    for (feature, number) in file.features.into_iter().zip(1_usize..) {
        add(&mut mission, feature, number, &mut notes)?;
    }
    Ok(MissionFile {
        mission,
        format: "a mission of fragscale",
        notes: notes.sentences(),
    })
}

fn add(
    mission: &mut Mission,
    feature: Feature,
    number: usize,
    notes: &mut Notes,
) -> Result<(), Fault> {
    let told = feature.properties;
    let height = match (told.height_m, told.above.as_deref().map(above)) {
        (None, _) => None,
        (Some(metres), Some(Some(above))) => Some(Height { metres, above }),
        (Some(_), above) => {
            let what = match above {
                None => format!("feature {number}: a height that counts from nothing"),
                Some(_) => format!("feature {number}: a height that counts from what is not known"),
            };
            return Err(Fault::new(what, WRITE));
        }
    };
    match (told.what.as_str(), feature.geometry) {
        ("take-off", Geometry::Point([longitude, latitude])) => {
            mission.take_off = Some(TakeOff {
                latitude,
                longitude,
                elevation: height,
            });
        }
        ("stop", Geometry::Point([longitude, latitude])) => {
            let lacks = || Fault::new(format!("feature {number}: a stop without a height"), WRITE);
            let name = told.photo_name;
            mission.stops.push(Stop {
                latitude,
                longitude,
                height: height.ok_or_else(lacks)?,
                heading: told.heading_deg,
                gimbal_pitch: told.gimbal_pitch_deg,
                settle: told.settle_s.unwrap_or(0.0),
                photo: (told.photo == Some(true)).then_some(PhotoOf { name }),
            });
        }
        ("path", Geometry::LineString(_)) => {}
        (what @ ("keep in" | "keep out"), Geometry::Polygon(rings)) => {
            let mut ring = rings.into_iter().next().unwrap_or_default();
            // A ring ends where it began (RFC 7946, 3.1.6).
            ring.pop();
            mission.fences.push(Fence {
                keep_in: what == "keep in",
                corners: ring
                    .into_iter()
                    .map(|[longitude, latitude]| [latitude, longitude])
                    .collect(),
            });
        }
        (what, _) => {
            let what = format!("'{}' is passed over", shown(what));
            notes.at(what, format_args!("feature {number}"));
        }
    }
    Ok(())
}

fn above(text: &str) -> Option<Above> {
    Some(match text {
        "take-off" => Above::TakeOff,
        "ground" => Above::Ground,
        "ellipsoid WGS 84" => Above::Ellipsoid,
        "geoid EGM96" => Above::Geoid,
        "unknown" => Above::Unknown,
        _ => return None,
    })
}
