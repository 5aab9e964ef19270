//! `--photo`: which photos of a flight are written, where not all are.

use clap::Args;

use crate::fault::Fault;
use crate::flight::Flight;

/// The argument.
#[derive(Debug, Args)]
pub(super) struct NamedPhotos {
    /// Only this photo, as the flight names it; once for each of several.
    #[arg(long, value_name = "NAME")]
    photo: Vec<String>,
}

impl NamedPhotos {
    /// Whether any is named.
    pub(super) fn is_any(&self) -> bool {
        !self.photo.is_empty()
    }

    /// Whether each photo of the flight is named; all are where none is.
    ///
    /// # Errors
    /// Where the flight has no such photo.
    pub(super) fn of(&self, flight: &Flight) -> Result<Vec<bool>, Fault> {
        let mut named = vec![self.photo.is_empty(); flight.parts().photos.len()];
        for name in &self.photo {
            named[flight.photo_typed(name)?] = true;
        }
        Ok(named)
    }
}
