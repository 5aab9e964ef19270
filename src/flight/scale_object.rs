//! Scale objects that were traced on photos: the `[[scale_object]]` tables of a flight.toml.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::computing::unusable;
use super::{Flight, Review};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::scale::{ImageKind, PlaceScale, ScaleObjectKind, Traced};

/// How far a mask reaches beyond its object, pixels: clicks and lenses are not exact, and a rim that
/// is left would be taken for an edge of rock.
const MASK_MARGIN_PX: f64 = 4.0;

/// An object of known size that somebody traced on a photo.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleObject {
    /// The photo's name.
    pub photo: String,
    /// What it is.
    pub kind: ScaleObjectKind,
    /// A sphere's diameter, a bar's length; in the world's unit.
    pub size: f64,
    /// Points of a sphere's outline, or a bar's two ends; pixels of the photo as shot.
    pub outline: Vec<DVec2>,
    /// Whether it is painted over in the exported photo, so that it is not taken for rock.
    pub mask: bool,
}

impl ScaleObject {
    /// What is left out of a photo for it, pixels of that image; empty where it is not to be masked or nobody can
    /// tell where it is.
    pub fn left_out(&self, camera: &Camera, image: ImageKind) -> Vec<DVec2> {
        let traced = Traced::new(camera, self.kind, self.size, &self.outline);
        match traced {
            Ok(traced) if self.mask => traced.region(camera, image, MASK_MARGIN_PX),
            _ => Vec::new(),
        }
    }
}

/// A scale object beside what the point cloud says where it is. Scales are in pixels per world unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedObject {
    /// Where it is, or why that cannot be told.
    pub traced: Result<Traced, Fault>,
    /// The one scale of the photo that follows from it.
    pub scale: Option<f64>,
    /// What the point cloud says there.
    pub place: PlaceScale,
}

impl ComparedObject {
    /// How much larger the object's scale is than that between the photo's edges, as a share of the
    /// latter: where it is positive, fragments come out too small with the object's.
    pub fn beyond_edges(&self) -> Option<f64> {
        Some(self.scale? / self.place.between_edges? - 1.0)
    }

    /// The same against the surface around the object.
    pub fn beyond_surroundings(&self) -> Option<f64> {
        Some(self.scale? / self.place.around? - 1.0)
    }

    /// The same against the surface under the object.
    pub fn beyond_surface(&self) -> Option<f64> {
        Some(self.scale? / self.place.on_surface? - 1.0)
    }

    /// How much longer a bar is on the surface than it is known to be, as a share of its length.
    pub fn beyond_length(&self) -> Option<f64> {
        match self.traced {
            Ok(Traced::Bar(bar)) => Some(self.place.length_on_surface? / bar.length - 1.0),
            _ => None,
        }
    }
}

impl Review {
    /// Compares scale objects with the point cloud, in their order: on their rows with the scales that go to
    /// Split-Desktop, where those are known.
    ///
    /// # Errors
    /// Where the surface cannot be met.
    pub fn compare_objects(&self, objects: &[ScaleObject]) -> Result<Vec<ComparedObject>, Fault> {
        if objects.is_empty() {
            // A caster may have to triangulate first.
            return Ok(Vec::new());
        }
        let flight = self.flight();
        let parts = flight.parts();
        let mut caster = parts.surface.caster().map_err(unusable)?;
        let compared = objects.iter().map(|object| {
            let mut photos = parts.photos.iter().enumerate();
            let Some((place, photo)) = photos.find(|(_, photo)| photo.name == object.photo) else {
                return ComparedObject {
                    traced: Err(no_photo(object)),
                    scale: None,
                    place: PlaceScale::default(),
                };
            };
            let (camera, image) = (flight.camera(photo), parts.image);
            let reviewed = self.photo(place);
            let pair = reviewed.map_or([None; 2], |reviewed| reviewed.pair(parts.unit));
            let traced = Traced::new(camera, object.kind, object.size, &object.outline);
            let place = traced
                .as_ref()
                .map(|traced| traced.place(camera, &photo.pose, image, pair, &mut caster));
            ComparedObject {
                scale: traced.as_ref().ok().and_then(|t| t.scale(camera, image)),
                place: place.unwrap_or_default(),
                traced,
            }
        });
        Ok(compared.collect())
    }
}

impl Flight {
    /// A sentence for each scale object on a photo that the flight does not have.
    pub fn objects_without_photo(&self, objects: &[ScaleObject]) -> Vec<String> {
        let has = |name: &str| self.parts().photos.iter().any(|photo| photo.name == name);
        let missing = objects.iter().filter(|object| !has(&object.photo));
        missing.map(|object| no_photo(object).to_string()).collect()
    }
}

fn no_photo(object: &ScaleObject) -> Fault {
    Fault::new(
        format!(
            "a scale object is on photo '{}', which the flight does not have",
            object.photo
        ),
        "correct its photo, or remove it",
    )
}

/// As it stands in the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct ScaleObjectEntry {
    pub(super) photo: String,
    kind: KindEntry,
    size: f64,
    outline: Vec<[f64; 2]>,
    #[serde(default = "masked")]
    mask: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum KindEntry {
    #[serde(rename = "sphere")]
    Sphere,
    #[serde(rename = "bar")]
    Bar,
}

/// Where nothing is said: nobody wants the object among the rocks.
fn masked() -> bool {
    true
}

impl From<&ScaleObjectEntry> for ScaleObject {
    fn from(entry: &ScaleObjectEntry) -> Self {
        Self {
            photo: entry.photo.clone(),
            kind: match entry.kind {
                KindEntry::Sphere => ScaleObjectKind::Sphere,
                KindEntry::Bar => ScaleObjectKind::Bar,
            },
            size: entry.size,
            outline: entry.outline.iter().map(|&p| DVec2::from(p)).collect(),
            mask: entry.mask,
        }
    }
}

impl From<&ScaleObject> for ScaleObjectEntry {
    fn from(object: &ScaleObject) -> Self {
        Self {
            photo: object.photo.clone(),
            kind: match object.kind {
                ScaleObjectKind::Sphere => KindEntry::Sphere,
                ScaleObjectKind::Bar => KindEntry::Bar,
            },
            size: object.size,
            outline: object.outline.iter().map(DVec2::to_array).collect(),
            mask: object.mask,
        }
    }
}

impl ScaleObject {
    /// What is wrong with it, as the key and a sentence; `None` where nothing is. Whether its points
    /// are an outline is only known with the photo's camera.
    pub(super) fn trouble(&self) -> Option<(&'static str, String)> {
        if self.photo.is_empty() {
            return Some(("photo", "scale_object.photo is empty".to_owned()));
        }
        if !(self.size > 0.0 && self.size.is_finite()) {
            let what = format!("scale_object.size is {}, no positive length", self.size);
            return Some(("size", what));
        }
        let (fewest, most) = self.kind.points();
        let points = self.outline.len();
        if points < fewest || points > most {
            let wanted = if fewest == most { "" } else { "at least " };
            let kind = self.kind.as_str();
            let what = format!(
                "scale_object.outline of the {kind} has {points} points, not {wanted}{fewest}"
            );
            return Some(("outline", what));
        }
        if !self.outline.iter().all(|point| point.is_finite()) {
            let what = "scale_object.outline has a number that is not finite".to_owned();
            return Some(("outline", what));
        }
        None
    }
}
