//! Several files named at once: what is the flight, what its surface, what its photos.

use std::path::{Path, PathBuf};

use crate::OpenOptions;
use crate::fault::Fault;
use crate::files::FileError;
use crate::formats::missions::no_flight_but_mission;
use crate::formats::tables::size_distributions::no_flight_but_sizes;
use crate::formats::{Kind, Package, detect, no_surface_but_places};
use crate::meant::is_of_their_photos;

/// How several of them are called.
const PHOTOS: &str = "folders of photos";

/// What several paths are to each other.
#[derive(Debug, Clone, Default)]
pub struct Dropped {
    /// The flight or reconstruction; `None` where only what belongs to one was named.
    pub flight: Option<PathBuf>,
    /// The surface and the folder of photos that were named beside it.
    pub options: OpenOptions,
}

impl Dropped {
    /// Looks what each path holds.
    ///
    /// # Errors
    /// Where one holds nothing that is known, or two are the same part of a flight.
    pub fn sort(paths: &[PathBuf]) -> Result<Self, FileError> {
        let mut dropped = Self::default();
        let mut photos = None;
        for path in paths {
            let kind = match detect(path) {
                // Flights in its folders are none that are meant beside one.
                Err(_) if is_of_their_photos(path, paths) => {
                    Kind::Reconstruction(Package::Photos, path.clone())
                }
                kind => kind?,
            };
            let (part, name) = match kind {
                Kind::Cloud(format) => {
                    // Told before it counts as a second surface.
                    if let Some(fault) = no_surface_but_places(path, format) {
                        return Err(FileError::new(path, fault));
                    }
                    (&mut dropped.options.surface, "surfaces")
                }
                Kind::Reconstruction(Package::Photos, _) => (&mut photos, PHOTOS),
                Kind::Flight(_) | Kind::Reconstruction(..) => (&mut dropped.flight, "flights"),
                Kind::SizeDistributions => {
                    return Err(FileError::new(path, no_flight_but_sizes()));
                }
                Kind::Mission => return Err(FileError::new(path, no_flight_but_mission())),
                kind @ (Kind::Camera | Kind::Poses | Kind::Trajectory(_)) => {
                    return Err(no_part(path, &kind));
                }
            };
            // One photo stands for the folder that it is in.
            let path = match path.parent() {
                Some(folder) if name == PHOTOS && path.is_file() => folder,
                _ => path.as_path(),
            };
            if let Some(first) = part.replace(path.to_owned())
                && (first != path || name != PHOTOS)
            {
                return Err(FileError::new(
                    path,
                    Fault::new(
                        format!("it and {} are two {name}", first.display()),
                        "open one flight at a time, with one surface",
                    ),
                ));
            }
        }
        dropped.options.photos = photos;
        Ok(dropped)
    }
}

fn no_part(path: &Path, kind: &Kind) -> FileError {
    let what = format!("it holds {}, not a flight", kind.in_words());
    FileError::new(
        path,
        Fault::new(what, "name it in a flight.toml and open that"),
    )
}
