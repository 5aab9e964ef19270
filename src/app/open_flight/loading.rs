//! Reading a flight and computing its scales: what a job does with what was named.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::fault::Fault;
use crate::flight::{FlightSettings, Outcome};
use crate::formats::FileError;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::opening::{self, Dropped, OpenOptions, Opened};

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
    let not_opened = |why| Box::new(NotOpened { why, tried: None });
    let dropped = Dropped::sort(paths).map_err(|error| not_opened(error.to_string()))?;
    let OpenOptions {
        surface,
        mut photos,
        ..
    } = dropped.options;
    let flight = match dropped.flight {
        None if !added => photos.take(),
        flight => flight,
    };
    match (flight, base) {
        (Some(flight), _) => Ok((
            flight,
            OpenOptions {
                surface,
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
                settings: None,
            },
        )),
        (None, None) => {
            let name = paths.first().map(|path| path.display().to_string());
            Err(not_opened(format!(
                "{}: a surface without photos; drop it together with the photos or with what the photogrammetry package wrote",
                name.unwrap_or_default()
            )))
        }
    }
}

/// Reads a flight and computes its scales; `again` for the open flight of this number, with these
/// settings.
pub(crate) fn load(
    path: PathBuf,
    mut options: OpenOptions,
    again: Option<(u64, FlightSettings)>,
    progress: &Progress,
) -> Result<Loaded, Box<NotOpened>> {
    let again_for = again.as_ref().map(|(number, _)| *number);
    options.settings = again.map(|(_, settings)| settings);
    let not_opened = |error: FileError| {
        Box::new(NotOpened {
            why: error.to_string(),
            tried: Some((path.clone(), options.clone())),
        })
    };
    let begun = Instant::now();
    let opened = opening::open_flight(&path, &options, progress).map_err(not_opened)?;
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
