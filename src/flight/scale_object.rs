//! Scale objects that were traced on photos: the `[[scale_object]]` tables of a flight.toml.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::scale::ScaleObjectKind;

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
