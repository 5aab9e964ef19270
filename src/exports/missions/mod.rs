//! Missions for ground stations, and to look at.
//!
//! ```text
//! format     which there are, how many stops each takes
//! parts      more than that becomes several
//! heights    what a target's heights count from
//! wpml       DJI's .kmz: template.kml and waylines.wpml, the XML of which is in xml
//! mavlink    the commands that the next two have in common
//! plan       QGroundControl's .plan
//! waypoints  Mission Planner's .waypoints
//! litchi     Litchi's CSV
//! kml        to look at
//! geojson    to look at, and all that a mission says, digit for digit
//! ```
//!
//! At each stop the drone arrives, stops, turns, moves the gimbal and waits for it, settles, shoots: in
//! that order in every format.

mod format;
mod geojson;
mod heights;
mod kml;
mod litchi;
mod mavlink;
mod parts;
mod plan;
mod waypoints;
mod wpml;
mod xml;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use fragscale_core::plan::{Above, Mission};

pub use format::MissionFormat;
pub use parts::flights_for;

use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind};
use parts::parts;

/// A mission as the bytes of one file or several.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionFiles {
    /// Where the name of the file is given, what is added to its stem ("", or "-1", "-2", ...); its bytes.
    pub files: Vec<(String, Vec<u8>)>,
    /// What the pilot must know, one sentence each: what the target ignores, what its app has to be told.
    pub notes: Vec<String>,
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenMission {
    /// One file, or several where the target takes fewer stops.
    pub files: Vec<PathBuf>,
    /// What the pilot must know, one sentence each.
    pub notes: Vec<String>,
}

/// A mission as the files of a target.
///
/// # Errors
/// Where the mission has no stops or tells a drone what no drone can do; where a height counts from a
/// datum that is not said, or from what the target does not know; where the target needs more than it says.
pub fn mission_files(mission: &Mission, format: MissionFormat) -> Result<MissionFiles, Fault> {
    mission.check()?;
    if mission.stops.is_empty() {
        let remedy = "give a mission that has waypoints";
        return Err(Fault::new("the mission has no stops", remedy));
    }
    let elevation = mission.take_off.and_then(|take_off| take_off.elevation);
    if elevation.is_some_and(|elevation| elevation.above == Above::Unknown) {
        return Err(heights::no_datum("the elevation of the take-off"));
    }
    if let Some(index) = (mission.stops.iter()).position(|stop| stop.height.above == Above::Unknown)
    {
        return Err(heights::no_datum(&format!(
            "the height of stop {}",
            index + 1
        )));
    }
    let parts = parts(mission, format);
    let mut notes = Vec::new();
    if parts.len() > 1 {
        notes.push(format!(
            "{}: the mission is in {} files, to be flown one after the other; nobody looked at what stands between the take-off and the first and the last stop of each, as 'fragscale plan' does: look, or plan it for {}",
            parts::limit_in_words(format),
            parts.len(),
            format.in_words()
        ));
    }
    if !mission.fences.is_empty() && !format.has_fences() {
        notes.push(format!(
            "the fences are not in the file, for {} has no place for them: set them in the ground station",
            format.file_in_words()
        ));
    }
    if let (Some(lost), false) = (mission.lost_signal, format.says_lost_signal()) {
        notes.push(format!(
            "the file does not say what the drone does where the radio is lost ({}): set it at the drone",
            lost.in_words()
        ));
    }
    let count = parts.len();
    let mut files = Vec::new();
    for (part, number) in parts.iter().zip(1..) {
        let bytes = match format {
            MissionFormat::DjiWpml => wpml::bytes(part, &mut notes)?,
            MissionFormat::QGroundControl => plan::bytes(part, &mut notes)?,
            MissionFormat::Waypoints => waypoints::bytes(part, &mut notes)?,
            MissionFormat::Litchi => litchi::bytes(part, &mut notes)?,
            MissionFormat::Kml => kml::bytes(part, &mut notes),
            MissionFormat::GeoJson => geojson::bytes(part)?,
        };
        let suffix = match count {
            1 => String::new(),
            _ => format!("-{number}"),
        };
        files.push((suffix, bytes));
    }
    // The parts say the same of the target.
    let mut said: Vec<String> = Vec::new();
    for note in notes {
        if !said.contains(&note) {
            said.push(note);
        }
    }
    Ok(MissionFiles { files, notes: said })
}

