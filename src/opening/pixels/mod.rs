//! What the pixels of photos say against their scales: every photo is read once, and compared with the colours of the surface and
//! with the photos beside it.
//!
//! ```text
//! colours   a photo and the colours of the surface
//! pairs     which photos are beside each other
//! together  two photos and the place of the surface
//! ```

mod colours;
mod pairs;
mod together;

pub use colours::Colours;
pub use together::{PhotosTogether, Together};

use crate::fault::Fault;
use crate::flight::{ColoursFound, Evidence, Review, TogetherFound};
use crate::jobs::Progress;
use crate::photo_files::PhotoFile;
use crate::picture::for_comparing;

/// What was found, each with the photo's place in the flight.
#[derive(Debug, Clone)]
pub struct ComparedPixels {
    /// Of those whose colours nobody had compared.
    pub colours: Vec<(usize, Colours)>,
    /// Of those that nobody had compared with those beside them.
    pub together: Vec<(usize, Together)>,
}

/// Reads the photos of a review's flight and compares them, as far as nobody has yet; `files` are parallel to its photos.
///
/// # Errors
/// Where the work was cancelled.
pub fn compare_pixels(
    review: &Review,
    files: &[PhotoFile],
    progress: &Progress,
) -> Result<ComparedPixels, Fault> {
    let (flight, evidence) = (review.flight(), &review.looked_up().evidence);
    let parts = flight.parts();
    let why_no_colours = match (parts.surface.is_part(), parts.surface.colors().is_empty()) {
        (true, _) => Some("not looked at: only a part of the surface was read"),
        (false, true) => Some("the surface has no colours"),
        (false, false) => None,
    };
    // They are found all at once, or not yet.
    let is_new = |evidence: &Evidence| evidence.together == TogetherFound::NotCompared;
    let mut together = match evidence.iter().all(is_new) {
        true => PhotosTogether::new(flight, review.outcomes(), files, progress)?,
        false => PhotosTogether::default(),
    };
    progress.stage("comparing photos");
    let mut colours = Vec::new();
    for (index, (file, evidence)) in files.iter().zip(evidence).enumerate() {
        progress.advance(index as u64, parts.photos.len() as u64)?;
        let wants_colours = evidence.colours == ColoursFound::NotCompared;
        let is_read = together.wants(index) || wants_colours && why_no_colours.is_none();
        let read = is_read.then(|| file.pixels());
        let small = match &read {
            Some(Some(Ok(pixels))) => for_comparing(pixels, flight.camera(&parts.photos[index])),
            _ => None,
        };
        match &small {
            Some(small) => together.take(flight, index, small, progress),
            None => together.give_up(index),
        }
        if !wants_colours {
            together.take_colours(index, &evidence.colours);
            continue;
        }
        let found = match read {
            None => Colours::Not(why_no_colours.unwrap_or_default().to_owned()),
            Some(None) => Colours::Not("no image file".to_owned()),
            Some(Some(Err(error))) => Colours::Unreadable(error.fault.to_string()),
            Some(Some(Ok(_))) => Colours::of_photo(flight, index, small.as_ref()),
        };
        together.take_colours(index, &(&found).into());
        colours.push((index, found));
    }
    Ok(ComparedPixels {
        colours,
        together: together.found(flight),
    })
}

/// Compares the photos as far as nobody has yet, and tells the review.
///
/// # Errors
/// Where the surface cannot be met, or the work was cancelled.
pub fn compare_all_pixels(
    review: &mut Review,
    files: &[PhotoFile],
    progress: &Progress,
) -> Result<(), Fault> {
    let compared = compare_pixels(review, files, progress)?;
    take_compared(review, &compared);
    Ok(())
}

/// Tells the review what was found.
pub fn take_compared(review: &mut Review, compared: &ComparedPixels) {
    let colours = compared.colours.iter();
    review.take_colours(colours.map(|(photo, colours)| (*photo, colours.into())));
    let together = compared.together.iter();
    review.take_together(together.map(|(photo, together)| (*photo, together.into())));
}
