//! What MAVLink's mission commands tell a drone (mavlink.io, "MAV_CMD", "MAV_FRAME"): shared by
//! QGroundControl's and Mission Planner's files.
//!
//! - Frames 0 and 5 count heights from mean sea level, which autopilots take from their receivers and thus
//!   from EGM96; 3 and 6 from home, where the drone took off; 10 and 11 from the ground; 2 is for what has
//!   no place.
//! - ArduPilot's Copter ignores the yaw of a waypoint (parameter 4) and goes by CONDITION_YAW; PX4 the
//!   other way round.
//! - A gimbal's yaw counts from the drone's nose, or from north if its flag says so (YAW_LOCK, 16).

use fragscale_core::plan::{Above, Finish, Height, Stop, TakeOff};

use super::heading;
use super::route::Route;
use crate::fault::Fault;
use crate::text::notes::Notes;

const WAYPOINT: u32 = 16;
const LOITER: u32 = 17;
const LOITER_TURNS: u32 = 18;
const LOITER_TIME: u32 = 19;
const RETURN: u32 = 20;
const LAND: u32 = 21;
const TAKE_OFF: u32 = 22;
const SPLINE: u32 = 82;
const DELAY: u32 = 93;
const CONDITION_DELAY: u32 = 112;
const CONDITION_YAW: u32 = 115;
const JUMP: u32 = 177;
const SPEED: u32 = 178;
const REGIONS_OF_INTEREST: [u32; 5] = [80, 195, 196, 197, 201];
const DIGICAM_CONTROL: u32 = 203;
const MOUNT_CONTROL: u32 = 205;
const BY_DISTANCE: u32 = 206;
const BY_TIME: u32 = 214;
const CAMERA_MODE: u32 = 530;
const GIMBAL: u32 = 1000;
const GIMBAL_CONFIGURE: u32 = 1001;
const SHOOT: u32 = 2000;

const YAW_LOCK: f64 = 16.0;

/// One command.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    /// `MAV_CMD`.
    pub(super) command: u32,
    /// `MAV_FRAME`.
    pub(super) frame: u32,
    /// Parameters 1 to 7; the last three are latitude and longitude in degrees and height in metres.
    /// NaN where nothing is said.
    pub(super) parameters: [f64; 7],
    /// Where it stands, for people.
    pub(super) place: Place,
}

/// Where a command stands in its file.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place {
    /// A line, from 1.
    Line(u64),
    /// An item, from 1, and one inside it, from 1.
    Item(usize, Option<usize>),
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Item(item, None) => write!(f, "item {item}"),
            Self::Item(item, Some(inner)) => write!(f, "item {item}.{inner}"),
        }
    }
}

/// Who flies by the commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Autopilot {
    /// Waypoints have a yaw.
    Px4,
    /// They have none.
    ArduPilot,
}

/// Home: degrees, and metres above mean sea level, of which ground stations write 0 where they do not know.
/// `None` at 0, 0, which is nobody's.
pub(super) fn home(latitude: f64, longitude: f64, metres: f64) -> Option<TakeOff> {
    let is_known = metres != 0.0 && metres.is_finite();
    (latitude != 0.0 || longitude != 0.0).then_some(TakeOff {
        latitude,
        longitude,
        elevation: is_known.then_some(Height {
            metres,
            above: Above::Geoid,
        }),
    })
}

/// What the commands tell.
#[derive(Debug, Default)]
pub(super) struct Told {
    pub(super) stops: Vec<Stop>,
    pub(super) speed: Option<f64>,
    pub(super) safe_height: Option<f64>,
    pub(super) finish: Finish,
    /// Latitude and longitude of the command to take off, where it has them.
    pub(super) take_off: Option<[f64; 2]>,
}

