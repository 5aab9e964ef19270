//! GeoJSON (RFC 7946): points for the take-off and the stops, a line between them, polygons of the fences.
//! What a stop says is in its properties, its height, too: a third coordinate would count from the
//! ellipsoid, and most heights do not. Numbers read back to the same.

use serde::Serialize;

use fragscale_core::plan::{Above, Height, LostSignal, Mission};

use crate::fault::Fault;

#[derive(Serialize)]
struct Collection<'a> {
    r#type: &'static str,
    /// What tells it from any other; `formats::missions` looks for it.
    fragscale: &'static str,
    name: &'a str,
    speed_m_per_s: Option<f64>,
    safe_height_m: Option<f64>,
    return_height_m: Option<f64>,
    finish: &'static str,
    lost_signal: Option<&'static str>,
    drone: Option<Drone>,
    features: Vec<Feature<'a>>,
}

#[derive(Serialize)]
struct Drone {
    drone: u32,
    drone_sub: u32,
    payload: Option<Payload>,
}

#[derive(Serialize)]
struct Payload {
    payload: u32,
    payload_sub: u32,
    position: u32,
}

#[derive(Serialize)]
struct Feature<'a> {
    r#type: &'static str,
    geometry: Geometry,
    properties: Properties<'a>,
}

#[derive(Serialize)]
#[serde(tag = "type", content = "coordinates")]
enum Geometry {
    Point([f64; 2]),
    LineString(Vec<[f64; 2]>),
    Polygon([Vec<[f64; 2]>; 1]),
}

#[derive(Serialize, Default)]
struct Properties<'a> {
    what: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    height_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    above: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    heading_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    gimbal_pitch_deg: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    settle_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    photo: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    photo_name: Option<&'a str>,
}

/// The file of a mission.
pub(super) fn bytes(mission: &Mission) -> Result<Vec<u8>, Fault> {
    let mut features = Vec::new();
    if let Some(take_off) = &mission.take_off {
        let place = Geometry::Point([take_off.longitude, take_off.latitude]);
        let (height_m, above) = height(take_off.elevation);
        let properties = Properties {
            what: "take-off",
            height_m,
            above,
            ..Properties::default()
        };
        features.push(feature(place, properties));
    }
    let stops = mission.stops.iter();
    let path: Vec<[f64; 2]> = stops.map(|stop| [stop.longitude, stop.latitude]).collect();
    // A line has two places at least.
    if path.len() > 1 {
        let properties = Properties {
            what: "path",
            ..Properties::default()
        };
        features.push(feature(Geometry::LineString(path), properties));
    }
    for (stop, number) in mission.stops.iter().zip(1..) {
        let (height_m, above) = height(Some(stop.height));
        let properties = Properties {
            what: "stop",
            number: Some(number),
            height_m,
            above,
            heading_deg: stop.heading,
            gimbal_pitch_deg: stop.gimbal_pitch,
            settle_s: Some(stop.settle),
            photo: Some(stop.photo.is_some()),
            photo_name: stop.photo.as_ref().and_then(|photo| photo.name.as_deref()),
        };
        features.push(feature(
            Geometry::Point([stop.longitude, stop.latitude]),
            properties,
        ));
    }
    for fence in &mission.fences {
        let corners = fence.corners.iter();
        let mut ring: Vec<[f64; 2]> = corners
            .map(|&[latitude, longitude]| [longitude, latitude])
            .collect();
        ring.extend(ring.first().copied());
        let properties = Properties {
            what: if fence.keep_in { "keep in" } else { "keep out" },
            ..Properties::default()
        };
        features.push(feature(Geometry::Polygon([ring]), properties));
    }
    let file = Collection {
        r#type: "FeatureCollection",
        fragscale: "mission 1",
        name: &mission.name,
        speed_m_per_s: mission.speed,
        safe_height_m: mission.safe_height,
        return_height_m: mission.return_height,
        finish: mission.finish.as_str(),
        lost_signal: mission.lost_signal.map(LostSignal::as_str),
        drone: mission.drone.map(|codes| Drone {
            drone: codes.drone,
            drone_sub: codes.drone_sub,
            payload: codes.payload.map(|codes| Payload {
                payload: codes.payload,
                payload_sub: codes.payload_sub,
                position: codes.position,
            }),
        }),
        features,
    };
    let text = serde_json::to_string(&file).map_err(|error| {
        let what = format!("it cannot be written as JSON ({error})");
        Fault::new(what, "plan the mission again")
    })?;
    Ok((text + "\n").into_bytes())
}

fn feature(geometry: Geometry, properties: Properties<'_>) -> Feature<'_> {
    Feature {
        r#type: "Feature",
        geometry,
        properties,
    }
}

fn height(height: Option<Height>) -> (Option<f64>, Option<&'static str>) {
    let above = height.map(|height| match height.above {
        Above::TakeOff => "take-off",
        Above::Ground => "ground",
        Above::Ellipsoid => "ellipsoid WGS 84",
        Above::Geoid => "geoid EGM96",
        Above::Unknown => "unknown",
    });
    (height.map(|height| height.metres), above)
}
