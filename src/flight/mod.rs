//! A flight: one review, with everything that its scales depend on. Validated when made.

mod changed;
mod computing;
mod date;
mod decision;
mod difference;
mod doubt;
mod evidence;
mod file;
mod name_order;
mod named_photo;
mod placed;
mod placement;
mod review;
mod scale_object;
#[cfg(test)]
mod tests;
mod verdict;

use std::collections::HashMap;
use std::sync::Arc;

pub use date::Date;
pub use decision::{Decision, DecisionKind};
pub use difference::{Difference, DifferenceReason};
pub use doubt::Doubt;
pub use evidence::{ColoursFound, Evidence, LookedUp, MetadataRead, PhotoFileState, TogetherFound};
pub use file::{
    CameraEntry, CameraSource, FlightFile, PhotoSource, PosesFlight, ReconstructionFlight,
};
pub use name_order::compare_names;
pub use placed::{Placed, moved_errors};
pub use placement::Placement;
pub use review::{Along, InView, OnPhoto, PhotoReview, Review, Sight};
pub use scale_object::{ComparedObject, ScaleObject};
pub use verdict::{Limits, Verdict};

use crate::camera::{Camera, Pose};
use crate::control::ControlList;
use crate::fault::Fault;
use crate::plan::AskedPlan;
use crate::scale::{Ground, ImageKind, PhotoScale, PoseErrors, ScalePair, StatedErrors};
use crate::surface::{Surface, SurfaceOptions, UpAxis};
use crate::units::{LengthUnit, in_words};

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
    /// How sure its pose is, as its line in the poses says: before what the flight's own table says.
    pub errors: PoseErrors,
    /// The same as its package says: behind that.
    pub package_errors: PoseErrors,
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
    /// Which scales go to Split-Desktop.
    pub pair: ScalePair,
    /// How sure the engineer is of what scales are computed from.
    pub errors: StatedErrors,
    /// What is left out of the surface.
    pub surface: SurfaceOptions,
    /// Which axis of the surface's own file points up.
    pub surface_up: UpAxis,
    /// Traced on photos, to compare with: no scale of the flight depends on them.
    pub scale_objects: Vec<ScaleObject>,
    /// What the engineer has decided of photos, each named once: no scale depends on it.
    pub decisions: Vec<Decision>,
    /// How the flight, as its files give it, was brought to the world by control points.
    pub placed: Option<Placed>,
    /// What was asked of a flight plan over the surface; `None` where that is what is usual. No scale depends on it.
    pub plan: Option<Box<AskedPlan>>,
    /// Control points, in a file of their own beside flight.toml: no scale depends on them but through `placed`.
    pub control: ControlList,
}

/// Lengths of a unit that differ by less, as a share, are the same unit.
const SAME_UNIT: f64 = 1e-9;

impl Default for FlightSettings {
    /// In metres, which nobody has said.
    fn default() -> Self {
        Self {
            unit: LengthUnit::Metre,
            unit_known: false,
            ground: Ground::default(),
            image: ImageKind::default(),
            pair: ScalePair::default(),
            errors: StatedErrors::default(),
            surface: SurfaceOptions::default(),
            surface_up: UpAxis::default(),
            scale_objects: Vec::new(),
            decisions: Vec::new(),
            placed: None,
            plan: None,
            control: ControlList::default(),
        }
    }
}

