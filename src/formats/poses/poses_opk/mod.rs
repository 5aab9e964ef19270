//! Poses by three angles as photogrammetric programs list them; Orthority's documentation ("CSV
//! exterior parameters", "Legacy", "Orthority exterior parameters") states the forms most fully.
//!
//! - A table with a header: `filename,x,y,z,omega,phi,kappa[,camera]` in any order; `easting`,
//!   `northing` and `altitude`, `height` or `alt` stand for x, y, z. Other columns are passed over.
//! - A table without: `name x y z omega phi kappa [camera]` on every line.
//! - Orthority's other forms, whose photo's column is `filename` and no other: `latitude`, `longitude`,
//!   `altitude` (WGS 84 with heights above the ellipsoid: EPSG:4979) in place of x, y, z, and `roll`,
//!   `pitch`, `yaw` in place of omega, phi, kappa. Angles to a map's axes beside degrees are refused:
//!   the file does not name that map.
//! - RealityCapture's `#name,X/Lon,Y/Lat,Z/Alt,` and then `omega,phi,kappa` or `yaw,pitch,roll`, whose
//!   angles are its own (see `realitycapture`).
//! - GeoJSON whose features have the properties `filename`, `camera`, `xyz`, `opk` (radians here), and
//!   whose member `world_crs` states the system.
//!
//! Fields stand between commas, semicolons, tabs, colons or white space, and may be quoted (see
//! `separated`). Lines that begin with # are comments, but for the header; one that names a yaw or
//! heading in another form is refused. The coordinate system stands in a .prj beside the table.
//!
//! Angles are degrees. Rx(omega) Ry(phi) Rz(kappa) takes photogrammetric camera axes (PATB's: x right,
//! y up, z back) to the world, as in poses.csv. Orthority's roll, pitch, yaw are those of the drone's
//! BODY, not of a gimbal (its `param_io`, after Pix4D's "Yaw, Pitch, Roll and Omega, Phi, Kappa
//! angles"): Rz(yaw) Ry(pitch) Rx(roll) takes body axes (x front, y right, z down) to north, east and
//! down at the photo's own place, and a camera at rest in the body looks down with the image's top to
//! the front. So all zero looks straight down with the top to the north, a pitch of 30 looks forward
//! by 30 degrees. On a map these are turned by the convergence of its meridians.

mod columns;

use std::collections::HashMap;

use glam::DVec3;
use serde::Deserialize;

use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::text_from_bytes;
use crate::geodesy::Crs;
use crate::poses::odd_angles::OddAngles;
use crate::poses::poses_csv::{PoseLine, PosesFile};
use crate::scale::PoseErrors;
use crate::text::fields::shown;
use crate::text::json;
use crate::text::separated::{Numbers, Separator};
use columns::{Angles, DEGREES, Header, SILENT, find, is_row};

/// Whether the first lines are such a table's.
pub(crate) fn is_table(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    lines.find_map(|line| {
        let fields = Separator::of(line).split(line);
        if Header::of(&fields).is_some() {
            return Some(true);
        }
        let is_comment = line.trim_start().starts_with('#');
        (!is_comment).then(|| is_row(&fields))
    }) == Some(true)
}

/// Whether the bytes are GeoJSON of such poses.
pub(crate) fn is_geojson(start: &[u8]) -> bool {
    let start = start.get(..4096).unwrap_or(start);
    let text = String::from_utf8_lossy(start);
    ["\"FeatureCollection\"", "\"opk\"", "\"xyz\""]
        .iter()
        .all(|word| text.contains(word))
}

