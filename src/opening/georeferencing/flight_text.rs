//! The flight.toml of a reconstruction that was brought to the world.

use std::fs;
use std::path::Path;

use super::Georeferenced;
use crate::fault::Fault;
use crate::flight::{FlightFile, FlightSettings, ReconstructionFlight};
use crate::formats::FileError;
use crate::origin::{folder_of, path_from, real};
use crate::scale::StatedErrors;

impl Georeferenced {
    /// [`flight_text_of`] this.
    ///
    /// # Errors
    /// Likewise.
    pub fn flight_text(
        &self,
        target: &Path,
        reconstruction: &Path,
        photos: Option<&Path>,
        surface: Option<&Path>,
    ) -> Result<String, FileError> {
        flight_text_of(Some(self), None, target, reconstruction, photos, surface)
    }
}

/// The text of a flight.toml at `target` with the reconstruction in `reconstruction`, its paths relative to
/// `target`, and the standard errors of the scale, poses and focal length where they are known. The sixteen numbers of the transform
/// read back to the bit. A `surface` is taken as it is: it has to be in the world already. Not `placed`, the
/// flight has no unit. Without a `name` it has the reconstruction's.
///
/// Write it with `files::write`.
///
/// # Errors
/// Where the folder of `target` does not exist, a path is not Unicode, or `target` would hide the
/// reconstruction that it names.
pub fn flight_text_of(
    placed: Option<&Georeferenced>,
    name: Option<&str>,
    target: &Path,
    reconstruction: &Path,
    photos: Option<&Path>,
    surface: Option<&Path>,
) -> Result<String, FileError> {
    let at = |fault| FileError::new(target, fault);
    let folder = fs::canonicalize(folder_of(target)).map_err(|e| {
        let what = format!("its folder cannot be found ({e})");
        at(Fault::new(what, "choose a folder that exists"))
    })?;
    // A folder is opened as the flight.toml that lies in it.
    if target.file_name().is_some_and(|name| name == "flight.toml")
        && real(reconstruction) == folder
    {
        return Err(at(Fault::new(
            "a flight.toml in the folder of the reconstruction would be opened in its stead",
            "give the file another name or another folder",
        )));
    }
    let own_name = real(reconstruction);
    let own_name = own_name
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let named = |path: Option<&Path>| path.map(|path| path_from(&folder, path)).transpose();
    let photos = named(photos).map_err(at)?;
    let surface = named(surface).map_err(at)?;
    let flight = ReconstructionFlight {
        name: name.or(own_name.as_deref()).unwrap_or("flight"),
        reconstruction: &path_from(&folder, reconstruction).map_err(at)?,
        transform: placed.map(|placed| placed.similarity.to_row_major()),
        folder: photos.as_deref(),
        surface: surface.as_deref(),
        crs: placed.and_then(|placed| placed.crs.as_deref()),
    };
    let errors = StatedErrors {
        world_scale: placed.and_then(Georeferenced::stated_world_scale),
        ..placed.map_or_else(StatedErrors::default, |placed| placed.errors)
    };
    let usual = FlightSettings::default();
    let settings = FlightSettings {
        unit: placed.map_or(usual.unit, |placed| placed.unit),
        unit_known: placed.is_some(),
        errors,
        // Scale objects have sizes in the unit of another world.
        ..usual
    };
    FlightFile::for_reconstruction(&flight, &settings)
        .to_toml()
        .map_err(at)
}