impl FlightSettings {
    /// What is written beside lengths in the world: its unit, or that nobody states one.
    pub fn unit_of_lengths(&self) -> &'static str {
        in_words(self.unit_known.then_some(self.unit))
    }

    /// What was decided of a photo.
    pub fn decision(&self, photo: &str) -> Option<&Decision> {
        self.decisions
            .iter()
            .find(|decision| decision.photo == photo)
    }

    /// Decides about a photo in the place of what was decided before; `None` decides nothing.
    pub fn decide(&mut self, photo: &str, decision: Option<Decision>) {
        let before = self.decisions.iter().position(|d| d.photo == photo);
        match (before, decision) {
            (Some(place), Some(decision)) => self.decisions[place] = decision,
            (Some(place), None) => {
                self.decisions.remove(place);
            }
            (None, Some(decision)) => self.decisions.push(decision),
            (None, None) => {}
        }
    }

    /// Whether the same scales follow from both.
    pub fn gives_the_scales_of(&self, other: &Self) -> bool {
        let Self {
            unit,
            unit_known,
            ground,
            image,
            surface,
            surface_up,
            pair: _,
            errors: _,
            placed,
            scale_objects: _,
            decisions: _,
            plan: _,
            control: _,
        } = self;
        (*unit, *unit_known) == (other.unit, other.unit_known)
            && (*ground, *image, *surface) == (other.ground, other.image, other.surface)
            && (*surface_up, placed) == (other.surface_up, &other.placed)
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
    /// Which scales go to Split-Desktop.
    pub pair: ScalePair,
    /// How sure the engineer is of what scales are computed from.
    pub errors: StatedErrors,
    /// The same as the package says: where she says nothing.
    pub package_errors: StatedErrors,
    /// What the rays meet; shared, because settings change more often than surfaces.
    pub surface: Arc<Surface>,
    /// The devices.
    pub cameras: Vec<Camera>,
    /// In the order of the input.
    pub photos: Vec<Photo>,
    /// What its files say of it besides.
    pub as_read: AsRead,
}

/// What the files of a flight say of its photos, and no number of theirs shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AsRead {
    /// What speaks against every photo, the gravest first. It is said where it is read.
    pub doubts: Vec<Doubt>,
    /// What speaks against single ones, by their index.
    pub of_photos: Vec<(usize, Doubt)>,
    /// How far the points of the surface may be off because they were written as 32-bit floats, world
    /// units; 0 where that is nothing beside the surface's size.
    pub rounding: f64,
    /// The world's coordinate system, where it has a name that is understood.
    pub system: Option<WorldSystem>,
}

/// The coordinate system of a world.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldSystem {
    /// "EPSG:n", or as the files state it.
    pub name: String,
    /// How long the unit of its x and y is.
    pub unit_metres: f64,
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

impl FlightParts {
    /// That the world is said to count in another unit than its coordinate system does.
    pub fn unit_doubt(&self) -> Option<Doubt> {
        let system = self.as_read.system.as_ref().filter(|_| self.unit_known)?;
        let metres = system.unit_metres;
        ((self.unit.metres() / metres - 1.0).abs() > SAME_UNIT).then(|| Doubt::UnitNotSystems {
            unit: self.unit,
            system: system.name.clone(),
            counted: LengthUnit::of_metres(metres)
                .map_or_else(|| format!("{metres} m"), |unit| unit.to_string()),
        })
    }

    /// What is written beside lengths in the world: its unit, or that nobody states one.
    pub fn unit_of_lengths(&self) -> &'static str {
        in_words(self.unit_known.then_some(self.unit))
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
        Self::perhaps_without_photos(parts)
    }

    /// The same, but a surface without photos does too: to look at, there is no scale in it.
    ///
    /// # Errors
    /// As [`Self::new`], but for photos that are not there.
    pub fn perhaps_without_photos(parts: FlightParts) -> Result<Self, Fault> {
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
        Self::perhaps_without_photos(FlightParts {
            unit: settings.unit,
            unit_known: settings.unit_known,
            ground: settings.ground,
            image: settings.image,
            pair: settings.pair,
            errors: settings.errors,
            surface: Arc::new(surface),
            ..self.parts.clone()
        })
    }

    /// The same flight with another pair for Split-Desktop and other stated errors: no scale of its
    /// corners and no best line depends on them.
    #[must_use]
    pub fn with_stated(&self, pair: ScalePair, errors: StatedErrors) -> Self {
        Self {
            parts: FlightParts {
                pair,
                errors,
                ..self.parts.clone()
            },
        }
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

    /// How sure everything is that a photo's scale is computed from: what its line in the poses says,
    /// then the flight's own table, then the package.
    pub fn errors(&self, photo: &Photo) -> StatedErrors {
        let parts = &self.parts;
        let of_photo = |pose| StatedErrors {
            pose,
            ..StatedErrors::default()
        };
        of_photo(photo.errors)
            .or(parts.errors)
            .or(of_photo(photo.package_errors))
            .or(parts.package_errors)
    }

    /// The same of what no photo has for itself.
    pub fn errors_of_all(&self) -> StatedErrors {
        self.parts.errors.or(self.parts.package_errors)
    }
}