/// What commands tell a drone, in their order.
///
/// # Errors
/// Where a waypoint has no place or a frame that is no frame of places.
pub(super) fn told(items: &[Item], autopilot: Autopilot, notes: &mut Notes) -> Result<Told, Fault> {
    let mut told = Told::default();
    let mut route = Route::default();
    for (index, item) in items.iter().enumerate() {
        let [p1, p2, p3, p4, x, y, z] = item.parameters;
        let place = item.place;
        match item.command {
            WAYPOINT | SPLINE | LOITER | LOITER_TURNS | LOITER_TIME => {
                let height = height_of(item)?;
                if height.above == Above::Geoid {
                    notes.say(
                        "its absolute heights are above mean sea level: taken as the geoid EGM96",
                    );
                }
                // A place that is not said is where the drone is.
                if x == 0.0 && y == 0.0 {
                    notes.at("a waypoint without a place is passed over", place);
                    continue;
                }
                route.arrive(x, y, height);
                match item.command {
                    WAYPOINT | LOITER_TIME if p1 > 0.0 => route.wait(p1),
                    SPLINE => notes.at("splines are read as straight lines", place),
                    LOITER => notes.at("it waits here until somebody takes over", place),
                    LOITER_TURNS => notes.at("its turns around a place are not read", place),
                    _ => {}
                }
                if item.command == WAYPOINT && p4.is_finite() {
                    match autopilot {
                        Autopilot::Px4 => route.turn(p4),
                        Autopilot::ArduPilot if p4 == 0.0 || turns_here(items, index) => {}
                        Autopilot::ArduPilot => {
                            notes.at(
                                "the yaw of a waypoint is passed over: Copter ignores it",
                                place,
                            );
                        }
                    }
                }
            }
            TAKE_OFF => {
                if x.is_finite() && y.is_finite() && (x != 0.0 || y != 0.0) {
                    told.take_off.get_or_insert([x, y]);
                }
                match above(item.frame) {
                    Some(Above::TakeOff) if z.is_finite() => {
                        told.safe_height.get_or_insert(z);
                    }
                    _ => notes.at("its take-off does not say how high above itself", place),
                }
            }
            RETURN | LAND => {
                told.finish = match item.command {
                    RETURN => Finish::ReturnHome,
                    _ => Finish::Land,
                };
                if item.command == LAND && x.is_finite() && (x != 0.0 || y != 0.0) {
                    notes.at("it lands at a place of its own, which is not read", place);
                }
                let more = items.len() - index - 1;
                if more > 0 {
                    notes.at(
                        format!("{more} commands behind the end are passed over"),
                        place,
                    );
                }
                break;
            }
            DELAY | CONDITION_DELAY if p1 > 0.0 => route.wait(p1),
            DELAY => notes.at("a wait until a time of day is passed over", place),
            CONDITION_DELAY => {}
            CONDITION_YAW if p4 == 1.0 => match route.heading() {
                Some(from) => {
                    let sign = if p3 < 0.0 { -1.0 } else { 1.0 };
                    route.turn(from + sign * p1);
                }
                None => notes.at("a turn from an unknown heading is passed over", place),
            },
            CONDITION_YAW if p1.is_finite() => route.turn(p1),
            GIMBAL => {
                if p1.is_finite() {
                    route.pitch(p1);
                }
                let is_of_north = x.is_finite() && (x / YAW_LOCK).floor() % 2.0 == 1.0;
                gimbal_yaw(&mut route, p2, is_of_north, notes, place);
            }
            MOUNT_CONTROL => {
                if p1.is_finite() {
                    route.pitch(p1);
                }
                gimbal_yaw(&mut route, p3, false, notes, place);
            }
            SHOOT if p3 == 1.0 => shoot(&mut route, notes, place),
            DIGICAM_CONTROL if x == 1.0 => shoot(&mut route, notes, place),
            SHOOT | BY_DISTANCE | BY_TIME => {
                notes.at("photos by distance or time are no stops: not read", place);
            }
            SPEED if p2 > 0.0 => match told.speed {
                None => told.speed = Some(p2),
                Some(speed) if speed == p2 => {}
                Some(_) => notes.at("only the first speed is read", place),
            },
            // What is set of a camera or a gimbal before it is used.
            SPEED | CAMERA_MODE | GIMBAL_CONFIGURE | DIGICAM_CONTROL => {}
            JUMP => notes.at("jumps are not followed", place),
            command if REGIONS_OF_INTEREST.contains(&command) => {
                notes.at("looking at a place (ROI) is not read", place);
            }
            command => notes.at(format!("command {command} is passed over"), place),
        }
    }
    told.stops = route.stops();
    Ok(told)
}

fn shoot(route: &mut Route, notes: &mut Notes, place: Place) {
    if !route.shoot(None) {
        notes.at("a photo before the first waypoint is passed over", place);
    }
}

/// The yaw of a gimbal is where the camera looks.
fn gimbal_yaw(route: &mut Route, yaw: f64, is_of_north: bool, notes: &mut Notes, place: Place) {
    if is_of_north && yaw.is_finite() {
        route.turn(yaw);
    } else if yaw.is_finite() && yaw != 0.0 {
        match route.heading() {
            Some(nose) => route.turn(heading(nose + yaw)),
            None => notes.at(
                "a gimbal's yaw from an unknown heading is passed over",
                place,
            ),
        }
    }
}

/// Whether the drone is told to turn before it flies on.
fn turns_here(items: &[Item], index: usize) -> bool {
    let behind = items.iter().skip(index + 1);
    behind
        .take_while(|item| !matches!(item.command, WAYPOINT | SPLINE | RETURN | LAND))
        .any(|item| item.command == CONDITION_YAW)
}

/// What the heights of a frame count from.
pub(super) fn above(frame: u32) -> Option<Above> {
    match frame {
        0 | 5 => Some(Above::Geoid),
        3 | 6 => Some(Above::TakeOff),
        10 | 11 => Some(Above::Ground),
        _ => None,
    }
}

fn height_of(item: &Item) -> Result<Height, Fault> {
    let [.., x, y, metres] = item.parameters;
    let fault = |what: String| {
        let remedy = "export the mission again";
        match item.place {
            Place::Line(line) => Fault::at(line, what, remedy),
            place => Fault::new(format!("{place}: {what}"), remedy),
        }
    };
    let Some(above) = above(item.frame) else {
        let frame = item.frame;
        return Err(fault(format!(
            "a waypoint in frame {frame}, which is none of places"
        )));
    };
    if !(x.is_finite() && y.is_finite() && metres.is_finite()) {
        return Err(fault(
            "a waypoint without latitude, longitude and height".to_owned(),
        ));
    }
    Ok(Height { metres, above })
}
