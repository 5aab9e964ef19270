//! The CSVs: the program's own columns, and its "OpenCV-compliant" ones.

use std::collections::HashSet;

use glam::{DMat3, DVec3};

use crate::camera::{Camera, HALF_TURN_ABOUT_X, Pose};
use crate::fault::Fault;
use crate::packages::reconstruction::{ImageUnit, Origin, Reconstruction, Sizes};
use crate::text::fields::shown;
use crate::text::separated::Separator;

use super::{FILM, Lens, add, say_refused};

const EXPORT: &str = "export \"Internal/External camera parameters\" from RealityCapture again";

/// The columns of the "OpenCV-compliant" CSV that have to be there.
const OPENCV: [&str; 13] = [
    "name", "tx", "ty", "tz", "r00", "r01", "r02", "r10", "r11", "r12", "r20", "r21", "r22",
];

/// Whether a line names the columns of a photo's position and RealityCapture's angles, or of its
/// "OpenCV-compliant" pose.
pub(crate) fn is_header(line: &str) -> bool {
    let columns = columns(line);
    let has = |names: &[&str]| {
        columns
            .iter()
            .any(|column| names.contains(&column.as_str()))
    };
    let own = ["name", "x", "y", "pitch", "roll"]
        .iter()
        .all(|name| has(&[name]))
        && has(&["heading", "yaw"])
        && has(&["alt", "z"]);
    line.trim_start().starts_with('#') && (own || OPENCV.iter().all(|name| has(&[name])))
}

/// The columns' names, in lower case, without the words in brackets that may follow the last one.
fn columns(line: &str) -> Vec<String> {
    let line = line.trim().trim_start_matches('#');
    let line = line.split('(').next().unwrap_or_default();
    let names = Separator::of(line).split(line).into_iter();
    names.map(|name| name.to_ascii_lowercase()).collect()
}

