//! More than a target takes at once, in several: of a plan flights of their own, of a mission alone its stops.

use fragscale_core::plan::{Height, Mission, Pace, PhotoOf, Plan, Stop, Told, Way};

use super::MissionFormat;
use super::mavlink;
use crate::fault::Fault;
use crate::numbers::significant_digits;

/// The ways of a plan as flights that each of these targets takes: as they are where that is so, else parted anew, each out
/// from the take-off and home as that of a battery. And what the pilot must know of that, one sentence each.
///
/// # Errors
/// Where a target does not take the way to a single photo and back.
pub fn flights_for(
    targets: &[MissionFormat],
    (plan, ways): (&Plan, &[Way]),
    pace: &Pace,
    told: &Told,
) -> Result<(Vec<Way>, Vec<String>), Fault> {
    let takes = |target: MissionFormat, way: &Way| size_of(way, told, target) <= target.most();
    let mut limits: Vec<String> = (targets.iter())
        .filter(|target| !ways.iter().all(|way| takes(**target, way)))
        .map(|target| limit_in_words(*target))
        .collect();
    if limits.is_empty() {
        return Ok((ways.to_vec(), Vec::new()));
    }
    limits.dedup();
    let fits = |way: &Way| targets.iter().all(|target| takes(*target, way));
    let flights = Way::parted(plan, ways, pace, &fits)?;
    let minutes = flights.iter().map(|way| way.seconds(pace) / 60.0);
    let minutes: Vec<String> = minutes
        .map(|minutes| significant_digits(minutes, 2))
        .collect();
    let said = format!(
        "{}: the way is in {} flights of about {} min, each out from the take-off and home",
        limits.join(", "),
        flights.len(),
        minutes.join(", ")
    );
    Ok((flights, vec![said]))
}

/// How many units of [`MissionFormat::most`] the mission of a way has.
fn size_of(way: &Way, told: &Told, target: MissionFormat) -> usize {
    // As missions of plans have them: on the way a place alone, at a photo all that makes it.
    let on_the_way = Stop {
        latitude: 0.0,
        longitude: 0.0,
        height: Height::above_take_off(0.0),
        heading: None,
        gimbal_pitch: None,
        settle: 0.0,
        photo: None,
    };
    let at_photo = Stop {
        heading: Some(0.0),
        gimbal_pitch: Some(0.0),
        settle: told.settle,
        photo: Some(PhotoOf::default()),
        ..on_the_way.clone()
    };
    let photos = way.photos();
    beside_stops(target)
        + photos * size(&at_photo, target)
        + (way.points.len() - photos) * size(&on_the_way, target)
}

/// How many units a file has besides those of its stops.
fn beside_stops(format: MissionFormat) -> usize {
    match is_mavlink(format) {
        true => mavlink::BESIDE_STOPS,
        false => 0,
    }
}

/// How many units a stop has.
fn size(stop: &Stop, format: MissionFormat) -> usize {
    match is_mavlink(format) {
        true => mavlink::commands_at(stop),
        false => 1,
    }
}

fn is_mavlink(format: MissionFormat) -> bool {
    matches!(
        format,
        MissionFormat::QGroundControl | MissionFormat::Waypoints
    )
}

/// What a target takes, in words.
pub(super) fn limit_in_words(format: MissionFormat) -> String {
    format!("{} takes {}", format.in_words(), format.limit_in_words())
}

/// The parts of a mission, each of which the target takes, in their order. Their names are numbered. Nobody knows the ground
/// of a mission alone: its stops are told apart, and between them and the take-off the drone flies as it will.
///
/// The gimbal of a part begins where it was: the first stop says it, for the parts may be flown on
/// different days.
pub(super) fn parts(mission: &Mission, format: MissionFormat) -> Vec<Mission> {
    let pitches = mission.gimbal_pitches();
    let mut parts: Vec<Mission> = Vec::new();
    let mut used = 0;
    for (stop, pitch) in mission.stops.iter().zip(pitches) {
        let size = size(stop, format);
        if parts.is_empty() || used + size > format.most() {
            parts.push(Mission {
                stops: Vec::new(),
                ..mission.clone()
            });
            used = beside_stops(format);
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
