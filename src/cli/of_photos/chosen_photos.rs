//! Which photos of a flight a command is for, and what becomes of those that it cannot be done for.

use std::path::Path;

use clap::Args;

use crate::fault::{Fault, by_cause};
use crate::files::FileError;
use crate::flight::Flight;
use crate::jobs::Progress;

/// `--photo` or `--all`.
#[derive(Debug, Clone, Args)]
#[group(required = true, multiple = false)]
pub(super) struct ChosenPhotos {
    /// The photo, as the flight names it; once for each of several.
    #[arg(long, value_name = "NAME")]
    photo: Vec<String>,
    /// All photos of the flight.
    #[arg(long)]
    all: bool,
}

/// Why a photo's files are not made.
pub(super) enum NotMade {
    /// Of this photo: others may do.
    Photo(Fault),
    /// A file cannot be written: nothing goes on.
    File(String),
}

impl From<Fault> for NotMade {
    fn from(fault: Fault) -> Self {
        Self::Photo(fault)
    }
}

impl From<String> for NotMade {
    fn from(error: String) -> Self {
        Self::File(error)
    }
}

/// What is done with each photo, for sentences.
pub(super) struct Doing {
    /// "rectifying"
    pub doing: &'static str,
    /// "not rectified"
    pub not_done: &'static str,
}

/// The photos that something was not done with.
pub(super) struct NotDone {
    not_done: &'static str,
    photos: Vec<(String, Fault)>,
}

impl NotDone {
    /// How many they are.
    pub(super) fn count(&self) -> usize {
        self.photos.len()
    }

    /// That it was not done with these of so many photos, where there are any.
    pub(super) fn not_all(&self, of: usize) -> Option<Fault> {
        let (name, fault) = self.photos.first()?;
        let what = format!("{} of {of} photos are {}", self.photos.len(), self.not_done);
        let first = format!("{name}: {}: {fault}", self.not_done);
        Some(Fault::new(what, format!("the first: {first}")))
    }

    /// A sentence for each cause, besides the fault above, which says what is wrong with the first: of one photo that
    /// is all.
    pub(super) fn sentences(&self) -> Vec<String> {
        if self.photos.len() == 1 {
            return Vec::new();
        }
        let said = self.photos.iter();
        let said = said.map(|(name, fault)| (name.as_str(), format!("{}: {fault}", self.not_done)));
        by_cause(said, "photos")
    }
}

impl ChosenPhotos {
    /// These photos; without a name all of them.
    pub(super) fn named_or_all(photo: Vec<String>) -> Self {
        let all = photo.is_empty();
        Self { photo, all }
    }

    /// Whether it is one photo, for which what cannot be done is an error.
    pub(super) fn is_one(&self) -> bool {
        let mut named = self.photo.iter();
        let first = named.next();
        first.is_some_and(|first| named.all(|name| name == first))
    }

    /// Whether it is all of them, whatever they are.
    pub(super) fn are_all(&self) -> bool {
        self.all
    }

    /// The places of the photos in the flight, in its order, whose lengths mean something.
    ///
    /// # Errors
    /// Where there is no such photo, or the model is in a frame of its own.
    pub(super) fn of(&self, flight: &Flight) -> Result<Vec<usize>, Fault> {
        if !flight.parts().unit_known {
            return Err(Fault::new(
                "the model is in a frame of its own, whose unit nobody states",
                "georeference it, or say the unit in a flight.toml ([world] unit)",
            ));
        }
        if self.all {
            return Ok((0..flight.parts().photos.len()).collect());
        }
        let named = self.photo.iter().map(|name| flight.photo_typed(name));
        let mut named = named.collect::<Result<Vec<_>, _>>()?;
        // In the flight's order, each once.
        named.sort_unstable();
        named.dedup();
        Ok(named)
    }

    /// Makes the files of each chosen photo by `make`, which gets the photo's place among them. Of several
    /// photos those that cannot be made are left out, and come back. `path` is the flight's.
    ///
    /// # Errors
    /// Where the one photo cannot be made, a file cannot be written, or the work was cancelled.
    pub(super) fn make_each<'a>(
        &self,
        names: impl ExactSizeIterator<Item = &'a str>,
        doing: &Doing,
        path: &Path,
        progress: &Progress,
        mut make: impl FnMut(usize) -> Result<(), NotMade>,
    ) -> Result<NotDone, String> {
        let in_flight = |fault| FileError::new(path, fault).to_string();
        let mut photos = Vec::new();
        let count = names.len() as u64;
        for (place, name) in names.enumerate() {
            progress.stage(format!("{} {name}", doing.doing));
            progress.advance(place as u64, count).map_err(in_flight)?;
            match make(place) {
                Ok(()) => {}
                Err(NotMade::File(error)) => return Err(error),
                Err(NotMade::Photo(fault)) if progress.is_cancelled() || self.is_one() => {
                    let what = format!("{name}: {}", fault.what);
                    return Err(in_flight(Fault::new(what, fault.remedy)));
                }
                Err(NotMade::Photo(fault)) => {
                    photos.push((name.to_owned(), fault));
                }
            }
        }
        Ok(NotDone {
            not_done: doing.not_done,
            photos,
        })
    }
}
