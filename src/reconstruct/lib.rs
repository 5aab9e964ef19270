//! Photos become a flight: the paper's first link ("VisualSFM: SIFT, matching, bundle adjustment"), inside
//! the program.
//!
//! ```text
//! photo_set    which files of a folder are photos for it, whose camera, where from
//! pairs        which photos are compared: neighbours, not all with all
//! engine       what an engine has to do
//! engine_name  the engines to choose between
//! card         a graphics card that computes; no_card where it is built without graphics
//! embedded     the engine that is always there: cumulus3d's parts, in pure Rust
//! colmap       COLMAP, where it is installed
//! adjusted     what an engine found, adjusted with the photos' places
//! kept_model   the same, kept for a run that goes on
//! quality      how much time the cloud may take
//! estimate     about how long all takes
//! dense_cloud  the dense cloud of a model
//! written      the folder that comes out, and where it goes if nobody says otherwise
//! said         what is said of the photos, and of what came out
//! ```
//!
//! What comes of it is COLMAP's text files, which `formats` reads as it reads COLMAP's own: so that an
//! engine's work is tested, replaced and looked at by other programs.
//!
//! This room stands on floor 5, above `opening`, whose georeferencing brings the model to the world.
//!
//! Pixels of photos are counted as everywhere here: (0, 0) is the outer corner of the first. cumulus3d
//! and COLMAP's files count likewise.

mod adjusted;
#[cfg(feature = "gpu")]
mod card;
#[cfg(not(feature = "gpu"))]
#[path = "no_card.rs"]
mod card;
mod colmap;
mod dense_cloud;
mod embedded;
mod engine;
mod engine_name;
mod estimate;
mod held_dense;
mod kept_model;
mod pairs;
mod photo_set;
mod quality;
mod said;
mod written;

use fragscale_core::{
    camera, fault, files, flight, geodesy, geometry, georeference, jobs, numbers, picture, surface,
};
use fragscale_dense as dense;
use fragscale_exports as exports;
use fragscale_formats as formats;
use fragscale_opening as opening;

use std::path::PathBuf;

pub use self::card::Card;
pub use self::colmap::Colmap;
pub use self::dense::DenseOptions;
pub use self::embedded::{Embedded, Growth, OnGrowth};
pub use self::engine::{Engine, Found, Sparse, Workplace};
pub use self::engine_name::EngineName;
pub use self::estimate::{about, processor_seconds};
pub use self::photo_set::{LeftOut, PhotoSet, SurveyPhoto};
pub use self::quality::Quality;
pub use self::said::{found, left_out, summary};
pub use self::written::{
    check_new_folder, empty_work, lock_work, may_be_made, name_of, proposed_folder,
};

use self::files::FileError;
use self::formats::read_camera;
use self::jobs::Progress;
use self::opening::Georeferenced;

/// What is to be reconstructed.
#[derive(Debug, Clone)]
pub struct Request {
    /// The folder of the photos.
    pub photos: PathBuf,
    /// The folder that comes out: new, empty, one of a run that did not end, or of one of the same photos whose
    /// cloud is to be another.
    pub to: PathBuf,
    /// The coordinate system of the world; without it the zone of UTM that the photos lie in.
    pub crs: Option<String>,
    /// The calibration of its photos' camera, which is kept; without it the lens is found from the photos.
    pub camera: Option<PathBuf>,
    /// How its dense cloud is found, see [`Quality`]; `None` keeps the sparse one.
    pub dense: Option<DenseOptions>,
    /// The graphics card that may compute; without it the processor does all.
    pub card: Option<Card>,
}

/// What came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstructed {
    /// The flight.toml.
    pub flight: PathBuf,
    /// How many photos the model holds.
    pub registered: usize,
    /// Of so many photos of the folder.
    pub photos: usize,
    /// Photos that it does not hold.
    pub left_out: Vec<LeftOut>,
    /// How many points it has, each seen by two photos at least.
    pub points: usize,
    /// Its dense cloud; `None` where the sparse one is the flight's.
    pub dense: Option<DensePoints>,
    /// How far points lie from where photos see them, pixels (median).
    pub reprojection_px: Option<f64>,
    /// Its way to the world; `None` where the photos do not say where they were taken.
    pub world: Option<Georeferenced>,
    /// The graphics card that computed, where one did to the end.
    pub computed_on: Option<String>,
    /// What is to be said of it, one sentence each.
    pub warnings: Vec<String>,
}

/// Of a dense cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DensePoints {
    /// How many points it has.
    pub count: usize,
    /// Standard deviation of its points along the rays that see them, in the unit of the world; in that of the
    /// model, which nobody knows, where it has no world.
    pub deviation: f64,
}

/// Reconstructs.
///
/// # Errors
/// With the file or folder that is to blame: no photos, photos that do not overlap, a folder that holds
/// other things; or the work was cancelled. What was done by then lies in the folder, and the same request
/// goes on with it.
pub fn reconstruct(
    request: &Request,
    engine: &dyn Engine,
    progress: &Progress,
) -> Result<Reconstructed, FileError> {
    let mut folder = written::folder(&request.to, &request.photos)?;
    let photos = PhotoSet::read(&request.photos, request.crs.as_deref(), progress)?;
    let photos = match &request.camera {
        None => photos,
        Some(path) => photos
            .with_camera(&read_camera(path)?)
            .map_err(|fault| FileError::new(path, fault))?,
    };
    folder.go_on_with(&photos, engine)?;
    let pairs = pairs::pairs(&photos);
    let at = |fault| FileError::new(&request.photos, fault);
    let find = || {
        let place = Workplace {
            folder: &folder.work,
            card: request.card.as_ref(),
        };
        let found = engine.reconstruct(&photos, &pairs, &place, progress)?;
        adjusted::adjusted(found, &photos, &folder.work, progress)
    };
    let kept_or_found = kept_model::kept_or_found(&folder.work, find);
    if let Err(fault) = kept_or_found.as_ref()
        && !progress.is_cancelled()
    {
        // Where that cannot be written, the fault itself is said all the same.
        let _ = folder.write_why(fault);
    }
    let (sparse, goes_on) = kept_or_found.map_err(at)?;
    let found = (engine.name(), sparse, goes_on);
    written::write(request, &mut folder, &photos, found, progress)
}

#[cfg(test)]
mod tests;
