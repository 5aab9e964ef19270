//! A mission as MAVLink's commands for ArduPilot's Copter (mavlink.io, "MAV_CMD"; ArduPilot, "Mission
//! Commands"): take off, set the speed; at each stop 16 fly there, 115 turn, 1000 move the gimbal, 93
//! wait, 2000 shoot; return or land.
//!
//! - Copter ignores a waypoint's own yaw, so it turns by a command. The waypoint has it nevertheless, for
//!   who looks at the file.
//! - Nothing in MAVLink waits for a gimbal, and Copter's wait begins when it has arrived at the place:
//!   the wait has to cover turn and gimbal.
//! - Heights above take-off are of frame 3: they count from where the drone armed, not from the first
//!   stop.
//! - No parameter is NaN, MAVLink's word for "as it is": ArduPilot refuses a whole mission for one in any command but
//!   those of places (`AP_Mission::sanity_check_params`: `MAV_MISSION_INVALID_PARAM3`), and Mission Planner's reader
//!   passes over a line with one. Command 1000 has rates beside its angles: with both angles ArduPilot's
//!   `start_command_do_gimbal_manager_pitchyaw` never looks at them, and 0 is at rest for PX4.
//! - ArduPilot keeps the pitch of 1000 as an `int8_t` of degrees (`gimbal_manager_pitchyaw_Command`), cut towards 0: it is
//!   rounded here, which is nearer, and said. Command 205 (DO_MOUNT_CONTROL) would keep fractions, but where the gimbal has no yaw
//!   Copter takes it for a turn of the drone (`set_yaw_angle_offset`), which ends that of 115 on its way.

use fragscale_core::plan::{Above, Finish, Height, LostSignal, Mission, Stop, TakeOff, set_height};

use super::heights::metres_above;
use crate::fault::Fault;

/// One command.
pub(super) struct Command {
    /// `MAV_CMD`.
    pub(super) command: u32,
    /// `MAV_FRAME`.
    pub(super) frame: u32,
    /// Parameters 1 to 7.
    pub(super) parameters: [f64; 7],
}

const IN_MISSION: u32 = 2;
const ABOVE_HOME: u32 = 3;

/// The commands that a file has besides those of its stops: home, take-off, speed, the end.
pub(super) const BESIDE_STOPS: usize = 4;

/// A shorter wait may end before the drone has turned, in seconds: on its way it looks ahead, and Copter turns
/// by 60 degrees per second (ArduCopter's `AUTO_YAW_SLEW_RATE`), which for half a turn is 3 s. Gimbals are faster.
const SHORT_WAIT: f64 = 3.0;

/// A pitch that is nearer to a whole degree is that.
const NOT_WHOLE: f64 = 1e-3;

/// How many commands a stop has.
pub(super) fn commands_at(stop: &Stop) -> usize {
    1 + usize::from(stop.heading.is_some())
        + usize::from(stop.gimbal_pitch.is_some())
        + usize::from(stop.settle > 0.0)
        + usize::from(stop.photo.is_some())
}

fn other(command: u32, parameters: [f64; 7]) -> Command {
    Command {
        command,
        frame: IN_MISSION,
        parameters,
    }
}

/// Where the take-off of a file is: of a mission that does not say it, the first stop.
pub(super) fn home(mission: &Mission, notes: &mut Vec<String>) -> Result<TakeOff, Fault> {
    let Some(take_off) = mission.take_off else {
        let note = "the place of take-off is not known: the file has the first stop, and the drone takes its own when it arms";
        notes.push(note.to_owned());
        let first = mission
            .stops
            .first()
            .map_or((0.0, 0.0), |stop| (stop.latitude, stop.longitude));
        let (latitude, longitude) = first;
        return Ok(TakeOff {
            latitude,
            longitude,
            elevation: None,
        });
    };
    // Above mean sea level; it is shown and not flown.
    let (latitude, longitude) = (take_off.latitude, take_off.longitude);
    let sea = |height| mission.height_above(latitude, longitude, height, Above::Geoid);
    let elevation = take_off.elevation.and_then(sea).map(|metres| Height {
        metres,
        above: Above::Geoid,
    });
    if elevation.is_none() {
        let note = "how high the place of take-off lies is not known: it stands as 0 m in the file, which is shown and not flown";
        notes.push(note.to_owned());
    }
    Ok(TakeOff {
        elevation,
        ..take_off
    })
}

