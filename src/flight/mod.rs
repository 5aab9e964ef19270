//! A flight: one review, with everything that its scales depend on. Validated when made.

mod camera_entry;
mod doubt;
mod evidence;
mod file;
mod file_check;
mod file_text;
mod known_keys;
mod name_order;
mod placement;
mod review;
mod scale_object;
#[cfg(test)]
mod tests;
mod verdict;

use std::collections::HashMap;
use std::sync::Arc;

pub use camera_entry::{CameraEntry, CameraSource};
pub use doubt::Doubt;
pub use evidence::{ColoursFound, Evidence, LookedUp, PhotoFileState};
pub use file::{FlightFile, PhotoSource, ReconstructionFlight};
pub use name_order::compare_names;
pub use placement::Placement;
pub use review::{PhotoReview, Review};
pub use scale_object::{ComparedObject, ScaleObject};
pub use verdict::{Limits, Verdict};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{Ground, GroundFinder, ImageKind, PhotoScale, ViewFacts};
use crate::surface::{Surface, SurfaceError, SurfaceOptions};
use crate::units::LengthUnit;

/// One image with its camera and pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Photo {
    /// The name of its file, as the poses write it; unique in the flight.
    pub name: String,
    /// Index into [`FlightParts::cameras`].
    pub camera: usize,
    /// In the world.
    pub pose: Pose,
    /// Why this photo can have no scale, in words; `None` where it can.
    pub trouble: Option<String>,
}

/// What the engineer can set of a flight while she looks at it.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightSettings {
    /// The unit of all world coordinates.
    pub unit: LengthUnit,
    /// Whether somebody says that it is this unit. Else the world is a package's own frame: its
    /// lengths, and every scale, mean nothing.
    pub unit_known: bool,
    /// The plane that rays fall back to.
    pub ground: Ground,
    /// Which image the scales are for.
    pub image: ImageKind,
    /// What is left out of the surface.
    pub surface: SurfaceOptions,
    /// Traced on photos, to compare with: no scale of the flight depends on them.
    pub scale_objects: Vec<ScaleObject>,
}

impl FlightSettings {
    /// Whether the same scales follow from both.
    pub fn gives_the_scales_of(&self, other: &Self) -> bool {
        let Self {
            unit,
            unit_known,
            ground,
            image,
            surface,
            scale_objects: _,
        } = self;
        (*unit, *unit_known) == (other.unit, other.unit_known)
            && (*ground, *image, *surface) == (other.ground, other.image, other.surface)
    }
}

/// What a flight is made of.
#[derive(Debug, Clone)]
pub struct FlightParts {
    /// For people.
    pub name: String,
    /// The unit of all world coordinates.
    pub unit: LengthUnit,
    /// [`FlightSettings::unit_known`].
    pub unit_known: bool,
    /// The plane that rays fall back to.
    pub ground: Ground,
    /// Which image the scales are for.
    pub image: ImageKind,
    /// What the rays meet; shared, because settings change more often than surfaces.
    pub surface: Arc<Surface>,
    /// The devices.
    pub cameras: Vec<Camera>,
    /// In the order of the input.
    pub photos: Vec<Photo>,
}

/// A flight whose parts fit together.
#[derive(Debug)]
pub struct Flight {
    parts: FlightParts,
}

/// The scale of one photo of a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Corners and scales.
    Scale(Box<PhotoScale>),
    /// The photo's own [`Photo::trouble`]: nothing was computed.
    Trouble(String),
}

impl Outcome {
    /// Corners and scales, where there are any.
    pub fn scale(&self) -> Option<&PhotoScale> {
        match self {
            Self::Scale(scale) => Some(scale),
            Self::Trouble(_) => None,
        }
    }
}

