//! What is said of a drone's mission.

use fragscale_core::plan::{Height, LostSignal};
use serde_json::{Value, json};

use crate::formats::MissionFile;

/// A drone's mission: degrees of WGS 84, metres, metres a second; headings clockwise from true north.
pub(super) fn mission_info(file: &MissionFile) -> Value {
    let mission = &file.mission;
    let height =
        |height: Height| json!({"metres": height.metres, "above": height.above.in_words()});
    let stops = mission.stops.iter().zip(mission.gimbal_pitches());
    let stops = stops.map(|(stop, pitch)| {
        json!({
            "latitude": stop.latitude,
            "longitude": stop.longitude,
            "height": height(stop.height),
            "heading": stop.heading,
            "gimbal_pitch": pitch,
            "waits": stop.settle,
            "photo": stop.photo.is_some(),
            "name": stop.photo.as_ref().and_then(|photo| photo.name.as_deref()),
        })
    });
    let fences = mission.fences.iter();
    let fences = fences.map(|fence| json!({"keep_in": fence.keep_in, "corners": fence.corners}));
    json!({
        "kind": "mission",
        "format": file.format,
        "name": mission.name,
        "drone": mission.drone.map(|codes| json!({
            "drone": codes.drone,
            "drone_sub": codes.drone_sub,
            "payload": codes.payload.map(|payload| payload.payload),
        })),
        "take_off": mission.take_off.map(|at| json!({
            "latitude": at.latitude,
            "longitude": at.longitude,
            "elevation": at.elevation.map(height),
        })),
        "speed": mission.speed,
        "safe_height": mission.safe_height,
        "return_height": mission.return_height,
        "finish": mission.finish.in_words(),
        "lost_signal": mission.lost_signal.map(LostSignal::in_words),
        "photos": mission.stops.iter().filter(|stop| stop.photo.is_some()).count(),
        "stops": stops.collect::<Vec<_>>(),
        "fences": fences.collect::<Vec<_>>(),
        "warnings": file.notes,
    })
}
