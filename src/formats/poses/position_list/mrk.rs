//! DJI's `*_Timestamp.MRK`: one line a photo, written by drones with RTK beside their photos.
//!
//! ```text
//! 2  296288.242869  [2211]  3,N  0,E  75,V  47.6436873208,Lat  16.4759271684,Lon  512.998,Ellh  0.014391, 0.013698, 0.029694  50,Q
//! ```
//!
//! From DJI's manuals ("Image Log File": Matrice 4 Series User Manual, page 92; the same columns in
//! the Phantom 4 RTK's PPK notes): the number of the photo, GPS seconds of week and week of the
//! exposure, how far the sensor lies from the antenna towards north, east and DOWN in mm, latitude,
//! longitude and ellipsoidal height of the SENSOR (the offset is in them already), standard
//! deviations towards north, east and up in metres, and the state of the solution: 0 none, 16 single,
//! 32 to 49 float, 50 fixed. Separated by tabs, in some firmwares by spaces or commas; the letters
//! behind the values tell them apart. Skydio's X10 writes the same.
//!
//! The number is the last run of digits in the photo's name (DJI_0002.JPG, 100_0005_0002.JPG,
//! DJI_20230102030405_0002_V.JPG).

use glam::DVec3;

use super::{NamedPosition, PositionList, check_degrees};
use crate::fault::Fault;

/// The lines of an .MRK.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct MrkFile {
    pub(crate) events: Vec<MrkEvent>,
}

/// One exposure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MrkEvent {
    /// The number in the photo's name.
    pub(crate) number: u32,
    /// Degrees east, degrees north, metres above the ellipsoid: the sensor's place.
    pub(crate) position: DVec3,
    /// Standard deviations towards east, north and up, in metres, where they are there.
    pub(crate) deviation: Option<DVec3>,
    /// As DJI's RtkFlag, where it is there.
    pub(crate) quality: Option<u32>,
}

/// Whether a line is one of an .MRK.
pub(super) fn is_mrk(line: &str) -> bool {
    let mut words = line.split(separator).filter(|word| !word.is_empty());
    let number = words.next().is_some_and(|word| word.parse::<u32>().is_ok());
    let time = words.next().is_some_and(|word| word.parse::<f64>().is_ok());
    number && time && words.next().is_some_and(|week| week.starts_with('['))
}

fn separator(c: char) -> bool {
    c.is_whitespace() || c == ','
}

/// Reads an .MRK.
pub(crate) fn read(text: &str) -> Result<MrkFile, Fault> {
    let mut file = MrkFile::default();
    for (line, number) in text.lines().zip(1..) {
        if !line.trim().is_empty() {
            file.events.push(event(line, number)?);
        }
    }
    Ok(file)
}

fn event(text: &str, line: u64) -> Result<MrkEvent, Fault> {
    let fault = |what: String| Fault::at(line, what, "give the .MRK as the drone wrote it");
    let words: Vec<&str> = text.split(separator).filter(|w| !w.is_empty()).collect();
    let number_at = |place: Option<usize>, name: &str| {
        let word = place.and_then(|place| words.get(place)).copied();
        let word = word.ok_or_else(|| fault(format!("the line has no {name}")))?;
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(fault(format!("{name} is '{word}', not a number"))),
        }
    };
    let tagged = |tag: &str| {
        let place = words.iter().position(|word| word.eq_ignore_ascii_case(tag));
        place.and_then(|place| place.checked_sub(1))
    };
    let number = words.first().and_then(|word| word.parse().ok());
    let number =
        number.ok_or_else(|| fault("the line begins with no photo's number".to_owned()))?;
    let position = DVec3::new(
        number_at(tagged("Lon"), "longitude (Lon)")?,
        number_at(tagged("Lat"), "latitude (Lat)")?,
        number_at(tagged("Ellh"), "height (Ellh)")?,
    );
    check_degrees(line, position)?;
    // The deviations are the three numbers behind the height.
    let behind = tagged("Ellh").map_or(0, |place| place + 2);
    let deviation = match words.get(behind..behind + 3) {
        Some([north, east, up]) => match (north.parse(), east.parse(), up.parse()) {
            (Ok(north), Ok(east), Ok(up)) => Some(DVec3::new(east, north, up)),
            _ => None,
        },
        _ => None,
    };
    let quality = tagged("Q").and_then(|place| words.get(place)?.parse().ok());
    Ok(MrkEvent {
        number,
        position,
        deviation: deviation.filter(|deviation| deviation.is_finite()),
        quality,
    })
}

impl MrkFile {
    /// As a list of positions, named by the photos' numbers.
    pub(super) fn positions(self) -> PositionList {
        let mut warnings = vec![
            "photos are named by their numbers, the last digits in a DJI photo's name; heights are above the ellipsoid".to_owned(),
        ];
        let not_fixed = self.events.iter().filter(|event| event.quality != Some(50));
        let not_fixed = not_fixed.count();
        if not_fixed > 0 {
            warnings.push(format!(
                "{not_fixed} of {} positions are no fixed RTK solution (Q 50): decimetres to metres off",
                self.events.len()
            ));
        }
        let position = |event: MrkEvent| NamedPosition {
            name: event.number.to_string(),
            position: event.position,
            accuracy: event.deviation,
            looks: None,
        };
        PositionList {
            crs: Some("EPSG:4326".to_owned()),
            positions: self.events.into_iter().map(position).collect(),
            warnings,
        }
    }
}

/// The number in a photo's name that an .MRK calls it by: its last run of digits.
pub fn number_of_photo(name: &str) -> Option<u32> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let end = stem.trim_end_matches(|c: char| !c.is_ascii_digit());
    end.rsplit(|c: char| !c.is_ascii_digit())
        .next()?
        .parse()
        .ok()
}
