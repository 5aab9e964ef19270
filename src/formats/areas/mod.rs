//! Areas on the Earth as maps keep them: polygons of GeoJSON, of KML, or of a KML in its zip (KMZ).
//!
//! ```text
//! geojson  RFC 7946
//! kml      OGC KML 2.2 (07-147r2), as Google Earth and QGIS write it
//! ring     the corners that both have in common, checked
//! ```
//!
//! Both count longitude first, in degrees of WGS 84; heights, where they stand, are not read: an area is ground, with
//! all that is above it. A polygon with a hole is refused, for who leaves the hole out plans flights over it; who only draws
//! takes its rings. Points and lines beside polygons are counted: whoever asks for areas to keep out of must know of them.

mod geojson;
mod kml;
mod ring;
#[cfg(test)]
mod tests;

use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use crate::fault::Fault;
use crate::files::{FileError, open_file, read_small, text_from_bytes};
use crate::geodesy::Geographic;

/// How large a file may be, in bytes: JSON takes fifteen times as much in memory, and no area is larger.
const LARGEST: u64 = 8 << 20;

const KNOWN: &str = "give polygons as GeoJSON or KML, in degrees of WGS 84";

/// How much of a file is looked at, to tell its kind.
const LOOKED_AT: u64 = 1024;

/// Whether a file is of one of these kinds, by how it begins: JSON, XML or a zip, and so no list of places. Not one that
/// cannot be read.
pub fn holds_areas(path: &Path) -> bool {
    let mut head = Vec::new();
    let is_file = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    let mut file = open_file(path).ok().filter(|_| is_file);
    let read = (file.as_mut()).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut head).ok());
    read.is_some() && is_areas(&head)
}

fn is_areas(head: &[u8]) -> bool {
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let first = head.iter().find(|byte| !byte.is_ascii_whitespace());
    matches!(first, Some(b'{' | b'[' | b'<')) || head.starts_with(b"PK\x03\x04")
}

/// What a file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAreas {
    /// At least one, each of at least three corners, none of which is said twice in a row; heights are 0.
    pub polygons: Vec<Vec<Geographic>>,
    /// The outlines of their holes, of the same kind.
    pub holes: Vec<Vec<Geographic>>,
    /// What is wrong with the first polygon that has one, for whom an area is ground.
    first_hole: Option<Fault>,
    /// Points beside them.
    pub points: usize,
    /// Lines and paths beside them.
    pub lines: usize,
}

impl MapAreas {
    /// What there is beside the polygons, in words; `None` where there is nothing.
    pub fn others(&self) -> Option<String> {
        (self.points + self.lines > 0).then(|| others(self.points, self.lines))
    }

    /// Itself, where none of its polygons has a hole.
    fn without_holes(self) -> Result<Self, Fault> {
        match self.first_hole {
            Some(fault) => Err(fault),
            None => Ok(self),
        }
    }
}

fn others(points: usize, lines: usize) -> String {
    let counted = |count: usize, word: &str| match count {
        1 => format!("1 {word}"),
        _ => format!("{count} {word}s"),
    };
    format!(
        "{} and {}",
        counted(points, "point"),
        counted(lines, "line")
    )
}

/// Reads the polygons of a file.
///
/// # Errors
/// With the file and the place in it: what holds no polygon, one with a hole, corners that are no degrees or that have
/// latitude first, another coordinate system than WGS 84.
pub fn read_areas(path: &Path) -> Result<MapAreas, FileError> {
    let at = |fault| FileError::new(path, fault);
    read_rings(path)?.without_holes().map_err(at)
}

/// Reads the polygons of a file with their holes, for who draws them.
///
/// # Errors
/// As [`read_areas`], but for holes.
pub fn read_rings(path: &Path) -> Result<MapAreas, FileError> {
    let bytes = read_small(path, LARGEST, "areas", KNOWN)?;
    rings(&bytes).map_err(|fault| FileError::new(path, fault))
}

/// The same from the bytes of a file.
///
/// # Errors
/// As [`read_areas`], without the file.
pub fn areas(bytes: &[u8]) -> Result<MapAreas, Fault> {
    rings(bytes)?.without_holes()
}

fn rings(bytes: &[u8]) -> Result<MapAreas, Fault> {
    if bytes.starts_with(b"PK") {
        return kml::read(&kml_of_zip(bytes)?);
    }
    let text = text_from_bytes(bytes)?;
    match text.trim_start().chars().next() {
        None => Err(Fault::new("it is empty", "export it again")),
        Some('<') => kml::read(text),
        Some('{') => geojson::read(text),
        Some(_) => Err(Fault::new("it is neither GeoJSON nor KML", KNOWN)),
    }
}

/// The first .kml of a zip: that is the one that is shown (KML 2.2, annex C).
fn kml_of_zip(bytes: &[u8]) -> Result<String, Fault> {
    let unzip = "unzip it, and give the .kml that is in it";
    let broken = |error: &dyn std::fmt::Display| {
        Fault::new(format!("its zip is damaged ({error})"), "export it again")
    };
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| broken(&error))?;
    let name = (archive.file_names().filter_map(Result::ok))
        .find(|name| name.to_lowercase().ends_with(".kml"))
        .map(std::borrow::Cow::into_owned);
    let Some(name) = name else {
        return Err(Fault::new("its zip holds no .kml", KNOWN));
    };
    let entry = archive.by_name(&name).map_err(|error| broken(&error))?;
    let mut inflated = Vec::new();
    let read = entry.take(LARGEST + 1).read_to_end(&mut inflated);
    read.map_err(|error| broken(&error))?;
    if inflated.len() as u64 > LARGEST {
        let what = format!("its .kml is larger than {} MB, no areas", LARGEST >> 20);
        return Err(Fault::new(what, KNOWN));
    }
    Ok(text_from_bytes(&inflated)
        .map_err(|fault| Fault::new(fault.what, unzip))?
        .to_owned())
}

/// What holds no polygon, and what it holds instead.
fn no_polygon(points: usize, lines: usize) -> Fault {
    let what = match (points, lines) {
        (0, 0) => "there is no polygon in it".to_owned(),
        _ => format!("there is no polygon in it, but {}", others(points, lines)),
    };
    Fault::new(
        what,
        "draw the area as a polygon, not as a path, and save it again",
    )
}