/// Reads a table. `system` is the coordinate system that stands beside it, if any.
///
/// # Errors
/// With the line: a field that is missing or no finite number, a photo named twice, angles whose axes
/// nobody names; no photo.
pub(crate) fn read_table(bytes: &[u8], system: Option<&str>) -> Result<PosesFile, Fault> {
    let text = text_from_bytes(bytes)?;
    let mut header = None;
    // Whether no line names the columns.
    let mut is_silent = false;
    let mut list = List::default();
    let numbers = Numbers::of(text);
    let mut odd = OddAngles::default();
    for (line, text) in (1..).zip(text.lines()) {
        if text.trim().is_empty() {
            continue;
        }
        let separator = Separator::of(text);
        let fields = separator.split(text);
        if header.is_none() {
            header = Header::of(&fields);
            if let Some(header) = &header {
                if header.in_degrees && header.angles == Angles::OmegaPhiKappa {
                    let what =
                        "omega, phi and kappa turn to the axes of a map, which degrees do not name";
                    let remedy = "give x, y, z on that map, or roll, pitch, yaw";
                    return Err(Fault::at(line, what, remedy));
                }
                continue;
            }
        }
        if text.trim_start().starts_with('#') {
            if header.is_none() && find(&fields, &["yaw", "heading"]).is_some() {
                let what = "its angles are not omega, phi and kappa";
                return Err(Fault::at(line, what, "write them as a poses.csv"));
            }
            continue;
        }
        is_silent |= header.is_none();
        let Header {
            places,
            camera,
            names,
            angles,
            ..
        } = *header.get_or_insert(SILENT);
        let name_of = |index: usize| names.get(index).and_then(|names| names.first());
        let field = |index: usize| {
            let field = places.get(index).and_then(|&place| fields.get(place));
            field.filter(|field| !field.is_empty()).ok_or_else(|| {
                let what = format!("the line has no {}", name_of(index).unwrap_or(&""));
                Fault::at(line, what, "complete the line")
            })
        };
        let number = |index: usize| {
            let number = numbers.read(field(index)?, line);
            number.map_err(|why| {
                let what = format!("{} {why}", name_of(index).unwrap_or(&""));
                Fault::at(line, what, "write a number with a decimal point")
            })
        };
        let center = DVec3::new(number(1)?, number(2)?, number(3)?);
        let turned = [number(4)?, number(5)?, number(6)?];
        if is_silent && is_quaternion(turned, fields.get(7)) {
            let what = "no line names the columns, and the last four numbers may be a quaternion or angles";
            let remedy = "begin with a line such as photo,x,y,z,qx,qy,qz,qw";
            return Err(Fault::at(line, what, remedy));
        }
        odd.angles(&turned);
        let camera = camera.and_then(|column| fields.get(column));
        list.add(PoseLine {
            photo: field(0)?.clone(),
            camera: camera.filter(|name| !name.is_empty()).cloned(),
            pose: angles.pose(center, turned),
            errors: PoseErrors::default(),
            line,
        })?;
    }
    let header = header.unwrap_or(SILENT);
    let mut file = list.finish(header.in_degrees.then(|| DEGREES.to_owned()))?;
    file.warnings = numbers.warnings();
    if is_silent {
        let said =
            "no line names its columns: they are taken for photo, x, y, z, omega, phi, kappa";
        file.warnings.push(said.to_owned());
    }
    file.take_odd(&odd);
    if header.angles == Angles::OfBody && !header.in_degrees {
        turn_to_the_map(&mut file, system)?;
    }
    Ok(file)
}

/// Whether three numbers and the field behind them, where a camera may be named, are as long together as a rotation's quaternion.
fn is_quaternion(first: [f64; 3], last: Option<&String>) -> bool {
    let Some(last) = last.and_then(|field| field.parse::<f64>().ok()) else {
        return false;
    };
    let square: f64 = first.iter().chain([&last]).map(|part| part * part).sum();
    (square - 1.0).abs() < 0.01
}

/// Turns rotations to true north, east and up to the axes of the map that the positions are on.
fn turn_to_the_map(file: &mut PosesFile, system: Option<&str>) -> Result<(), Fault> {
    let Some(Ok(map)) = system.map(Crs::understand) else {
        file.warnings.push(
            "its yaw counts from true north, and no .prj beside it names the map that x and y are on: \
             it is taken to count from +y, which differs by up to some degrees"
                .to_owned(),
        );
        return Ok(());
    };
    for line in &mut file.lines {
        let place = map.to_geographic(line.pose.center);
        let turn = place.and_then(|place| map.grid_from_enu(place));
        let turn = turn.ok_or_else(|| {
            let what = format!(
                "'{}' is at no place on the map of the .prj",
                shown(&line.photo)
            );
            Fault::at(line.line, what, "check the .prj and the positions")
        })?;
        line.pose.rotation = turn * line.pose.rotation;
    }
    Ok(())
}

#[derive(Deserialize)]
struct Collection {
    world_crs: Option<String>,
    features: Vec<Feature>,
}

#[derive(Deserialize)]
struct Feature {
    properties: Properties,
}

#[derive(Deserialize)]
struct Properties {
    filename: String,
    camera: Option<String>,
    xyz: [f64; 3],
    opk: [f64; 3],
}

/// Reads GeoJSON.
///
/// # Errors
/// What is no such GeoJSON, with the line; a photo named twice; no photo.
pub(crate) fn read_geojson(bytes: &[u8]) -> Result<PosesFile, Fault> {
    let collection: Collection = json::parse(bytes)?;
    let mut list = List::default();
    for (Feature { properties }, line) in collection.features.into_iter().zip(1..) {
        let angles = properties.opk.map(f64::to_degrees);
        list.add(PoseLine {
            photo: properties.filename,
            camera: properties.camera.filter(|name| !name.is_empty()),
            pose: Pose::from_omega_phi_kappa(DVec3::from_array(properties.xyz), angles),
            errors: PoseErrors::default(),
            line,
        })?;
    }
    list.finish(collection.world_crs)
}

/// The poses so far; their names differ.
#[derive(Default)]
struct List {
    lines: Vec<PoseLine>,
    seen: HashMap<String, u64>,
}

impl List {
    fn add(&mut self, line: PoseLine) -> Result<(), Fault> {
        if let Some(first) = self.seen.insert(line.photo.clone(), line.line) {
            let what = format!("'{}' stands as number {first} already", shown(&line.photo));
            return Err(Fault::at(line.line, what, "keep one pose a photo"));
        }
        self.lines.push(line);
        Ok(())
    }

    fn finish(self, crs: Option<String>) -> Result<PosesFile, Fault> {
        if self.lines.is_empty() {
            return Err(Fault::new("it has no photos", "give a line for each photo"));
        }
        Ok(PosesFile {
            lines: self.lines,
            crs,
            ..PosesFile::default()
        })
    }
}

#[cfg(test)]
mod tests;
