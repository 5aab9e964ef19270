//! Known places as data: where photos were taken, and ground control points with their marks in
//! photos. For bringing a reconstruction in a frame of its own to the world.
//!
//! A list of photos' positions is one of
//!
//! - a table with a header line (`table`),
//! - OpenDroneMap's `geo.txt` (`geo_file`),
//! - DJI's `*_Timestamp.MRK` (`mrk`),
//!
//! a list of control points OpenDroneMap's `gcp_list.txt` (`gcp_list`) or a table. Which it is
//! says the text itself: the first line of OpenDroneMap's files names a coordinate system, a table's
//! first line names columns, and an .MRK has a week in brackets.

mod gcp_list;
mod gcp_text;
mod geo_file;
mod known;
pub(crate) mod mrk;
mod table;

pub use gcp_text::control_list_text;
pub use known::{KnownPlaces, read_known_places};
pub use mrk::number_of_photo;

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::control::{ControlList, ControlPoint};
use crate::fault::{Fault, first_names, one_line};
use crate::files::{FLIGHT_MARK, FileError, read_text};
use crate::packages::odm::crs_from_text;
use crate::photos::photo_metadata;
use crate::photos::photos_below::PhotosBelow;

/// Where photos were taken, as a list beside them or their own headers say it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PositionList {
    /// The coordinate system that the list states: "EPSG:n", a PROJ string or WKT; `None` where it
    /// states none.
    pub crs: Option<String>,
    /// In the list's order; no name stands twice.
    pub positions: Vec<NamedPosition>,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

/// The position of one photo.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPosition {
    /// The image file's name, as the list writes it; in an .MRK the number of the photo.
    pub name: String,
    /// In the list's `crs`: (easting, northing, height), or (degrees east, degrees north, metres up)
    /// where that is one of longitude and latitude.
    pub position: DVec3,
    /// Standard deviations towards east, north and up, in metres, where the list states them.
    pub accuracy: Option<DVec3>,
    /// The way that its camera looked, towards east, north and up, of length 1, where its gimbal says so.
    pub looks: Option<DVec3>,
}

/// Ground control points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ControlPoints {
    /// The points, where the list has any marks with these, and the scale bars.
    pub list: ControlList,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

/// Reads a list of photos' positions.
///
/// # Errors
/// With the line: what is no such list, a number that is not finite, a name that stands twice.
pub fn read_positions(path: &Path) -> Result<PositionList, FileError> {
    positions_from_text(&read_text(path)?).map_err(|fault| FileError::new(path, fault))
}

/// Reads a list of ground control points, with or without marks.
///
/// # Errors
/// With the line: what is no such list, a number that is not finite.
pub fn read_control_points(path: &Path) -> Result<ControlPoints, FileError> {
    control_points_from_text(&read_text(path)?).map_err(|fault| FileError::new(path, fault))
}

/// The positions that the photos in a folder carry in their EXIF and XMP; photos without one are
/// left out and counted.
///
/// # Errors
/// Where the folder cannot be read, or no photo has a position.
pub fn positions_of_photos(folder: &Path) -> Result<PositionList, FileError> {
    positions_of_files(folder, &PhotosBelow::read(folder)?.photos)
}

/// The same of some files, by the photos' names, that were found in a folder.
///
/// # Errors
/// Where none of them says a place and a height.
pub fn positions_of_files(
    folder: &Path,
    files: &[(String, PathBuf)],
) -> Result<PositionList, FileError> {
    let mut list = PositionList {
        crs: Some("EPSG:4326".to_owned()),
        ..PositionList::default()
    };
    let mut references = BTreeSet::new();
    let mut without = Vec::new();
    for (name, file) in files {
        let metadata = photo_metadata::read_file(file).ok();
        let place = metadata.as_ref().and_then(|metadata| metadata.place);
        let gimbal = metadata.and_then(|metadata| metadata.orientation);
        let Some((place, height)) = place.and_then(|place| Some((place, place.height?))) else {
            without.push(name.clone());
            continue;
        };
        references.insert(height);
        list.positions.push(NamedPosition {
            name: name.clone(),
            position: DVec3::new(
                place.place.longitude,
                place.place.latitude,
                place.place.height,
            ),
            accuracy: place.deviation,
            looks: gimbal.map(|angles| angles.pose(DVec3::ZERO).rotation * DVec3::Z),
        });
    }
    if list.positions.is_empty() {
        let what = match files.len() {
            0 => "a folder without photos".to_owned(),
            count => format!("none of its {count} photos says where and how high it was taken"),
        };
        let remedy = "give a list of positions, or control points";
        return Err(FileError::new(folder, Fault::new(what, remedy)));
    }
    if !without.is_empty() {
        let (count, all) = (without.len(), files.len());
        let names = first_names(&without);
        list.warnings.push(format!(
            "{count} of {all} photos do not say where and how high they were taken ({names})"
        ));
    }
    for reference in references {
        list.warnings
            .push(format!("the photos' heights {}", reference.in_words()));
    }
    Ok(list)
}

fn positions_from_text(text: &str) -> Result<PositionList, Fault> {
    let list = match Shape::of(text)? {
        Shape::Mrk => mrk::read(text)?.positions(),
        Shape::Crs(crs) => geo_file::read(text, crs)?,
        Shape::Marks => {
            return Err(Fault::new(
                "it holds marks of control points, not the positions of photos",
                "give it as control points",
            ));
        }
        Shape::Table => table::read(text)?,
    };
    if list.positions.is_empty() {
        return Err(Fault::new(
            "it has no positions",
            "give a line for each photo",
        ));
    }
    once_each(list.positions.iter().map(|position| position.name.as_str()))?;
    Ok(list)
}

