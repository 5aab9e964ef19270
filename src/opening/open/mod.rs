//! Opening a flight: flight.toml with the files that it names, or a reconstruction given directly.
//!
//! ```text
//! source    what the flight is made of: what every step adds to
//! reading   flight.toml, or the reconstruction
//! cameras   the [[camera]] tables; the cameras meet their photo files
//! surface   its file; turned_mesh where Meshroom turned it
//! framing   poses and surface are brought to one world
//! placing   control points bring both to another one
//! image_points  how far the package's own image points are off its cameras and points
//! lengths   in which unit, and whether its lengths are lengths
//! building  the flight
//! within    all of that again with more of a large cloud
//! ```

mod building;
mod cameras;
mod framing;
mod image_points;
mod lengths;
mod placing;
mod reading;
mod source;
mod surface;
mod turned_mesh;
mod within;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::RgbImage;

use crate::fault::Fault;
use crate::files::{FileError, Inputs, Recording};
use crate::flight::{Flight, FlightFile, FlightSettings, Limits, LookedUp, Review};
use crate::formats;
use crate::in_part::InPart;
use crate::jobs::Progress;
use crate::origin::FlightOrigin;
use crate::photo_files::PhotoFile;
use crate::picture;
use crate::pixels::compare_all_pixels;
use crate::surface::{Cloud, UpAxis};

pub use within::with_flight;

/// What the user says beside the flight itself.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    /// A cloud or mesh to use instead of the flight's own surface.
    pub surface: Option<PathBuf>,
    /// The folder of the image files, instead of the flight's own.
    pub photos: Option<PathBuf>,
    /// The topic of a ROS recording whose poses are taken, instead of the flight's own choice.
    pub topic: Option<String>,
    /// What to set instead of what the flight says.
    pub settings: Option<FlightSettings>,
    /// The axis of the surface's file that points up, instead of what the flight says.
    pub surface_up: Option<UpAxis>,
    /// Whether a cloud without photos is opened, to be looked at: there is no scale in it.
    pub may_lack_photos: bool,
}

/// A sample of a large surface, in its file's coordinates with z up: to be looked at while it is read.
#[derive(Debug, Clone)]
pub struct SurfaceSample {
    /// Some of its points.
    pub cloud: Cloud,
    /// How many points the file has.
    pub of: u64,
}

/// Takes a sample of a large surface before the surface is read.
pub type OnSample<'a> = &'a dyn Fn(SurfaceSample, &Progress);

/// The reconstruction that a flight's poses are from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FlightReconstruction {
    /// The file or folder.
    pub path: PathBuf,
    /// Who says that it is in the world already, in words; `None` in a frame of its own.
    pub in_world: Option<String>,
}

/// A flight with what was noticed on the way.
#[derive(Debug)]
pub struct Opened {
    /// Ready for scales.
    pub flight: Arc<Flight>,
    /// What was noticed while reading, one sentence each, with the file in front where there is one.
    pub warnings: Vec<String>,
    /// The image file of each photo, in the order of the flight's photos.
    pub photo_files: Vec<PhotoFile>,
    /// The photos that lie beside them and have no pose, in words.
    pub without_pose: Option<String>,
    /// What was looked up of the photos, their colours excepted.
    pub looked_up: LookedUp,
    /// What the surface's triangles say is up, where that is not z.
    pub doubtful_up: Option<UpAxis>,
    /// The coordinate system of the world where the files state one: "EPSG:n" or WKT.
    pub crs: Option<String>,
    /// What was set, by the flight's file or by [`OpenOptions`].
    pub settings: FlightSettings,
    /// The flight.toml with its path, where the flight came from one.
    pub file: Option<(PathBuf, FlightFile)>,
    /// Where the flight came from, and how to save it.
    pub origin: FlightOrigin,
    /// The reconstruction that it was made of; `None` where its poses are in a file of their own.
    pub reconstruction: Option<FlightReconstruction>,
    /// Every file that was read except the photos, in the order of reading.
    pub inputs: Vec<PathBuf>,
    /// These, the photos and whatever was opened on the way: nothing of it may be written over.
    pub read: Inputs,
}

impl Opened {
    /// Whether what was computed of it so far holds: of a cloud that is read in part, only where nothing was asked
    /// for that is not in memory.
    pub fn is_settled(&self) -> bool {
        self.flight.parts().surface.wanted().is_nothing()
    }

    /// What was noticed while reading and what was looked up, one sentence each with the file in front.
    pub fn all_warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        warnings.extend(self.looked_up.warnings_of(self.origin.path.display()));
        warnings
    }

    /// The pixels of a photo, read now.
    ///
    /// # Errors
    /// Where its file was not found or cannot be read.
    pub fn pixels_of(&self, photo: usize) -> Result<RgbImage, Fault> {
        let file = self.photo_files.get(photo);
        let Some(path) = file.and_then(|file| file.path.as_deref()) else {
            let what = "its image file was not found";
            return Err(Fault::new(
                what,
                "name the folder of the photos (--photo-folder)",
            ));
        };
        let bytes = formats::read_bytes(path).map_err(|error| error.fault)?;
        picture::decode(&bytes)
    }

    /// Reviews the flight: with its footprints, its scale fields, and with what its photos show, which takes
    /// longest, because every photo is read.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn review(&self, limits: &Limits, progress: &Progress) -> Result<Review, Fault> {
        let mut review = self.review_without_colours(limits, progress)?;
        compare_all_pixels(&mut review, &self.photo_files, progress)?;
        Ok(review)
    }

    /// The same, but that no photo is read.
    ///
    /// # Errors
    /// Likewise.
    pub fn review_without_colours(
        &self,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<Review, Fault> {
        let (flight, looked_up) = (self.flight.clone(), self.looked_up.clone());
        let mut review = Review::of_scales(flight, looked_up, limits, progress)?;
        review.take_decisions(&self.settings.decisions);
        review.look(progress)?;
        review.compute_fields(progress)?;
        Ok(review)
    }
}

/// Opens a flight.toml, a folder that holds one, or a reconstruction.
///
/// # Errors
/// With the file and the place in it.
pub fn open_flight(
    path: &Path,
    options: &OpenOptions,
    progress: &Progress,
) -> Result<Opened, FileError> {
    open_flight_sampled(path, options, None, progress)
}

/// [`open_flight`], which hands over a sample of a surface of millions of points as soon as it can.
///
/// # Errors
/// With the file and the place in it.
pub fn open_flight_sampled(
    path: &Path,
    options: &OpenOptions,
    on_sample: Option<OnSample<'_>>,
    progress: &Progress,
) -> Result<Opened, FileError> {
    open(path, options, on_sample, None, progress)
}

fn open(
    path: &Path,
    options: &OpenOptions,
    on_sample: Option<OnSample<'_>>,
    mut part: Option<&mut InPart>,
    progress: &Progress,
) -> Result<Opened, FileError> {
    let recording = Recording::start();
    let mut source = reading::read(path, options, progress)?;
    let photo_files = cameras::fit(&mut source)?;
    let surface = surface::read(
        &mut source,
        options,
        part.as_deref_mut(),
        on_sample,
        progress,
    )?;
    let mut framed = framing::bring_to_world(&mut source, surface, progress)?;
    placing::place(&mut source, &mut framed, options)?;
    lengths::tell(&mut source, &framed)?;
    let mut opened = building::build(source, framed, photo_files, options, part, progress)?;
    let photos = opened.photo_files.iter().flat_map(|file| &file.path);
    opened.read = Inputs::of(opened.inputs.iter().chain(photos)).with_opened(&recording.files());
    Ok(opened)
}

#[cfg(test)]
mod tests;