impl Flight {
    /// Puts a flight together.
    ///
    /// # Errors
    /// Where the parts do not fit: no photo, a name twice, a camera that is missing or impossible,
    /// a number that is not finite.
    pub fn new(parts: FlightParts) -> Result<Self, Fault> {
        if parts.photos.is_empty() {
            return Err(Fault::new(
                "the flight has no posed photo",
                "give at least one photo with its pose",
            ));
        }
        if let Ground::At(z) = parts.ground
            && !z.is_finite()
        {
            return Err(Fault::new(
                format!("the ground is {z}"),
                "give a finite elevation or \"auto\"",
            ));
        }
        for camera in &parts.cameras {
            camera.validate().map_err(|error| {
                let what = match camera.name.as_str() {
                    "" => error.to_string(),
                    name => format!("camera '{name}': {error}"),
                };
                Fault::new(what, "correct the camera")
            })?;
        }
        let mut seen = HashMap::new();
        for (index, photo) in parts.photos.iter().enumerate() {
            let name = &photo.name;
            if let Some(first) = seen.insert(name.as_str(), index) {
                return Err(Fault::new(
                    format!(
                        "photo '{name}' is named twice, as number {} and {}",
                        first + 1,
                        index + 1
                    ),
                    "keep one pose a photo",
                ));
            }
            if photo.camera >= parts.cameras.len() {
                return Err(Fault::new(
                    format!("photo '{name}' has no camera"),
                    "give the camera that took it",
                ));
            }
            if !photo.pose.center.is_finite() || !photo.pose.rotation.is_finite() {
                return Err(Fault::new(
                    format!("the pose of photo '{name}' is not finite"),
                    "correct or remove it",
                ));
            }
        }
        Ok(Self { parts })
    }

    /// The same flight with other settings; shares the surface with this one.
    ///
    /// `thinning` is not looked at: which points are left is decided when the surface's file is read,
    /// so a flight that is thinned otherwise must be opened anew.
    ///
    /// # Errors
    /// Where a setting is no finite elevation or no positive length.
    pub fn with_settings(&self, settings: &FlightSettings) -> Result<Self, Fault> {
        let max_edge = settings.surface.max_edge;
        let surface = self.parts.surface.with_max_edge(max_edge);
        let surface = surface.map_err(|error| {
            Fault::new(error.to_string(), "give a positive length or leave it out")
        })?;
        Self::new(FlightParts {
            unit: settings.unit,
            unit_known: settings.unit_known,
            ground: settings.ground,
            image: settings.image,
            surface: Arc::new(surface),
            ..self.parts.clone()
        })
    }

    /// Its parts.
    pub fn parts(&self) -> &FlightParts {
        &self.parts
    }

    /// The camera of one of its photos.
    pub fn camera(&self, photo: &Photo) -> &Camera {
        // `new` has checked the index.
        &self.parts.cameras[photo.camera]
    }

    /// The scales of all photos, in their order.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn scales(&self, progress: &Progress) -> Result<Vec<Outcome>, Fault> {
        let FlightParts {
            surface,
            ground,
            image,
            photos,
            ..
        } = &self.parts;
        let mut caster = surface.caster().map_err(unusable)?;
        let mut finder = GroundFinder::new(*ground, surface);
        let mut outcomes = Vec::with_capacity(photos.len());
        progress.stage("computing scales");
        for photo in photos {
            progress.advance(outcomes.len() as u64, photos.len() as u64)?;
            outcomes.push(match &photo.trouble {
                Some(trouble) => Outcome::Trouble(trouble.clone()),
                None => {
                    let camera = self.camera(photo);
                    let scale =
                        PhotoScale::compute(camera, &photo.pose, *image, &mut finder, &mut caster);
                    Outcome::Scale(Box::new(scale.map_err(unusable)?))
                }
            });
        }
        Ok(outcomes)
    }

    /// How each photo looks at the surface, in their order; `None` where `outcomes`, those of
    /// [`Self::scales`], have no scale to look at.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn views(
        &self,
        outcomes: &[Outcome],
        progress: &Progress,
    ) -> Result<Vec<Option<ViewFacts>>, Fault> {
        let FlightParts {
            surface,
            ground,
            image,
            photos,
            ..
        } = &self.parts;
        progress.stage("making the surface ready for many rays");
        let rays = photos.len() * ViewFacts::RAYS;
        surface.triangulate_for(rays).map_err(unusable)?;
        progress.advance(0, photos.len() as u64)?;
        let mut caster = surface.caster_for(rays).map_err(unusable)?;
        let mut finder = GroundFinder::new(*ground, surface);
        let mut views = Vec::with_capacity(photos.len());
        progress.stage("draping footprints");
        for (photo, outcome) in photos.iter().zip(outcomes) {
            progress.advance(views.len() as u64, photos.len() as u64)?;
            let Some(scale) = outcome.scale() else {
                views.push(None);
                continue;
            };
            let view = ViewFacts::compute(
                self.camera(photo),
                &photo.pose,
                *image,
                scale,
                &mut finder,
                &mut caster,
            );
            views.push(Some(view.map_err(unusable)?));
        }
        Ok(views)
    }
}

/// What a surface that cannot be met means for a flight.
fn unusable(error: SurfaceError) -> Fault {
    Fault::new(error.to_string(), "check the surface file")
}