/// The commands of a mission without home.
///
/// # Errors
/// Where a height cannot be brought to what MAVLink's heights count from.
pub(super) fn commands(mission: &Mission, notes: &mut Vec<String>) -> Result<Vec<Command>, Fault> {
    notes.push(
        "the file is for ArduPilot's Copter; PX4 does not take the command that turns (115)"
            .to_owned(),
    );
    if let Some(height) = mission.return_height.map(set_height) {
        notes.push(format!(
            "the file does not say how high the drone comes home: set ArduPilot's RTL_ALT to {} or more (centimetres; RTL_ALT_M {height} in newer versions)",
            100.0 * height
        ));
    }
    if mission.lost_signal == Some(LostSignal::Hover) {
        notes.push(
            "ArduPilot comes straight home where the radio is lost, unless FS_THR_ENABLE says otherwise: 7 stays (Brake or Land), 5 comes back as it flew (SmartRTL or Land)"
                .to_owned(),
        );
    }
    let mut commands = Vec::new();
    match mission.safe_height {
        Some(height) => {
            let place = mission
                .take_off
                .map_or([0.0; 2], |at| [at.latitude, at.longitude]);
            // Copter takes off without turning, whatever the yaw.
            commands.push(Command {
                command: 22,
                frame: ABOVE_HOME,
                parameters: [0.0, 0.0, 0.0, 0.0, place[0], place[1], height],
            });
        }
        None => notes.push(
            "no height to climb to is known: the file has no take-off, fly up by hand".to_owned(),
        ),
    }
    if let Some(speed) = mission.speed {
        // Over ground, throttle as it is.
        commands.push(other(178, [1.0, speed, -1.0, 0.0, 0.0, 0.0, 0.0]));
    }
    for (stop, number) in mission.stops.iter().zip(1..) {
        let (frame, metres) = match stop.height.above {
            Above::TakeOff => (ABOVE_HOME, stop.height.metres),
            Above::Ground => (10, stop.height.metres),
            _ => (0, metres_above(mission, stop, number, Above::Geoid)?),
        };
        if frame == 10 {
            notes.push(
                "heights above ground need terrain data on the drone (TERRAIN_ENABLE)".to_owned(),
            );
        }
        // Of a stop without a heading 0: Copter ignores it.
        let yaw = stop.heading.unwrap_or(0.0);
        commands.push(Command {
            command: 16,
            frame,
            parameters: [0.0, 0.0, 0.0, yaw, stop.latitude, stop.longitude, metres],
        });
        aim_and_shoot(stop, &mut commands, notes);
    }
    match mission.finish {
        Finish::ReturnHome => commands.push(other(20, [0.0; 7])),
        // Where it is.
        Finish::Land => commands.push(Command {
            command: 21,
            frame: ABOVE_HOME,
            parameters: [0.0; 7],
        }),
        Finish::Hover => {}
        Finish::FirstStop => notes.push(
            "the file does not say that the drone flies to the first stop at the end: it hovers at the last".to_owned(),
        ),
    }
    Ok(commands)
}

/// What is done at a stop. The order is what makes the photo: see `a_gimbal_arrives_before_the_shot`.
fn aim_and_shoot(stop: &Stop, commands: &mut Vec<Command>, notes: &mut Vec<String>) {
    if let Some(heading) = stop.heading {
        // An absolute angle, the short way round.
        commands.push(other(115, [heading, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    }
    if let Some(pitch) = stop.gimbal_pitch {
        // Of a tilt under half a degree 0, not -0.
        let whole = pitch.round() + 0.0;
        if (whole - pitch).abs() > NOT_WHOLE {
            notes.push(
                "ArduPilot keeps the gimbal's pitch in whole degrees: it is rounded, by up to 0.5 degrees"
                    .to_owned(),
            );
        }
        // Roll and pitch stay with the horizon (4 + 8), the yaw follows the nose.
        commands.push(other(1000, [whole, 0.0, 0.0, 0.0, 12.0, 0.0, 0.0]));
    }
    if stop.settle > 0.0 {
        commands.push(other(93, [stop.settle, -1.0, -1.0, -1.0, 0.0, 0.0, 0.0]));
    }
    if stop.photo.is_some() {
        if stop.settle < SHORT_WAIT && (stop.gimbal_pitch.is_some() || stop.heading.is_some()) {
            notes.push(format!(
                "ArduPilot waits for no gimbal, and some photos have less than {SHORT_WAIT} s for turn and gimbal: let the drone settle for longer"
            ));
        }
        commands.push(other(2000, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]));
    }
}
