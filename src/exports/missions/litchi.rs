//! Litchi's CSV with its 46 columns (litchiutilities.com, "Litchi CSV Format Description").
//!
//! - The heading is flown only where the app's heading mode is Custom; that mode and the end of the
//!   mission are settings of the app and in no file.
//! - Heights above the place of take-off are `altitudemode` 0. Litchi's "above ground" takes the ground
//!   under the first waypoint to be as high as the place of take-off.
//! - The gimbal goes to its pitch on the way (`gimbalmode` 2) and once more at the stop by an action,
//!   which is done before the next one begins.

use std::fmt::Write;

use fragscale_core::plan::{Above, Finish, Mission, Stop, set_height};

use super::heights::metres_above;
use super::{angle, decimal, degrees, metres};
use crate::fault::Fault;
use crate::files::LITCHI_MARK;

const ACTIONS: usize = 15;

const WAIT: i32 = 0;
const PHOTO: i32 = 1;
const TILT: i32 = 5;

/// The longest wait of one action, in milliseconds (Litchi's forum, "DJI SDK Limits").
const LONGEST_WAIT: u32 = 32_767;

/// Waypoints that are closer are refused by the drone, in metres (likewise).
const CLOSEST: f64 = 0.6;

/// Its heights, in metres (likewise).
const HEIGHTS: (f64, f64) = (-200.0, 500.0);

/// The file of a mission.
pub(super) fn bytes(mission: &Mission, notes: &mut Vec<String>) -> Result<Vec<u8>, Fault> {
    notes.push("in Litchi set the heading mode to Custom (it ignores the file's headings in all others) and the path mode to straight lines (no actions in curves)".to_owned());
    let finish = match mission.finish {
        Finish::ReturnHome => "RTH",
        Finish::Hover => "None",
        Finish::Land => "Land",
        Finish::FirstStop => "Back to 1st",
    };
    notes.push(format!(
        "in Litchi set the finish action to {finish}: its files do not say it"
    ));
    if mission.safe_height.is_some() {
        notes.push("Litchi's files have no height to climb to first: the drone flies from where it is to the first waypoint".to_owned());
    }
    if let Some(height) = mission.return_height {
        notes.push(format!(
            "the file does not say how high the drone comes home: set its return-to-home height to {} m or more",
            set_height(height)
        ));
    }
    let mut text = header();
    let speed = mission.speed.unwrap_or(0.0);
    let mut heading = 0.0;
    for (stop, number) in mission.stops.iter().zip(1..) {
        let (mode, height) = match stop.height.above {
            Above::Ground => (1, stop.height.metres),
            _ => (0, metres_above(mission, stop, number, Above::TakeOff)?),
        };
        if !(HEIGHTS.0..=HEIGHTS.1).contains(&height) {
            let what = format!(
                "stop {number} is {height} m high, and Litchi flies from {} to {}",
                HEIGHTS.0, HEIGHTS.1
            );
            return Err(Fault::new(what, "take off nearer to it"));
        }
        match stop.heading {
            Some(own) => heading = own,
            None => notes.push(
                "stops without a heading have that of the stop before: Litchi's have one each"
                    .to_owned(),
            ),
        }
        let (gimbal, pitch) = stop.gimbal_pitch.map_or((0, 0.0), |pitch| (2, pitch));
        let actions = actions(stop, number)?;
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "{},{},{},{},0,0,{gimbal},{}",
            degrees(stop.latitude),
            degrees(stop.longitude),
            metres(height),
            angle(heading),
            angle(pitch)
        );
        for (kind, parameter) in actions {
            let _ = write!(text, ",{kind},{parameter}");
        }
        let _ = writeln!(text, ",{mode},{}{LITCHI_MARK}", decimal(speed, 3));
    }
    if mission
        .stops
        .windows(2)
        .any(|pair| matches!(pair, [a, b] if is_close(a, b)))
    {
        notes.push(format!("some waypoints are less than {CLOSEST} m apart, and DJI's drones below Litchi refuse such missions"));
    }
    Ok(text.into_bytes())
}

fn header() -> String {
    let mut text = String::from(
        "latitude,longitude,altitude(m),heading(deg),curvesize(m),rotationdir,gimbalmode,gimbalpitchangle",
    );
    for action in 1..=ACTIONS {
        let _ = write!(text, ",actiontype{action},actionparam{action}");
    }
    text += ",altitudemode,speed(m/s),poi_latitude,poi_longitude,poi_altitude(m),poi_altitudemode,photo_timeinterval,photo_distinterval\n";
    text
}

/// The kinds and parameters of a stop's actions, the rest being none.
fn actions(stop: &Stop, number: usize) -> Result<[(i32, String); ACTIONS], Fault> {
    let mut actions: Vec<(i32, String)> = Vec::new();
    if let Some(pitch) = stop.gimbal_pitch {
        actions.push((TILT, angle(pitch)));
    }
    // Longer waits are several.
    let mut left = stop.settle * 1000.0;
    while left >= 0.5 {
        let wait = left.min(f64::from(LONGEST_WAIT));
        actions.push((WAIT, decimal(wait, 0)));
        left -= wait;
    }
    if stop.photo.is_some() {
        actions.push((PHOTO, "0".to_owned()));
    }
    if actions.len() > ACTIONS {
        let what = format!(
            "stop {number} waits {} s, which takes more than Litchi's {ACTIONS} actions",
            stop.settle
        );
        return Err(Fault::new(what, "let it wait for less"));
    }
    let mut actions = actions.into_iter();
    Ok(std::array::from_fn(|_| {
        actions.next().unwrap_or((-1, "0".to_owned()))
    }))
}

/// Whether two stops are closer than a drone takes, on a sphere.
fn is_close(a: &Stop, b: &Stop) -> bool {
    const METRES_PER_DEGREE: f64 = 111_195.0;
    let north = (b.latitude - a.latitude) * METRES_PER_DEGREE;
    let east = (b.longitude - a.longitude) * METRES_PER_DEGREE * a.latitude.to_radians().cos();
    let up = b.height.metres - a.height.metres;
    (north * north + east * east + up * up).sqrt() < CLOSEST
}