/// Where a column stands, and its name.
type Column = (usize, &'static str);

/// The named columns.
struct Header {
    line: u64,
    names: Vec<String>,
    separator: Separator,
}

impl Header {
    /// A column under one of its known names.
    fn optional(&self, known: &[&'static str]) -> Option<Column> {
        let place = |name: &String| known.contains(&name.as_str());
        Some((self.names.iter().position(place)?, known[0]))
    }

    fn needed(&self, known: &[&'static str]) -> Result<Column, Fault> {
        self.optional(known).ok_or_else(|| {
            let what = format!("there is no column {}", known[0]);
            Fault::at(self.line, what, EXPORT)
        })
    }
}

/// One line of the table.
struct Row {
    line: u64,
    fields: Vec<String>,
}

impl Row {
    fn number(&self, (column, name): Column) -> Result<f64, Fault> {
        let text = self.fields.get(column).map_or("", String::as_str);
        text.parse::<f64>()
            .ok()
            .filter(|n| n.is_finite())
            .ok_or_else(|| {
                let what = format!("column {name}: '{}' is not a finite number", shown(text));
                Fault::at(self.line, what, "write decimal points, and export it again")
            })
    }

    /// 0 where the template leaves the column out.
    fn or_zero(&self, column: Option<Column>) -> Result<f64, Fault> {
        column.map_or(Ok(0.0), |column| self.number(column))
    }
}

/// Reads a CSV; the cameras have no sizes yet.
///
/// # Errors
/// With the line: a missing column, a number that is not finite, a photo named twice; no photo.
pub(crate) fn read_csv(text: &str) -> Result<Reconstruction, Fault> {
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let (line, titles) = lines
        .by_ref()
        .find(|(_, line)| is_header(line))
        .ok_or_else(|| Fault::new("no line names its columns", EXPORT))?;
    let header = Header {
        line,
        names: columns(titles),
        separator: Separator::of(titles),
    };
    let is_opencv = header.optional(&["r00"]).is_some();
    let mut found = Reconstruction {
        package: "realitycapture",
        sizes: match is_opencv {
            true => Sizes::Unknown {
                unit: ImageUnit::Pixel,
                principal_points_from: Origin::Corner,
            },
            false => Sizes::Unknown {
                unit: ImageUnit::LongerSide,
                principal_points_from: Origin::Middle,
            },
        },
        ..Reconstruction::default()
    };
    let name = header.needed(&["name"])?;
    let template: Template = if is_opencv {
        opencv(&header)?
    } else {
        own(&header)?
    };
    let mut refused = Vec::new();
    let mut seen = HashSet::new();
    for (line, text) in lines {
        if text.trim_start().starts_with('#') {
            continue;
        }
        let fields = header.separator.split(text);
        let beyond = fields.get(header.names.len()..).unwrap_or_default();
        if beyond.iter().any(|field| !field.trim().is_empty()) {
            let what = format!(
                "{} values under {} names: are there decimal commas?",
                fields.len(),
                header.names.len()
            );
            return Err(Fault::at(line, what, EXPORT));
        }
        let row = Row { line, fields };
        let photo = row.fields.get(name.0).map_or("", String::as_str);
        if photo.is_empty() {
            return Err(Fault::at(line, "a photo without name", EXPORT));
        }
        if !seen.insert(photo.to_owned()) {
            let what = format!("the photo '{}' is there twice", shown(photo));
            return Err(Fault::at(line, what, EXPORT));
        }
        let (pose, camera) = template(&row)?;
        match camera {
            Ok(camera) => {
                let name = photo.to_owned();
                add(&mut found, name.clone(), Camera { name, ..camera }, pose);
            }
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

/// A row's pose and its camera, or, in words, why that cannot be one.
type Read = (Pose, Result<Camera, String>);

/// The coefficients' columns; the template may leave some out.
fn coefficients(header: &Header) -> [Option<Column>; 6] {
    [
        header.optional(&["k1"]),
        header.optional(&["k2"]),
        header.optional(&["k3"]),
        header.optional(&["k4"]),
        header.optional(&["t1"]),
        header.optional(&["t2"]),
    ]
}

/// How a row of one template is read.
type Template = Box<dyn Fn(&Row) -> Result<Read, Fault>>;

/// The program's own columns: centre, angles, the lens on film.
fn own(header: &Header) -> Result<Template, Fault> {
    let position = [
        header.needed(&["x"])?,
        header.needed(&["y"])?,
        header.needed(&["alt", "z"])?,
    ];
    let angles = [
        header.needed(&["heading", "yaw"])?,
        header.needed(&["pitch"])?,
        header.needed(&["roll"])?,
    ];
    let focal = header.needed(&["f", "f_35mm", "f_35", "focal"])?;
    let principal = [
        header.optional(&["px", "px_norm"]),
        header.optional(&["py", "py_norm"]),
    ];
    let coefficients = coefficients(header);
    Ok(Box::new(move |row| {
        let [x, y, z] = position.map(|column| row.number(column));
        let [heading, pitch, roll] = angles.map(|column| row.number(column));
        let [px, py] = principal.map(|column| row.or_zero(column));
        let lens = Lens {
            focal: row.number(focal)? / FILM,
            principal: [px?, py?],
            coefficients: all(coefficients.map(|column| row.or_zero(column)))?,
        };
        let pose = pose(DVec3::new(x?, y?, z?), [heading?, pitch?, roll?]);
        Ok((pose, lens.camera("")))
    }))
}

/// The "OpenCV-compliant" columns: camera_from_world, the lens in pixels from the image's corner.
fn opencv(header: &Header) -> Result<Template, Fault> {
    let [_, pose @ ..] = OPENCV;
    let mut places = [(0, ""); 12];
    for (place, name) in places.iter_mut().zip(pose) {
        *place = header.needed(&[name])?;
    }
    let focal = header.needed(&["f_pix", "f"])?;
    let principal = [
        header.needed(&["px_pix", "px"])?,
        header.needed(&["py_pix", "py"])?,
    ];
    let coefficients = coefficients(header);
    Ok(Box::new(move |row| {
        let [tx, ty, tz, turn @ ..] = all(places.map(|column| row.number(column)))?;
        let [a, b, c, d, e, f, g, h, i] = turn;
        // The transpose: from the camera to the world.
        let pose = Pose::from_row_major(DVec3::ZERO, [a, d, g, b, e, h, c, f, i])
            .map_err(|error| Fault::at(row.line, format!("R00 to R22: {error}"), EXPORT))?;
        let center = -(pose.rotation * DVec3::new(tx, ty, tz));
        let [px, py] = principal.map(|column| row.number(column));
        let lens = Lens {
            focal: row.number(focal)?,
            principal: [px?, py?],
            coefficients: all(coefficients.map(|column| row.or_zero(column)))?,
        };
        Ok((Pose { center, ..pose }, lens.camera("")))
    }))
}

fn all<const N: usize>(numbers: [Result<f64, Fault>; N]) -> Result<[f64; N], Fault> {
    let mut all = [0.0; N];
    for (place, number) in all.iter_mut().zip(numbers) {
        *place = number?;
    }
    Ok(all)
}

/// The pose by heading, pitch and roll in degrees.
pub(crate) fn pose(center: DVec3, [heading, pitch, roll]: [f64; 3]) -> Pose {
    let world_from_upright = DMat3::from_rotation_z(-heading.to_radians())
        * DMat3::from_rotation_x(pitch.to_radians())
        * DMat3::from_rotation_y(roll.to_radians());
    Pose {
        rotation: world_from_upright * HALF_TURN_ABOUT_X,
        center,
    }
}
