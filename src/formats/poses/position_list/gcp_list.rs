//! OpenDroneMap's `gcp_list.txt` (docs.opendronemap.org, "Ground Control Points"; `opendm/gcp.py`).
//!
//! The first line names the coordinate system ("EPSG:2180", a PROJ string, "WGS84 UTM 17N"), then a
//! line a mark, separated by tabs or spaces (others write commas, which are taken, too):
//!
//! ```text
//! x y z pixel_x pixel_y image_name [point_name] [extras...]
//! ```
//!
//! x is the easting or the longitude, y the northing or the latitude. Where no point is named, marks
//! with the same coordinates belong to one point. OpenSfM, which takes the pixels from there, counts
//! from the centre of the top-left pixel (`features.normalized_image_coordinates` adds 0.5), so 0.5
//! is added here. A photo's name may hold blanks where it ends
//! like an image file, or where tabs separate.
//!
//! Beside it, lists of points without marks are in use: `name x y z`, or `x y z`. Lines that begin
//! with # are comments.
//!
//! For what has no place in that format, fragscale writes lines that are comments to others, their fields
//! between tabs:
//!
//! ```text
//! #fragscale point name                                 a point that nobody has surveyed
//! #fragscale mark pixel_x pixel_y image_name name       a mark of one
//! #fragscale bar name name length unit                  a scale bar: two points with a known distance
//! ```
//!
//! and "local" in the first line where no coordinate system is stated.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::geo_file::content;
use super::{ControlPoints, check_degrees, is_geographic};
use crate::control::{ControlList, ControlPoint, ScaleBar};
use crate::fault::Fault;
use crate::photos::image_names::{Ending, is_called};
use crate::text::separated::Separator;
use crate::units::LengthUnit;

/// The first line of a list without a coordinate system.
pub(super) const NO_CRS: &str = "local";

/// How lines begin that are comments to other programs, with what they are of behind it.
pub(super) const OWN: &str = "#fragscale ";

/// Whether a line is the one of a mark: five numbers and a name, which a point with a colour is not; between commas, where tables
/// of points have columns of any kind, a photo's name.
pub(super) fn is_mark(line: &str) -> bool {
    let fields = split(line.trim());
    let is_photo = |field: &String| !line.contains(',') || is_called(field, Ending::Raw);
    numbers_ahead(&fields) == 5 && fields.get(5).is_some_and(is_photo)
}

/// Whether the first line behind that of the coordinate system is one of points, which begin with a coordinate or have no photo's name.
pub(super) fn begins_with_numbers(text: &str) -> bool {
    let fields = content(text).next().map(|(line, _)| split(line));
    fields.is_some_and(|fields| {
        let name = fields.first();
        numbers_ahead(&fields) > 0 || !name.is_some_and(|name| is_called(name, Ending::Raw))
    })
}

/// How many of the first fields are numbers.
fn numbers_ahead(fields: &[String]) -> usize {
    let numbers = fields
        .iter()
        .take_while(|field| field.parse::<f64>().is_ok());
    numbers.count()
}

/// Reads a gcp_list.txt whose first line says `crs`, or is a mark's: then the user may say it.
pub(super) fn read(text: &str, crs: Option<String>) -> Result<ControlPoints, Fault> {
    let geographic = is_geographic(crs.as_deref());
    let mut points = Points::default();
    let mut bars = Vec::new();
    let mut is_first = true;
    for (line, number) in text.lines().zip(1..) {
        let line = line.trim();
        if let Some(own) = line.strip_prefix(OWN) {
            points.add_own(own, number, &mut bars)?;
            continue;
        }
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if std::mem::take(&mut is_first) && !is_mark(line) {
            continue;
        }
        let fields = split(line);
        let position = |at: usize| -> Result<DVec3, Fault> {
            let [x, y, z] = [(0, "x"), (1, "y"), (2, "z")]
                .map(|(place, name)| number_at(&fields, at + place, name, number));
            let position = DVec3::new(x?, y?, z?);
            if geographic {
                check_degrees(number, position)?;
            }
            Ok(position)
        };
        match (fields.len(), numbers_ahead(&fields)) {
            (6.., 5..) => {
                let pixel = DVec2::new(
                    number_at(&fields, 3, "the pixel's x", number)?,
                    number_at(&fields, 4, "the pixel's y", number)?,
                );
                let (photo, name) = photo_and_name(fields.get(5..).unwrap_or_default());
                points.add(Some(position(0)?), name, Some((photo, pixel + CORNER)));
            }
            (3, 3) => points.add(Some(position(0)?), None, None),
            (4, _) | (5.., 0) => {
                let name = fields.first().map(String::as_str);
                points.add(Some(position(1)?), name, None);
            }
            _ => {
                return Err(Fault::at(
                    number,
                    format!("a line of {} fields", fields.len()),
                    "a line of a gcp_list.txt is 'x y z pixel_x pixel_y image name', one without mark 'name x y z'",
                ));
            }
        }
    }
    let warnings = points.warnings();
    Ok(ControlPoints {
        list: ControlList {
            crs,
            points: points.points,
            bars,
        },
        warnings,
    })
}

/// From the centre of the first pixel, where the list counts from, to its corner, where we do.
pub(super) const CORNER: f64 = 0.5;