fn control_points_from_text(text: &str) -> Result<ControlPoints, Fault> {
    let list = match Shape::of(text)? {
        Shape::Mrk => {
            return Err(Fault::new(
                "it holds the positions of photos (.MRK), not control points",
                "give it as a list of positions",
            ));
        }
        Shape::Crs(crs) => gcp_list::read(text, crs)?,
        Shape::Marks => gcp_list::read(text, None)?,
        Shape::Table => {
            marks_below(text)?;
            let table = table::read(text)?;
            once_each(table.positions.iter().map(|point| point.name.as_str()))?;
            let point = |point: NamedPosition| ControlPoint {
                name: point.name,
                position: Some(point.position),
                marks: Vec::new(),
            };
            ControlPoints {
                list: ControlList {
                    crs: table.crs,
                    points: table.positions.into_iter().map(point).collect(),
                    bars: Vec::new(),
                },
                warnings: table.warnings,
            }
        }
    };
    // A list of ours can have been emptied.
    let is_own = text
        .lines()
        .nth(1)
        .is_some_and(|line| line == FLIGHT_MARK.trim_end());
    if list.list.points.is_empty() && !is_own {
        return Err(Fault::new(
            "it has no control points",
            "give a line for each mark",
        ));
    }
    Ok(list)
}

/// Marks below a first line that is none and names no system that we know: whether it is the title of columns or another
/// program's word for a system is not for us to say.
fn marks_below(text: &str) -> Result<(), Fault> {
    let lines = text.lines().map(str::trim).zip(1..);
    let mut lines = lines.filter(|(line, _)| !line.is_empty() && !line.starts_with('#'));
    let (Some((first, number)), Some((second, _))) = (lines.next(), lines.next()) else {
        return Ok(());
    };
    if !gcp_list::is_mark(second) {
        return Ok(());
    }
    Err(Fault::at(
        number,
        format!(
            "the marks' first line, '{}', names no coordinate system",
            one_line(first)
        ),
        "write EPSG: and its number there, or LOCAL",
    ))
}

/// A name that stands twice is a fault: which of the two holds is not for us to say.
fn once_each<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), Fault> {
    let mut seen: HashMap<&str, usize> = HashMap::new();
    for (place, name) in names.enumerate() {
        if let Some(first) = seen.insert(name, place) {
            let (first, second) = (first + 1, place + 1);
            return Err(Fault::new(
                format!("'{name}' stands twice, as entry {first} and as entry {second}"),
                "keep one line a name",
            ));
        }
    }
    Ok(())
}

/// What kind of list a text is.
enum Shape {
    Mrk,
    /// OpenDroneMap's, with the coordinate system of its first line.
    Crs(Option<String>),
    /// OpenDroneMap's marks without that line.
    Marks,
    Table,
}

impl Shape {
    fn of(text: &str) -> Result<Self, Fault> {
        let first = text.lines().find(|line| !line.trim().is_empty());
        let first = first.ok_or_else(|| Fault::new("it is empty", "export it again"))?;
        // A spreadsheet writes as many commas as other lines have.
        let first = first.trim_end().trim_end_matches(',');
        if mrk::is_mrk(first) {
            return Ok(Self::Mrk);
        }
        if is_crs(first) {
            return Ok(Self::Crs(crs_from_text(first)));
        }
        if first.trim().eq_ignore_ascii_case(gcp_list::NO_CRS) {
            return Ok(Self::Crs(None));
        }
        let mut lines = text.lines().map(str::trim);
        let first = lines.find(|line| !line.is_empty() && !line.starts_with('#'));
        if first.is_some_and(gcp_list::is_mark) {
            return Ok(Self::Marks);
        }
        Ok(Self::Table)
    }
}

/// How WKT of a coordinate system begins, in small letters.
const WKT: [&str; 6] = [
    "projcs[",
    "projcrs[",
    "geogcs[",
    "geogcrs[",
    "compd_cs[",
    "compoundcrs[",
];

/// Whether a line names a coordinate system as OpenDroneMap's lists do: "EPSG:4326", a PROJ string,
/// "WGS84 UTM 17N", or WKT.
fn is_crs(line: &str) -> bool {
    let line = line.trim().to_ascii_lowercase();
    let epsg = line.strip_prefix("epsg:");
    // With a code of the heights behind a plus, too.
    let codes = |text: &str| {
        text.split('+')
            .all(|code| code.trim().parse::<u32>().is_ok())
    };
    epsg.is_some_and(codes)
        || line.starts_with("+proj")
        || line.starts_with("wgs84 utm")
        || WKT.iter().any(|start| line.starts_with(start))
}

/// Whether positions in that system are degrees. Where it is not known, no.
fn is_geographic(crs: Option<&str>) -> bool {
    crs.is_some_and(|crs| {
        let crs = crs.to_ascii_lowercase();
        let level = crs.split('+').next().unwrap_or_default().trim();
        matches!(level, "epsg:4326" | "epsg:4979" | "epsg:4258")
            || crs.contains("+proj=longlat")
            || crs.contains("+proj=latlong")
            || crs.starts_with("geogc")
    })
}

/// Refuses degrees that no place on the Earth has: most often, columns that are swapped.
fn check_degrees(line: u64, position: DVec3) -> Result<(), Fault> {
    let (longitude, latitude) = (position.x, position.y);
    if longitude.abs() > 180.0 || latitude.abs() > 90.0 {
        return Err(Fault::at(
            line,
            format!(
                "longitude {longitude}, latitude {latitude} is no place in degrees: beyond 180 or 90"
            ),
            "check the order of the columns and the coordinate system",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
