//! The reconstruction behind a flight that is given in its place: `fragscale reconstruct` writes a flight with the
//! model beside it, and that is what an engineer has.

use std::path::{Path, PathBuf};

use crate::flight::{FlightFile, PhotoSource};
use crate::formats::{Kind, MODEL, detect, read_text};
use crate::origin::folder_of;

/// What a flight says of the reconstruction that it is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BehindFlight {
    /// Where the reconstruction is.
    pub reconstruction: PathBuf,
    /// The flight's name.
    pub name: Option<String>,
    /// The folder of its photos.
    pub photos: Option<PathBuf>,
    /// Whether it has a place in a coordinate system, which the reconstruction knows nothing of.
    pub has_place: bool,
}

/// Of a flight.toml or the folder in which it lies; `None` where there is none, or nothing behind it.
pub fn behind_flight(path: &Path) -> Option<BehindFlight> {
    let Ok(Kind::Flight(file)) = detect(path) else {
        return None;
    };
    let flight = FlightFile::parse(&read_text(&file).ok()?).ok()?;
    let folder = folder_of(&file);
    let reconstruction = match flight.photo_source() {
        PhotoSource::Reconstruction(named, _) => folder.join(named),
        PhotoSource::Poses(_) => folder.join(MODEL),
        PhotoSource::None => return None,
    };
    reconstruction.exists().then(|| BehindFlight {
        reconstruction,
        name: flight.name.clone(),
        photos: flight.photo_folder().map(|photos| folder.join(photos)),
        has_place: flight.crs().is_some() || flight.settings().placed.is_some(),
    })
}