/// The fields: between tabs where there are enough of them, between commas where those stand between numbers (as spreadsheets
/// write them), else between white space.
fn split(line: &str) -> Vec<String> {
    let mut tabs = Separator::Sign('\t').split(line);
    tabs.retain(|field| !field.is_empty());
    if tabs.len() >= 4 {
        return tabs;
    }
    let commas = Separator::Sign(',').split(line);
    let is_number = |field: &String| field.parse::<f64>().is_ok();
    // With a name ahead, or without.
    if numbers_ahead(&commas) >= 3
        || commas
            .get(1..4)
            .is_some_and(|xyz| xyz.iter().all(is_number))
    {
        return commas;
    }
    Separator::Blanks.split(line)
}

/// The photo and the point's name: a photo's name that holds blanks goes on to its ending.
fn photo_and_name(fields: &[String]) -> (String, Option<&str>) {
    let last = fields
        .iter()
        .position(|field| is_called(field, Ending::Raw))
        .unwrap_or(0);
    let photo = fields.get(..=last).unwrap_or_default().join(" ");
    (photo, fields.get(last + 1).map(String::as_str))
}

fn number_at(fields: &[String], place: usize, name: &str, line: u64) -> Result<f64, Fault> {
    let remedy = "check the line: 'x y z pixel_x pixel_y image name', or 'name x y z'";
    let field = fields.get(place).map_or("", String::as_str);
    match field.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(Fault::at(
            line,
            format!("{name} is '{field}', not a finite number"),
            remedy,
        )),
    }
}

/// What tells points apart.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Name(String),
    Place([u64; 3]),
}

#[derive(Default)]
struct Points {
    points: Vec<ControlPoint>,
    by_key: HashMap<Key, usize>,
    /// Points that were given two places, and how far apart these are at most.
    moved: HashMap<usize, f64>,
    /// Marks that stand twice.
    repeated: usize,
}

impl Points {
    fn add(&mut self, position: Option<DVec3>, name: Option<&str>, mark: Option<(String, DVec2)>) {
        let key = match name {
            Some(name) => Key::Name(name.to_owned()),
            None => Key::Place(position.unwrap_or_default().to_array().map(f64::to_bits)),
        };
        let next = self.points.len();
        let index = *self.by_key.entry(key).or_insert(next);
        if index == next {
            self.points.push(ControlPoint {
                name: name.map_or_else(|| format!("point {}", next + 1), str::to_owned),
                position,
                marks: Vec::new(),
            });
        }
        let Some(point) = self.points.get_mut(index) else {
            return;
        };
        if let (Some(first), Some(position)) = (point.position, position)
            && first != position
        {
            let farthest = self.moved.entry(index).or_default();
            *farthest = farthest.max(first.distance(position));
        }
        point.position = point.position.or(position);
        let Some((photo, pixel)) = mark else {
            return;
        };
        if point.marks.iter().any(|(other, _)| *other == photo) {
            self.repeated += 1;
        } else {
            point.marks.push((photo, pixel));
        }
    }

    /// Adds what a line of our own says.
    fn add_own(&mut self, line: &str, number: u64, bars: &mut Vec<ScaleBar>) -> Result<(), Fault> {
        let remedy = "correct the line, or remove it";
        let fields: Vec<String> = line
            .split('\t')
            .map(|field| field.trim().to_owned())
            .collect();
        let fields: Vec<&str> = fields.iter().map(String::as_str).collect();
        match fields[..] {
            ["point", name] => self.add(None, Some(name), None),
            ["mark", x, y, photo, name] => {
                let numbers = [x, y].map(str::to_owned);
                let pixel = DVec2::new(
                    number_at(&numbers, 0, "the pixel's x", number)?,
                    number_at(&numbers, 1, "the pixel's y", number)?,
                );
                self.add(None, Some(name), Some((photo.to_owned(), pixel + CORNER)));
            }
            ["bar", from, to, length, unit] => {
                let metres = number_at(&[length.to_owned()], 0, "the length", number)?;
                let unit: LengthUnit = (unit.parse())
                    .map_err(|unknown| Fault::at(number, format!("the unit {unknown}"), remedy))?;
                if metres <= 0.0 {
                    let what = format!("a scale bar of length {length}");
                    return Err(Fault::at(number, what, remedy));
                }
                bars.push(ScaleBar {
                    ends: [from.to_owned(), to.to_owned()],
                    length: metres,
                    unit,
                });
            }
            _ => {
                let what = format!("'{OWN}{line}' is no point, mark or scale bar");
                return Err(Fault::at(number, what, remedy));
            }
        }
        Ok(())
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let mut moved: Vec<(usize, f64)> = self.moved.iter().map(|(&i, &d)| (i, d)).collect();
        moved.sort_by_key(|&(index, _)| index);
        for (index, apart) in moved {
            let name = self.points.get(index).map_or("", |point| &point.name);
            warnings.push(format!(
                "control point '{name}' stands at places {apart} apart; its first one is taken"
            ));
        }
        if self.repeated > 0 {
            warnings.push(format!(
                "{} marks of a point in a photo that has one of it already are left out",
                self.repeated
            ));
        }
        let mut by_place: HashMap<[u64; 2], &ControlPoint> = HashMap::new();
        for point in &self.points {
            let Some(DVec3 { x, y, z }) = point.position else {
                continue;
            };
            let Some(other) = by_place.insert([x, y].map(f64::to_bits), point) else {
                continue;
            };
            let height = other.position.unwrap_or_default().z;
            warnings.push(format!(
                "'{}' and '{}' have the same x and y, and heights {height} and {z}: one of them is mistyped, or they are one point",
                other.name, point.name
            ));
        }
        warnings
    }
}
