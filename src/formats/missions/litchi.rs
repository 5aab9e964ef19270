//! Litchi's CSV (litchiutilities.com, "Litchi CSV Format Description"): 46 columns, of which 30 are 15
//! pairs of an action and its parameter; older files have the 16 others alone.
//!
//! - `altitudemode` 0 counts from the place of take-off, 1 from the ground.
//! - `gimbalmode` 0 leaves the gimbal alone, 1 looks at a point, 2 goes to `gimbalpitchangle`.
//! - Actions: -1 none, 0 wait (ms), 1 photo, 2 and 3 video on and off, 4 turn (degrees), 5 tilt (degrees).
//! - The heading is flown only where the app's heading mode is Custom. That mode, the end of the mission
//!   and the speed of a waypoint that says 0 are settings of the app and in no file.

use fragscale_core::plan::{Above, Finish, Height, Mission};

use super::MissionFile;
use super::route::Route;
use crate::fault::Fault;
use crate::tables::table::{NumberRepairs, Row, Table, key};
use crate::text::notes::Notes;

/// Without and with actions.
const COLUMNS: [usize; 2] = [16, 46];

/// Where the actions begin.
const FIRST_ACTION: usize = 8;

const FOOT: f64 = 0.3048;

/// Whether a line names Litchi's columns.
pub(super) fn is_header(line: &str) -> bool {
    // A spreadsheet of a country with decimal commas saves semicolons.
    let names = line.split([',', ';', '\t']).take(8).map(key);
    let names: Vec<String> = names.collect();
    names.first().is_some_and(|name| name == "latitude")
        && names.get(1).is_some_and(|name| name == "longitude")
        && names.iter().any(|name| name == "gimbalmode")
}

/// Reads a table whose first line is such.
pub(super) fn read(text: &str) -> Result<MissionFile, Fault> {
    let table = Table::read(text)?;
    let count = table.header().len();
    if !COLUMNS.contains(&count) {
        let what = format!("it has {count} columns; Litchi writes 16 or 46");
        let remedy = "export it from Litchi again";
        return Err(Fault::at(table.header_line(), what, remedy));
    }
    let columns = Columns::of(&table)?;
    let mut notes = Notes::default();
    notes.say("its headings are flown only where Litchi's heading mode is Custom");
    notes.say("what happens at the end is a setting of the app: read as hovering");
    let mut route = Route::default();
    let mut speeds = Vec::new();
    for (row, number) in table.rows().iter().zip(1_usize..) {
        speeds.push(add(&table, &columns, row, number, &mut route, &mut notes)?);
    }
    let speed = speeds.iter().copied().find(|speed| *speed > 0.0);
    match speed {
        None => notes.say("its speed is a setting of the app: not read"),
        Some(first) if speeds.iter().any(|speed| *speed != first) => {
            notes.say("its speeds differ: only the first is read");
        }
        Some(_) => {}
    }
    let mission = Mission {
        speed,
        finish: Finish::Hover,
        stops: route.stops(),
        ..Mission::default()
    };
    Ok(MissionFile {
        mission,
        format: "a CSV of Litchi",
        notes: notes.sentences(),
    })
}

/// Where what is read stands.
struct Columns {
    latitude: usize,
    longitude: usize,
    altitude: usize,
    /// Of the altitude.
    metres: f64,
    heading: usize,
    gimbal_mode: usize,
    gimbal_pitch: usize,
    altitude_mode: usize,
    speed: usize,
    /// Of the speed, in m/s.
    metres_per_second: f64,
    photo_time: usize,
    photo_distance: usize,
    actions: usize,
}

impl Columns {
    fn of(table: &Table) -> Result<Self, Fault> {
        let unit = |names: [&str; 2]| match table.column(names[0]) {
            Ok(column) => Ok((column, true)),
            Err(fault) => table
                .column(names[1])
                .map(|c| (c, false))
                .map_err(|_| fault),
        };
        let (altitude, is_metric) = unit(["altitude(m)", "altitude(ft)"])?;
        let (speed, is_metres) = unit(["speed(m/s)", "speed(mph)"])?;
        Ok(Self {
            latitude: table.column("latitude")?,
            longitude: table.column("longitude")?,
            altitude,
            metres: if is_metric { 1.0 } else { FOOT },
            heading: table.column("heading(deg)")?,
            gimbal_mode: table.column("gimbalmode")?,
            gimbal_pitch: table.column("gimbalpitchangle")?,
            altitude_mode: table.column("altitudemode")?,
            speed,
            metres_per_second: if is_metres { 1.0 } else { 0.44704 },
            photo_time: table.column("photo_timeinterval")?,
            photo_distance: table.column("photo_distinterval")?,
            actions: (table.header().len() - COLUMNS[0]) / 2,
        })
    }
}

/// Adds waypoint `number`, from 1; its speed in m/s.
fn add(
    table: &Table,
    columns: &Columns,
    row: &Row,
    number: usize,
    route: &mut Route,
    notes: &mut Notes,
) -> Result<f64, Fault> {
    let mut repairs = NumberRepairs::default();
    let place = format_args!("waypoint {number}").to_string();
    let mut number = |column| {
        let found = table.number(row, column, &mut repairs)?;
        found.ok_or_else(|| table.no_number(row, column))
    };
    let above = match number(columns.altitude_mode)? {
        0.0 => Above::TakeOff,
        1.0 => Above::Ground,
        other => {
            let what = format!("altitudemode is {other}, neither 0 nor 1");
            return Err(Fault::at(row.line, what, "export it from Litchi again"));
        }
    };
    let metres = number(columns.altitude)? * columns.metres;
    let (latitude, longitude) = (number(columns.latitude)?, number(columns.longitude)?);
    route.arrive(latitude, longitude, Height { metres, above });
    route.turn(number(columns.heading)?);
    let pitch = number(columns.gimbal_pitch)?;
    match number(columns.gimbal_mode)? {
        2.0 => route.pitch(pitch),
        1.0 => notes.at("looking at a point (POI) is not read", &place),
        _ if pitch != 0.0 => {
            notes.at("a gimbal's pitch is not flown: its gimbalmode is 0", &place);
        }
        _ => {}
    }
    for action in 0..columns.actions {
        let column = FIRST_ACTION + 2 * action;
        let (kind, parameter) = (number(column)?, number(column + 1)?);
        match kind {
            -1.0 => {}
            0.0 => route.wait(parameter.max(0.0) / 1000.0),
            1.0 => {
                route.shoot(None);
            }
            2.0 | 3.0 => notes.at("video is not read", &place),
            4.0 => route.turn(parameter),
            5.0 => route.pitch(parameter),
            other => notes.at(format!("action {other} is passed over"), &place),
        }
    }
    if number(columns.photo_time)? > 0.0 || number(columns.photo_distance)? > 0.0 {
        notes.at("photos by distance or time are no stops: not read", &place);
    }
    let speed = number(columns.speed)? * columns.metres_per_second;
    notes_of(&repairs, notes);
    Ok(speed)
}

fn notes_of(repairs: &NumberRepairs, notes: &mut Notes) {
    if repairs.has_decimal_commas() {
        notes.say("decimal commas are read as decimal points");
    }
}
