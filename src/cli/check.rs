//! `fragscale check`: what a careful engineer looks at before she trusts a flight, with numbers.

use std::fmt::Write as _;
use std::path::Path;

use clap::Args;

use super::Answer;
use super::flight_arguments::FlightArguments;
use crate::fault::Fault;
use crate::formats::{FileError, read_bytes};
use crate::jobs::Progress;
use crate::picture::{Agreement, decode, undistorted};

/// The longer side at which colours are compared, pixels: finer than most clouds.
const COMPARED: u32 = 1024;

#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    #[command(flatten)]
    flight: FlightArguments,
}

/// Opens the flight, which looks at coordinate systems, places, sizes and metadata, and compares the
/// colours of the photos with those of the surface.
pub(super) fn check(arguments: &CheckArguments, progress: &Progress) -> Result<Answer, String> {
    let opened = arguments.flight.open(progress)?;
    let flight = &opened.flight;
    let parts = flight.parts();
    let mut warnings = opened.warnings;
    let mut text = String::from("colours of photo and surface (r is 1 where they match)\n");
    if parts.surface.colors().is_empty() {
        text.push_str("the surface has no colours\n");
        return Ok(Answer { text, warnings });
    }
    progress.stage("comparing colours");
    for (index, (photo, file)) in parts.photos.iter().zip(&opened.photo_files).enumerate() {
        let at = |fault: Fault| FileError::new(&arguments.flight.flight, fault).to_string();
        progress
            .advance(index as u64, parts.photos.len() as u64)
            .map_err(at)?;
        let camera = flight.camera(photo);
        let found = match &file.path {
            None => Err("no image file".to_owned()),
            Some(path) => read(path).map(|image| {
                let plane = undistorted(&image, camera, COMPARED);
                Agreement::of(&parts.surface, camera, &photo.pose, &plane)
            }),
        };
        let said = match found {
            Err(why) => why,
            Ok(None) => "the surface has no colours there".to_owned(),
            Ok(Some(agreement)) => {
                warnings.extend(agreement.warning(&photo.name));
                let Agreement {
                    points,
                    correlation,
                    ..
                } = agreement;
                format!("r = {correlation:.2} at {points} points")
            }
        };
        // Writing into a text does not fail.
        let _ = writeln!(text, "{}  {said}", photo.name);
    }
    Ok(Answer { text, warnings })
}

fn read(path: &Path) -> Result<image::RgbImage, String> {
    let bytes = read_bytes(path).map_err(|error| error.to_string())?;
    decode(&bytes).map_err(|fault| FileError::new(path, fault).to_string())
}
