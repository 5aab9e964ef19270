//! `fragscale check`: what a careful engineer looks at before she trusts a flight, with numbers.

use std::fmt::Write as _;

use clap::Args;

use super::Answer;
use super::flight_arguments::FlightArguments;
use crate::fault::Fault;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::{self, Colours};
use crate::picture::Agreement;

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
    let mut warnings = opened.all_warnings();
    let mut text = String::from("colours of photo and surface (r is 1 where they match)\n");
    if parts.surface.colors().is_empty() {
        text.push_str("the surface has no colours\n");
        return Ok(Answer::new(text, warnings));
    }
    let at = |fault: Fault| FileError::new(&arguments.flight.flight, fault).to_string();
    let colours =
        opening::compare_colours(flight, &opened.photo_files, &[], progress).map_err(at)?;
    for (photo, colours) in parts.photos.iter().zip(&colours) {
        let name = &photo.name;
        let said = match colours {
            Colours::Not(why) | Colours::Unreadable(why) => why.clone(),
            Colours::Compared(Agreement {
                points,
                correlation,
                ..
            }) => format!("r = {correlation:.2} at {points} points"),
        };
        let doubt = colours.doubt();
        warnings.extend(doubt.map(|doubt| format!("photo '{name}': {doubt}")));
        // Writing into a text does not fail.
        let _ = writeln!(text, "{name}  {said}");
    }
    Ok(Answer::new(text, warnings))
}
