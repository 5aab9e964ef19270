//! Missions of drones as ground stations wrote them, told by what is in them and not by their names.
//!
//! ```text
//! route      places, turns, gimbal, waits and shots, one after the other, become stops
//! wpml       DJI: .kmz, its folder, waylines.wpml, template.kml
//! mavlink    the commands that the next two have in common
//! plan       QGroundControl's .plan
//! waypoints  Mission Planner's .waypoints: QGC WPL 110
//! litchi     Litchi's CSV
//! geojson    our own
//! ```
//!
//! A stop comes of every photo, and of every place without one. What a mission has no place for (splines,
//! video, photos by time or distance) is passed over and said. Positions are WGS 84; latitude comes first
//! in all but DJI's files and GeoJSON.

mod geojson;
mod litchi;
mod mavlink;
mod plan;
mod route;
mod waypoints;
mod wpml;

#[cfg(test)]
mod tests;

use std::fs;
use std::path::Path;

use fragscale_core::plan::{Mission, heading};

use crate::fault::Fault;
use crate::files::{FileError, text_from_bytes};

/// How large a file may be, in bytes: a mission of 65 536 waypoints in DJI's XML has about 100 MB, but
/// nobody flies a tenth of them.
const LARGEST: u64 = 64 << 20;

/// The same of JSON, whose items take ten times their bytes in memory: a .plan of 30 000 commands.
const LARGEST_JSON: usize = 16 << 20;

/// What to do with a file that is none of these.
const KNOWN: &str = "give a DJI .kmz, a QGroundControl .plan, a Mission Planner .waypoints, a Litchi .csv or a mission's .geojson that fragscale wrote";

/// A mission that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionFile {
    /// What the drone is told. It may have no stops: that is in the notes.
    pub mission: Mission,
    /// What the file is, in words.
    pub format: &'static str,
    /// One sentence for each thing that the file says and the mission does not.
    pub notes: Vec<String>,
}

/// Reads a mission: a file of any ground station, or the folder of a DJI .kmz.
///
/// # Errors
/// With the file and the place in it: what is no mission, of a version that is not known, cut off, or
/// tells a drone what no drone can do.
pub fn read_mission(path: &Path) -> Result<MissionFile, FileError> {
    let at = |fault| FileError::new(path, fault);
    let mut found = if path.is_dir() {
        wpml::read_folder(path)?
    } else {
        let bytes = read_small(path)?;
        read_bytes(&bytes).map_err(at)?
    };
    found.mission.check().map_err(at)?;
    if found.mission.stops.is_empty() {
        found.notes.insert(0, "it has no waypoint".to_owned());
    }
    if found.mission.name.is_empty() {
        let stem = path.file_stem().unwrap_or_default();
        found.mission.name = stem.to_string_lossy().into_owned();
    }
    Ok(found)
}

/// Whether a file is a mission, by its first bytes, and of a .kmz by what its zip holds.
pub(crate) fn is_mission(path: &Path, start: &[u8]) -> bool {
    let ends = |wanted: &str| {
        let ending = path.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
    };
    if start.starts_with(b"PK") {
        return ends("kmz") && wpml::is_in_zip(path);
    }
    let text = String::from_utf8_lossy(start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start));
    let first = text.lines().next().unwrap_or_default();
    match text.trim_start().chars().next() {
        Some('<') => text.contains("xmlns:wpml="),
        Some('{') => ends("plan") || geojson::is_ours(&text),
        _ => first.starts_with("QGC WPL") || litchi::is_header(first),
    }
}

/// Whether a folder is that of a DJI .kmz.
pub(crate) fn is_mission_folder(path: &Path) -> bool {
    wpml::is_folder(path)
}

/// A mission from the bytes of its file. Its name stays empty where the file does not say it.
fn read_bytes(bytes: &[u8]) -> Result<MissionFile, Fault> {
    if bytes.starts_with(b"PK") {
        return wpml::read_kmz(bytes);
    }
    let text = text_from_bytes(bytes)?;
    let first = text.lines().next().unwrap_or_default();
    match text.trim_start().chars().next() {
        None => Err(Fault::new("it is empty", "export it again")),
        Some('<') => wpml::read_xml(text),
        Some('{') if text.len() > LARGEST_JSON => {
            let what = format!("it is larger than {} MB, no mission", LARGEST_JSON >> 20);
            Err(Fault::new(what, KNOWN))
        }
        Some('{') if geojson::is_ours(text) => geojson::read(text),
        Some('{') => plan::read(text),
        _ if first.starts_with("QGC WPL") => waypoints::read(text),
        _ if litchi::is_header(first) => litchi::read(text),
        _ => Err(Fault::new("it holds no mission of a known kind", KNOWN)),
    }
}

/// The bytes of a file that is not larger than a mission can be.
fn read_small(path: &Path) -> Result<Vec<u8>, FileError> {
    crate::files::read_small(path, LARGEST, "mission", KNOWN)
}

/// The text of a file in a folder, if it is there.
fn text_in(folder: &Path, name: &str) -> Result<Option<String>, FileError> {
    let path = folder.join(name);
    if !fs::metadata(&path).is_ok_and(|metadata| metadata.is_file()) {
        return Ok(None);
    }
    let bytes = read_small(&path)?;
    let text = text_from_bytes(&bytes).map_err(|fault| FileError::new(&path, fault))?;
    Ok(Some(text.to_owned()))
}

/// A mission where a flight is needed.
pub fn no_flight_but_mission() -> Fault {
    Fault::new(
        "it holds a drone's mission, not a flight",
        "say what it says with 'fragscale mission FILE'; with the flight that came of it 'fragscale flown FLIGHT --mission FILE', or drop it on the window where that flight is open",
    )
}
