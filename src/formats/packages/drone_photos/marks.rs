//! DJI's `*_Timestamp.MRK` beside the photos: the same exposures with more digits.

use std::fs;
use std::path::Path;

use crate::files::{FileError, read_text};
use crate::geodesy::{Geographic, ecef_from_geographic};
use crate::photos::photo_metadata::{Fix, HeightReference, PhotoMetadata};
use crate::poses::position_list::mrk::{self, MrkEvent, number_of_photo};

/// How far, in metres across the ground, a photo's own place may lie from the one that the .MRK has
/// for its number. Beyond it the numbers are another flight's.
const SAME_PLACE: f64 = 20.0;

/// Takes the places of photos from the .MRK files in their folder. Says what was done.
///
/// # Errors
/// Where an .MRK cannot be read.
pub(super) fn correct(
    folder: &Path,
    photos: &mut [(String, PhotoMetadata)],
) -> Result<Vec<String>, FileError> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries
        .map(|entry| entry.path())
        .filter(|path| {
            path.extension()
                .is_some_and(|e| e.eq_ignore_ascii_case("mrk"))
        })
        .collect();
    files.sort();
    let mut warnings = Vec::new();
    for file in &files {
        let events = mrk::read(&read_text(file)?).map_err(|fault| FileError::new(file, fault))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        // "100_0005_Timestamp.MRK" lies beside "100_0005_0001.JPG".
        let flight = name.to_ascii_lowercase();
        let flight = flight.split("timestamp").next().unwrap_or_default();
        let is_of_flight = |photo: &str| photo.to_ascii_lowercase().starts_with(flight);
        let has_prefix = photos.iter().any(|(photo, _)| is_of_flight(photo));
        if !has_prefix && files.len() > 1 {
            warnings.push(format!(
                "{name} is not used: no photo's name begins as its own"
            ));
            continue;
        }
        let (mut taken, mut apart) = (0_usize, 0_usize);
        for (photo, metadata) in photos.iter_mut() {
            if has_prefix && !is_of_flight(photo) {
                continue;
            }
            let number = number_of_photo(photo);
            let event = events.events.iter().find(|e| Some(e.number) == number);
            let (Some(event), Some(place)) = (event, &mut metadata.place) else {
                continue;
            };
            let measured = geographic(event);
            if metres_across(place.place, measured) > SAME_PLACE {
                apart += 1;
                continue;
            }
            place.place = measured;
            place.height = Some(HeightReference::Ellipsoid);
            place.fix = event.quality.map(Fix::of_dji).or(place.fix);
            place.deviation = event.deviation.or(place.deviation);
            taken += 1;
        }
        if taken > 0 {
            warnings.push(format!(
                "the positions of {taken} of {} photos are those of {name}, with heights above the ellipsoid",
                photos.len()
            ));
        }
        if apart > 0 {
            warnings.push(format!(
                "{name} has places over {SAME_PLACE} m from where {apart} photos say they were taken; these keep their own"
            ));
        }
    }
    Ok(warnings)
}

fn geographic(event: &MrkEvent) -> Geographic {
    Geographic {
        longitude: event.position.x,
        latitude: event.position.y,
        height: event.position.z,
    }
}

/// The distance between two places, heights aside.
fn metres_across(a: Geographic, b: Geographic) -> f64 {
    let on_ellipsoid = |place: Geographic| {
        ecef_from_geographic(Geographic {
            height: 0.0,
            ..place
        })
    };
    on_ellipsoid(a).distance(on_ellipsoid(b))
}
