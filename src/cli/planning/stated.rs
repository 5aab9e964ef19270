//! What a mission's file does not say and another ground station asks for, as it is typed.

use clap::{Args, ValueEnum};
use glam::DVec2;

use crate::cli::on_surface::places::place;
use crate::cli::planning::flying::speed;
use crate::fault::Fault;
use crate::plan::{Above, Height, Mission, TakeOff};

#[derive(Debug, Args)]
pub(super) struct StatedArguments {
    /// Metres a second between stops, where the file does not say it, or instead of what it says.
    #[arg(long, value_name = "M/S", value_parser = speed, allow_hyphen_values = true)]
    speed: Option<f64>,
    /// Metres above the take-off that the drone climbs to before the first stop, likewise. Nobody checks it against the
    /// ground.
    #[arg(long, value_name = "METRES", value_parser = number, allow_hyphen_values = true)]
    safe_height: Option<f64>,
    /// Where the drone takes off, in degrees of WGS 84, likewise.
    #[arg(long, value_name = "LATITUDE,LONGITUDE", value_parser = take_off, allow_hyphen_values = true)]
    take_off: Option<DVec2>,
    /// The elevation of the take-off in metres, likewise: of files whose heights are absolute, for drones that count
    /// from there.
    #[arg(long, value_name = "METRES", value_parser = number, allow_hyphen_values = true, requires = "datum")]
    elevation: Option<f64>,
    /// What --elevation, and absolute heights of a file that does not say it, count from.
    #[arg(long, value_enum, value_name = "DATUM")]
    datum: Option<Datum>,
}

/// What absolute heights count from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Datum {
    /// The ellipsoid of WGS 84, as RTK gives them.
    Ellipsoid,
    /// The geoid EGM96: mean sea level.
    Geoid,
}

impl Datum {
    fn above(self) -> Above {
        match self {
            Self::Ellipsoid => Above::Ellipsoid,
            Self::Geoid => Above::Geoid,
        }
    }
}

fn number(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.ok_or_else(|| "give a number of metres".to_owned())
}

/// Latitude and longitude. What is no place of the Earth is metres of a map, or the longitude first.
fn take_off(text: &str) -> Result<DVec2, String> {
    let place = place(text).map_err(|_| {
        "write the latitude and the longitude in degrees, with a comma between them".to_owned()
    })?;
    for (name, degrees, most) in [("latitude", place.x, 90.0), ("longitude", place.y, 180.0)] {
        if degrees.abs() > most {
            return Err(format!("a {name} lies between -{most} and {most} degrees"));
        }
    }
    Ok(place)
}

impl StatedArguments {
    /// Puts what was stated into a mission; what the file said otherwise is told, a sentence each.
    ///
    /// # Errors
    /// Where nobody says where the take-off is whose elevation was stated; where no drone could be told it.
    pub(super) fn apply(&self, mission: &mut Mission) -> Result<Vec<String>, String> {
        let mut told = Vec::new();
        let mut instead = |name: &str, before: Option<f64>, now: f64, unit: &str| {
            if let Some(before) = before.filter(|before| *before != now) {
                told.push(format!(
                    "--{name} {now} is taken; the file says {before} {unit}"
                ));
            }
        };
        if let Some(speed) = self.speed {
            instead("speed", mission.speed, speed, "m/s");
            mission.speed = Some(speed);
        }
        if let Some(height) = self.safe_height {
            instead("safe-height", mission.safe_height, height, "m");
            mission.safe_height = Some(height);
        }
        if let Some(place) = self.take_off {
            if let Some(before) = mission.take_off {
                told.push(format!(
                    "--take-off is taken; the file says {:.7}, {:.7}",
                    before.latitude, before.longitude
                ));
            }
            if let Some(fault) = too_far(mission, place) {
                return Err(fault.to_string());
            }
            mission.take_off = Some(take_off_at(place));
        }
        if let Some(above) = self.datum.map(Datum::above) {
            let state = |height: &mut Height| {
                if height.above == Above::Unknown {
                    height.above = above;
                }
            };
            mission
                .stops
                .iter_mut()
                .for_each(|stop| state(&mut stop.height));
            let elevation = mission
                .take_off
                .as_mut()
                .and_then(|at| at.elevation.as_mut());
            if let Some(elevation) = elevation {
                state(elevation);
            }
            if let Some(metres) = self.elevation {
                let Some(take_off) = &mut mission.take_off else {
                    let what = "elevation: nobody says where the take-off is";
                    return Err(format!(
                        "{what}; say it, too: --take-off LATITUDE,LONGITUDE"
                    ));
                };
                let before = take_off.elevation.replace(Height { metres, above });
                if let Some(before) =
                    before.filter(|before| (before.metres, before.above) != (metres, above))
                {
                    told.push(format!(
                        "--elevation {metres} is taken; the file says {} m above {}",
                        before.metres,
                        before.above.in_words()
                    ));
                }
            }
        }
        // The file was good: what is wrong now was typed.
        mission.check().map_err(|fault| fault.to_string())?;
        Ok(told)
    }
}

fn take_off_at(place: DVec2) -> TakeOff {
    TakeOff {
        latitude: place.x,
        longitude: place.y,
        elevation: None,
    }
}

/// Why nobody takes off there, and what was meant, if that can be told.
fn too_far(mission: &Mission, place: DVec2) -> Option<Fault> {
    let kilometres = mission.to_nearest_stop(place)?;
    if kilometres <= Mission::FARTHEST {
        return None;
    }
    let is_near = |place: DVec2| {
        let is_latitude = place.x.abs() <= 90.0;
        is_latitude
            && mission
                .to_nearest_stop(place)
                .is_some_and(|to| to <= Mission::FARTHEST)
    };
    let ways = [
        ("swapped", DVec2::new(place.y, place.x)),
        (
            "with the other sign of the latitude",
            DVec2::new(-place.x, place.y),
        ),
        (
            "with the other sign of the longitude",
            DVec2::new(place.x, -place.y),
        ),
        ("with the other signs", -place),
    ];
    let rule = "the latitude comes first, then the longitude; south and west are negative";
    let remedy = match ways.iter().find(|(_, place)| is_near(*place)) {
        Some((way, near)) => format!("{way}, {},{} lies near them: {rule}", near.x, near.y),
        None => format!("check both numbers: {rule}"),
    };
    let decimals = usize::from(kilometres < 10.0);
    let what = format!("take-off: the nearest stop lies {kilometres:.decimals$} km from there");
    Some(Fault::new(what, remedy))
}
