//! A mission that a target does not take at once, in several.

use fragscale_core::plan::Mission;

use super::MissionFormat;
use super::mavlink;

/// The parts of a mission, each of which the target takes, in their order. Their names are numbered.
///
/// The gimbal of a part begins where it was: the first stop says it, for the parts may be flown on
/// different days.
pub(super) fn parts(mission: &Mission, format: MissionFormat) -> Vec<Mission> {
    let is_mavlink = matches!(
        format,
        MissionFormat::QGroundControl | MissionFormat::Waypoints
    );
    let begins_with = if is_mavlink { mavlink::BESIDE_STOPS } else { 0 };
    let pitches = mission.gimbal_pitches();
    let mut parts: Vec<Mission> = Vec::new();
    let mut used = 0;
    for (stop, pitch) in mission.stops.iter().zip(pitches) {
        let size = if is_mavlink {
            mavlink::commands_at(stop)
        } else {
            1
        };
        if parts.is_empty() || used + size > format.most() {
            parts.push(Mission {
                stops: Vec::new(),
                ..mission.clone()
            });
            used = begins_with;
        }
        used += size;
        if let Some(part) = parts.last_mut() {
            let mut stop = stop.clone();
            if part.stops.is_empty() {
                stop.gimbal_pitch = pitch;
            }
            part.stops.push(stop);
        }
    }
    if parts.len() > 1 {
        for (part, number) in parts.iter_mut().zip(1..) {
            part.name = format!("{}-{number}", part.name);
        }
    }
    parts
}
