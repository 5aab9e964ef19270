//! The CSV.

use std::collections::HashSet;

use glam::{DMat3, DVec3};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::formats::fields::shown;
use crate::formats::reconstruction::Reconstruction;

use super::{Lens, add, say_refused};

const EXPORT: &str = "export \"Internal/External camera parameters\" from RealityCapture again";

/// Whether a line names the columns of a photo's position and RealityCapture's angles.
pub(in crate::formats) fn is_header(line: &str) -> bool {
    let columns = columns(line);
    let has = |names: &[&str]| {
        columns
            .iter()
            .any(|column| names.contains(&column.as_str()))
    };
    line.trim_start().starts_with('#')
        && ["name", "x", "y", "pitch", "roll"]
            .iter()
            .all(|name| has(&[name]))
        && has(&["heading", "yaw"])
        && has(&["alt", "z"])
}

/// The columns' names, in lower case.
fn columns(line: &str) -> Vec<String> {
    let line = line.trim().trim_start_matches('#');
    let clean = |name: &str| name.trim().trim_matches('"').to_ascii_lowercase();
    line.split(delimiter(line)).map(clean).collect()
}

fn delimiter(line: &str) -> char {
    [',', ';', '\t']
        .into_iter()
        .find(|c| line.contains(*c))
        .unwrap_or(',')
}

/// Reads the CSV; the cameras have no sizes yet.
///
/// # Errors
/// With the line: a missing column, a number that is not finite, a photo named twice; no photo.
pub(in crate::formats) fn read_csv(text: &str) -> Result<Reconstruction, Fault> {
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let (header_line, header) = lines
        .by_ref()
        .find(|(_, line)| is_header(line))
        .ok_or_else(|| Fault::new("no line names its columns", EXPORT))?;
    let names = columns(header);
    let find = |known: &[&str]| names.iter().position(|name| known.contains(&name.as_str()));
    let needed = |known: &[&'static str]| {
        find(known).map(|column| (column, known[0])).ok_or_else(|| {
            Fault::at(
                header_line,
                format!("there is no column {}", known[0]),
                EXPORT,
            )
        })
    };
    let name = needed(&["name"])?;
    let position = [needed(&["x"])?, needed(&["y"])?, needed(&["alt", "z"])?];
    let angles = [
        needed(&["heading", "yaw"])?,
        needed(&["pitch"])?,
        needed(&["roll"])?,
    ];
    let focal = needed(&["f", "f_35mm", "f_35", "focal"])?;
    // The template of the columns may be shortened.
    let optional: [Option<(usize, &str)>; 8] = [
        find(&["px", "px_norm"]).map(|column| (column, "px")),
        find(&["py", "py_norm"]).map(|column| (column, "py")),
        find(&["k1"]).map(|column| (column, "k1")),
        find(&["k2"]).map(|column| (column, "k2")),
        find(&["k3"]).map(|column| (column, "k3")),
        find(&["k4"]).map(|column| (column, "k4")),
        find(&["t1"]).map(|column| (column, "t1")),
        find(&["t2"]).map(|column| (column, "t2")),
    ];
    let mut found = Reconstruction {
        package: "realitycapture",
        intrinsics_in_longer_sides: true,
        ..Reconstruction::default()
    };
    let mut refused = Vec::new();
    let mut seen = HashSet::new();
    for (line, text) in lines {
        if text.trim_start().starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = text
            .split(delimiter(header))
            .map(|field| field.trim().trim_matches('"'))
            .collect();
        let number = |(column, name): (usize, &str)| {
            let text = fields.get(column).copied().unwrap_or_default();
            text.parse::<f64>()
                .ok()
                .filter(|n| n.is_finite())
                .ok_or_else(|| {
                    let what = format!("column {name}: '{}' is not a finite number", shown(text));
                    Fault::at(line, what, "write decimal points, and export it again")
                })
        };
        let photo = fields.get(name.0).copied().unwrap_or_default();
        if photo.is_empty() {
            return Err(Fault::at(line, "a photo without name", EXPORT));
        }
        if !seen.insert(photo) {
            let what = format!("the photo '{}' is there twice", shown(photo));
            return Err(Fault::at(line, what, EXPORT));
        }
        let [x, y, z] = position.map(number);
        let [heading, pitch, roll] = angles.map(number);
        let mut values = [0.0; 8];
        for (value, column) in values.iter_mut().zip(optional) {
            *value = column.map_or(Ok(0.0), number)?;
        }
        let [px, py, k1, k2, k3, k4, t1, t2] = values;
        let lens = Lens {
            focal: number(focal)?,
            principal: [px, py],
            coefficients: [k1, k2, k3, k4, t1, t2],
        };
        let pose = pose(DVec3::new(x?, y?, z?), [heading?, pitch?, roll?]);
        match lens.camera(photo) {
            Ok(camera) => add(&mut found, photo.to_owned(), camera, pose),
            Err(why) => refused.push((photo.to_owned(), why)),
        }
    }
    say_refused(&mut found, &refused);
    if found.photos.is_empty() {
        let what = found.warnings.pop();
        let what = what.unwrap_or_else(|| "it holds no photo".to_owned());
        return Err(Fault::new(what, EXPORT));
    }
    Ok(found)
}

/// The pose by heading, pitch and roll in degrees.
pub(super) fn pose(center: DVec3, [heading, pitch, roll]: [f64; 3]) -> Pose {
    let world_from_upright = DMat3::from_rotation_z(-heading.to_radians())
        * DMat3::from_rotation_x(pitch.to_radians())
        * DMat3::from_rotation_y(roll.to_radians());
    let upright_from_camera = DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0));
    Pose {
        rotation: world_from_upright * upright_from_camera,
        center,
    }
}
