//! Reading a flight and computing its scales: what a job does with what was named.

mod read_again;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::command::Asking;
use crate::fault::Fault;
use crate::flight::{FlightSettings, Outcome};
use crate::formats::{Candidate, FileError, Kind, Package, detect};
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::opening::{self, Dropped, OnSample, OpenOptions, Opened};

/// A flight with its scales.
#[derive(Debug)]
pub struct Loaded {
    /// What the user named.
    pub path: PathBuf,
    /// The surface and photos that she named beside it.
    pub options: OpenOptions,
    /// What was read.
    pub opened: Opened,
    /// Of each photo.
    pub outcomes: Vec<Outcome>,
    /// Around the surface.
    pub surface_bounds: Bounds,
    /// Around the surface without outliers.
    pub bulk_bounds: Bounds,
    /// How long reading took, and computing the scales.
    pub took: [Duration; 2],
    /// The number of the open flight that was read again with other surface options.
    pub again_for: Option<u64>,
}

/// A flight that cannot be opened.
#[derive(Debug)]
pub struct NotOpened {
    /// Why, in a line.
    pub why: String,
    /// What would mend it, and can be asked for.
    pub asks: Option<Asking>,
    /// Which flights a folder holds of which none was named.
    pub choices: Vec<Candidate>,
    /// The folder of photos that was named as a flight: they can be reconstructed.
    pub photos: Option<PathBuf>,
    /// What was tried, if a flight was named: its surface or its photos may be named next.
    pub tried: Option<(PathBuf, OpenOptions)>,
}

/// Which flight was named, with which surface and photos; `base` is the one that a surface or photos
/// alone belong to.
pub(crate) fn named(
    paths: &[PathBuf],
    base: Option<(PathBuf, OpenOptions)>,
    added: bool,
) -> Result<(PathBuf, OpenOptions), Box<NotOpened>> {
    let not_opened = |why| {
        Box::new(NotOpened {
            why,
            asks: None,
            choices: Vec::new(),
            photos: None,
            tried: None,
        })
    };
    let paths = opening::meant_by(paths).map_err(|choices| {
        Box::new(NotOpened {
            choices,
            ..*not_opened("it holds several flights: choose one".to_owned())
        })
    })?;
    let dropped = Dropped::sort(&paths).map_err(|error| not_opened(error.to_string()))?;
    let OpenOptions {
        surface,
        mut photos,
        ..
    } = dropped.options;
    let flight = match dropped.flight {
        None if !added => photos.take(),
        flight => flight,
    };
    // A cloud that is looked at is the surface of what is added to it, not of what is opened next.
    let base_is_cloud = base.as_ref().is_some_and(|(path, _)| is_cloud(path));
    let (alone, base) = match base_is_cloud {
        true => (base.map(|(path, _)| path), None),
        false => (None, base),
    };
    match (
        flight.or(photos.take_if(|_| added && alone.is_some())),
        base,
    ) {
        (Some(flight), _) => Ok((
            flight,
            OpenOptions {
                surface: surface.or(alone.filter(|_| added)),
                photos,
                ..OpenOptions::default()
            },
        )),
        (None, Some((path, before))) => Ok((
            path,
            OpenOptions {
                surface: surface.or(before.surface),
                photos: photos.or(before.photos),
                topic: before.topic,
                ..OpenOptions::default()
            },
        )),
        (None, None) => match surface {
            Some(cloud) => Ok((cloud, OpenOptions::default())),
            None => Err(not_opened("nothing to open was named".to_owned())),
        },
    }
}

/// Whether this is a cloud or mesh.
pub(crate) fn is_cloud(path: &Path) -> bool {
    matches!(detect(path), Ok(Kind::Cloud(_)))
}

fn is_folder_of_photos(path: &Path) -> bool {
    let of_photos = |kind| matches!(kind, Kind::Reconstruction(Package::Photos, _));
    path.is_dir() && detect(path).is_ok_and(of_photos)
}

/// Reads a flight and computes its scales; `again` for the open flight of this number, with these
/// settings. A sample of a large surface is handed to `on_sample`, where somebody wants it.
pub(crate) fn load(
    path: PathBuf,
    mut options: OpenOptions,
    again: Option<(u64, FlightSettings)>,
    on_sample: Option<OnSample<'_>>,
    progress: &Progress,
) -> Result<Loaded, Box<NotOpened>> {
    let again_for = again.as_ref().map(|(number, _)| *number);
    options.settings = again.map(|(_, settings)| settings);
    options.may_lack_photos = true;
    let not_opened = |error: FileError| {
        Box::new(NotOpened {
            asks: error.fault.lacks.map(|_| Asking::Add),
            choices: Vec::new(),
            why: error.to_string(),
            photos: is_folder_of_photos(&path).then(|| path.clone()),
            tried: Some((path.clone(), options.clone())),
        })
    };
    let begun = Instant::now();
    let opened =
        opening::open_flight_sampled(&path, &options, on_sample, progress).map_err(not_opened)?;
    let read = begun.elapsed();
    let at_path = |fault: Fault| not_opened(FileError::new(&path, fault));
    let outcomes = opened.flight.scales(progress).map_err(at_path)?;
    let surface = &opened.flight.parts().surface;
    let (surface_bounds, bulk_bounds) = (surface.bounds(), surface.bulk_bounds());
    Ok(Loaded {
        path,
        options,
        opened,
        outcomes,
        surface_bounds,
        bulk_bounds,
        took: [read, begun.elapsed().saturating_sub(read)],
        again_for,
    })
}
