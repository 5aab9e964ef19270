//! Which photos of a flight a command is for.

use clap::Args;

use crate::fault::Fault;
use crate::flight::Flight;

/// `--photo` or `--all`.
#[derive(Debug, Clone, Args)]
#[group(required = true, multiple = false)]
pub(super) struct ChosenPhotos {
    /// The photo, as the flight names it.
    #[arg(long, value_name = "NAME")]
    photo: Option<String>,
    /// All photos of the flight.
    #[arg(long)]
    pub(super) all: bool,
}

impl ChosenPhotos {
    /// The places of the photos in the flight.
    ///
    /// # Errors
    /// Where there is no such photo.
    pub(super) fn of(&self, flight: &Flight) -> Result<Vec<usize>, Fault> {
        match &self.photo {
            Some(name) => Ok(vec![flight.photo_named(name)?]),
            None => Ok((0..flight.parts().photos.len()).collect()),
        }
    }
}

/// A model in a frame of its own has lengths that mean nothing.
pub(super) fn check_unit(flight: &Flight) -> Result<(), Fault> {
    match flight.parts().unit_known {
        true => Ok(()),
        false => Err(Fault::new(
            "the model is in a frame of its own, whose unit nobody states",
            "georeference it, or say the unit in a flight.toml ([world] unit)",
        )),
    }
}