/// Writes missions where `path` says, in the format of its ending, each with its own words behind the stem; of a mission
/// that needs several files each has a number behind that. Each is whole or not there; nothing that was read is written
/// over.
///
/// # Errors
/// With the file: an ending that is none of a mission, what [`mission_files`] says, and what the rule of
/// [`files::write`] says.
pub fn write_missions(
    missions: &[(String, Mission)],
    path: &Path,
    inputs: &Inputs,
    force: bool,
) -> Result<WrittenMission, FileError> {
    let at = |fault| FileError::new(path, fault);
    let format = MissionFormat::of(path).map_err(at)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let mut named: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let mut said: Vec<String> = Vec::new();
    for (words, mission) in missions {
        let MissionFiles { files, notes } = mission_files(mission, format).map_err(at)?;
        for (suffix, bytes) in files {
            let name = format!("{stem}{words}{suffix}.{ending}");
            named.push((path.with_file_name(name), bytes));
        }
        for note in notes {
            if !said.contains(&note) {
                said.push(note);
            }
        }
    }
    if let Some(place) = missions
        .iter()
        .find_map(|(_, mission)| mission.take_off.as_ref())
    {
        said.push(format!(
            "the drone takes off at {:.6}, {:.6} (latitude, longitude): look whether that is the place",
            place.latitude, place.longitude
        ));
    }
    // None of them is written where one may not be.
    for (path, _) in &named {
        files::has_folder(path)
            .and_then(|()| files::may_write(path, Kind::Result, inputs, force))
            .map_err(|fault| FileError::new(path, fault))?;
    }
    said.extend(of_another_plan(path, &named));
    let mut written = Vec::new();
    for (path, bytes) in named {
        files::write(&path, &bytes, Kind::Result, inputs, force)
            .map_err(|fault| FileError::new(&path, fault))?;
        written.push(path);
    }
    Ok(WrittenMission {
        files: written,
        notes: said,
    })
}

/// That files stand beside a mission's that look like its parts and are none of `named`: of a plan with other batteries,
/// or more stops. Who flies them too flies an old plan.
fn of_another_plan(path: &Path, named: &[(PathBuf, Vec<u8>)]) -> Option<String> {
    let stem = path.file_stem()?.to_str()?;
    let is_part = |other: &Path| {
        let rest = (other.file_stem()?.to_str()?).strip_prefix(stem)?;
        let numbers = rest.strip_prefix("-battery").unwrap_or(rest);
        let is_number =
            |number: &str| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        let mut numbers = numbers.split('-');
        let is_numbered = numbers.next() == Some("") && numbers.all(is_number);
        (rest.is_empty() || is_numbered).then_some(())
    };
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let entries = folder.unwrap_or(Path::new(".")).read_dir().ok()?;
    let mut others: Vec<String> = entries
        .flatten()
        .map(|entry| path.with_file_name(entry.file_name()))
        .filter(|other| other.extension() == path.extension() && is_part(other).is_some())
        .filter(|other| named.iter().all(|(path, _)| path != other))
        .filter_map(|other| Some(other.file_name()?.to_string_lossy().into_owned()))
        .collect();
    others.sort();
    (!others.is_empty()).then(|| {
        format!(
            "{} beside it {} of another plan: take {} away, so that nobody flies it",
            others.join(", "),
            if others.len() == 1 { "is" } else { "are" },
            if others.len() == 1 { "it" } else { "them" },
        )
    })
}

/// A number with so many decimals, without zeros that say nothing: `-90`, `12.34`.
fn decimal(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    let short = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    match short {
        "-0" => "0".to_owned(),
        short => short.to_owned(),
    }
}

/// Degrees of a place: a tenth of a millimetre.
fn degrees(number: f64) -> String {
    decimal(number, 9)
}

/// Metres: a hundredth of a millimetre.
fn metres(number: f64) -> String {
    decimal(number, 5)
}

/// Degrees of an angle.
fn angle(number: f64) -> String {
    decimal(number, 4)
}
