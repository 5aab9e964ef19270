//! flight.toml (contract, section 3): the text of a flight, with the names of its other files.

mod camera_entry;
mod check;
mod known_keys;
mod plan_entry;
mod poses_flight;
mod text;
mod uncertainty_entry;

use std::fmt;

use serde::{Deserialize, Serialize};
use toml::de::DeTable;

pub use self::camera_entry::{CameraEntry, CameraSource};
pub use self::poses_flight::PosesFlight;

use self::known_keys::KNOWN_KEYS;
use self::plan_entry::PlanEntry;
use self::uncertainty_entry::UncertaintyEntry;
use super::decision::{Decision, DecisionEntry};
use super::scale_object::{ScaleObject, ScaleObjectEntry};
use super::{FlightSettings, Placed};
use crate::control::ControlList;
use crate::fault::Fault;
use crate::files::FLIGHT_MARK;
use crate::scale::{Ground, ImageKind, ScalePair, StatedErrors};
use crate::surface::{SurfaceOptions, UpAxis};
use crate::toml_text::{key_line, nth_key_line, refuse_unknown_keys, toml_fault};
use crate::units::LengthUnit;

/// The text of a flight. Paths are relative to the file and stay text here.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FlightFile {
    /// Version of the format: 1.
    pub(super) format: u32,
    /// For people.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub(super) world: World,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) surface: Option<SurfaceEntry>,
    /// The `[[camera]]` tables.
    #[serde(default, rename = "camera", skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<CameraEntry>,
    #[serde(default, skip_serializing_if = "PhotosEntry::is_empty")]
    pub(super) photos: PhotosEntry,
    #[serde(default, skip_serializing_if = "ScaleEntry::is_default")]
    scale: ScaleEntry,
    #[serde(default, skip_serializing_if = "UncertaintyEntry::is_empty")]
    uncertainty: UncertaintyEntry,
    #[serde(
        default,
        rename = "scale_object",
        skip_serializing_if = "Vec::is_empty"
    )]
    pub(super) scale_objects: Vec<ScaleObjectEntry>,
    #[serde(default, rename = "review", skip_serializing_if = "Vec::is_empty")]
    decisions: Vec<DecisionEntry>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    plan: Option<PlanEntry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct World {
    pub(super) unit: String,
    #[serde(default)]
    pub(super) ground: GroundEntry,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) crs: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) placed: Option<PlacedEntry>,
}

/// How the whole flight was brought to the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlacedEntry {
    pub(super) transform: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) crs: Option<String>,
}

impl From<&Placed> for PlacedEntry {
    fn from(placed: &Placed) -> Self {
        Self {
            transform: placed.transform.to_vec(),
            crs: placed.crs.clone(),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct SurfaceEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) up: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    max_edge: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    thinning: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct PhotosEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) poses: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) reconstruction: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) folder: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) topic: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) transform: Option<Vec<f64>>,
}

impl PhotosEntry {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct ScaleEntry {
    #[serde(default)]
    image: ImageEntry,
    #[serde(default, rename = "use")]
    pair: PairEntry,
}

impl ScaleEntry {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
enum ImageEntry {
    #[default]
    #[serde(rename = "undistorted")]
    Undistorted,
    #[serde(rename = "as-shot")]
    AsShot,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum PairEntry {
    #[default]
    Fitted,
    Corners,
}

/// What `world.unit` says of a frame whose unit nobody knows.
pub(super) const UNKNOWN_UNIT: &str = "unknown";

/// `world.unit` of these settings.
pub(super) fn unit_word(settings: &FlightSettings) -> &'static str {
    match settings.unit_known {
        true => settings.unit.symbol(),
        false => UNKNOWN_UNIT,
    }
}

/// `surface.up` of these settings; `None` for z, which need not be said.
pub(super) fn up_word(settings: &FlightSettings) -> Option<&'static str> {
    let up = settings.surface_up;
    (up != UpAxis::Z).then(|| up.name())
}

/// A number or "auto".
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct GroundEntry(pub(super) Ground);

impl Serialize for GroundEntry {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Ground::Auto => serializer.serialize_str("auto"),
            Ground::At(z) => serializer.serialize_f64(z),
        }
    }
}

impl<'de> Deserialize<'de> for GroundEntry {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;
        impl serde::de::Visitor<'_> for Visitor {
            type Value = GroundEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an elevation or \"auto\"")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<GroundEntry, E> {
                if text == "auto" {
                    return Ok(GroundEntry(Ground::Auto));
                }
                Err(E::invalid_value(serde::de::Unexpected::Str(text), &self))
            }

            fn visit_f64<E: serde::de::Error>(self, z: f64) -> Result<GroundEntry, E> {
                Ok(GroundEntry(Ground::At(z)))
            }

            fn visit_i64<E: serde::de::Error>(self, z: i64) -> Result<GroundEntry, E> {
                Ok(GroundEntry(Ground::At(z as f64)))
            }
        }
        deserializer.deserialize_any(Visitor)
    }
}

/// Where the posed photos come from.
#[derive(Debug, Clone, PartialEq)]
pub enum PhotoSource<'a> {
    /// A poses.csv, or poses over time (a trajectory, a recording), relative to flight.toml.
    Poses(&'a str),
    /// A reconstruction, and the row-major 4x4 from its frame to the world.
    Reconstruction(&'a str, Option<[f64; 16]>),
    /// There are none: a flight is planned over a surface.
    None,
}

/// What a flight.toml says of a reconstruction. Paths are relative to the file that it will be.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReconstructionFlight<'a> {
    /// For people.
    pub name: &'a str,
    /// The file or folder that a package wrote.
    pub reconstruction: &'a str,
    /// The row-major similarity from the package's frame to the world.
    pub transform: Option<[f64; 16]>,
    /// The folder of the image files.
    pub folder: Option<&'a str>,
    /// The surface's file, where it is not the reconstruction's own points.
    pub surface: Option<&'a str>,
    /// The coordinate system of the world.
    pub crs: Option<&'a str>,
}

impl FlightFile {
    /// Reads the text of a flight.toml.
    ///
    /// # Errors
    /// With the line, where it is no TOML, has an unknown key (the nearest known one is named), lacks
    /// one, or contradicts itself.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let fault = |error: toml::de::Error| {
            toml_fault(
                text,
                &error,
                "see the flight file's format in docs/flights.md",
            )
        };
        let table = DeTable::parse(text).map_err(fault)?;
        refuse_unknown_keys(&KNOWN_KEYS, text, table.get_ref())?;
        let file: Self = toml::from_str(text).map_err(fault)?;
        file.check(|table, key| key_line(text, table, key))?;
        for (number, entry) in file.scale_objects.iter().enumerate() {
            if let Some((key, what)) = ScaleObject::from(entry).trouble() {
                let line = nth_key_line(text, "scale_object", number, key);
                return Err(Fault::at(line, what, "correct or remove it"));
            }
        }
        for (number, entry) in file.decisions.iter().enumerate() {
            let before = file.decisions.get(..number).unwrap_or_default();
            if let Some((key, what, remedy)) = entry.trouble(before) {
                let line = nth_key_line(text, "review", number, key);
                return Err(Fault::at(line, what, remedy));
            }
        }
        if let Some((key, what, remedy)) = file.plan.as_ref().and_then(PlanEntry::trouble) {
            return Err(Fault::at(key_line(text, "plan", key), what, remedy));
        }
        Ok(file)
    }

    /// A flight whose photos come from a reconstruction.
    pub fn for_reconstruction(
        flight: &ReconstructionFlight<'_>,
        settings: &FlightSettings,
    ) -> Self {
        let SurfaceOptions { max_edge, thinning } = settings.surface;
        let surface = SurfaceEntry {
            file: flight.surface.map(str::to_owned),
            up: up_word(settings)
                .filter(|_| flight.surface.is_some())
                .map(str::to_owned),
            max_edge,
            thinning,
        };
        Self {
            format: 1,
            name: Some(flight.name.to_owned()),
            world: World {
                unit: unit_word(settings).to_owned(),
                ground: GroundEntry(settings.ground),
                crs: flight.crs.map(str::to_owned),
                placed: settings.placed.as_ref().map(PlacedEntry::from),
            },
            surface: (surface != SurfaceEntry::default()).then_some(surface),
            cameras: Vec::new(),
            photos: PhotosEntry {
                poses: None,
                reconstruction: Some(flight.reconstruction.to_owned()),
                folder: flight.folder.map(str::to_owned),
                topic: None,
                transform: flight.transform.map(Vec::from),
            },
            scale: ScaleEntry {
                image: match settings.image {
                    ImageKind::Undistorted => ImageEntry::Undistorted,
                    ImageKind::AsShot => ImageEntry::AsShot,
                },
                pair: match settings.pair {
                    ScalePair::Fitted => PairEntry::Fitted,
                    ScalePair::Corners => PairEntry::Corners,
                },
            },
            uncertainty: settings.errors.into(),
            scale_objects: settings.scale_objects.iter().map(Into::into).collect(),
            decisions: settings.decisions.iter().map(Into::into).collect(),
            plan: settings.plan.as_deref().map(PlanEntry::from),
        }
    }

    /// A surface's file, over which a flight is planned.
    pub fn for_surface(name: &str, surface: &str, settings: &FlightSettings) -> Self {
        let flight = ReconstructionFlight {
            name,
            surface: Some(surface),
            ..ReconstructionFlight::default()
        };
        Self {
            photos: PhotosEntry::default(),
            ..Self::for_reconstruction(&flight, settings)
        }
    }

    /// The text of this flight, with a first line that says who wrote it.
    ///
    /// # Errors
    /// Never for a flight that was parsed; the serializer's sentence otherwise.
    pub fn to_toml(&self) -> Result<String, Fault> {
        toml::to_string(self)
            .map(|text| format!("{FLIGHT_MARK}{text}"))
            .map_err(|e| Fault::new(format!("the flight cannot be written ({e})"), "report this"))
    }

    /// The unit of all world coordinates; `None` where the file says that it is not known.
    pub fn unit(&self) -> Option<LengthUnit> {
        // `parse` has checked that it is a unit or [`UNKNOWN_UNIT`].
        self.world.unit.parse().ok()
    }

    /// The coordinate system of the world, where the file names one: "EPSG:n", WKT or a PROJ text.
    pub fn crs(&self) -> Option<&str> {
        self.world.crs.as_deref()
    }

    /// The fall-back plane.
    pub fn ground(&self) -> Ground {
        self.world.ground.0
    }

    /// Which image the scales are for.
    pub fn image(&self) -> ImageKind {
        match self.scale.image {
            ImageEntry::Undistorted => ImageKind::Undistorted,
            ImageEntry::AsShot => ImageKind::AsShot,
        }
    }

    /// Which scales go to Split-Desktop.
    pub fn pair(&self) -> ScalePair {
        match self.scale.pair {
            PairEntry::Fitted => ScalePair::Fitted,
            PairEntry::Corners => ScalePair::Corners,
        }
    }

    /// How sure the engineer is of what scales are computed from.
    pub fn errors(&self) -> StatedErrors {
        self.uncertainty.into()
    }

    /// The surface's file, relative to flight.toml.
    pub fn surface(&self) -> Option<&str> {
        self.surface.as_ref()?.file.as_deref()
    }

    /// Which axis of the surface's file points up.
    pub fn surface_up(&self) -> UpAxis {
        let up = self.surface.as_ref().and_then(|s| s.up.as_deref());
        // `parse` has checked it.
        up.and_then(|up| up.parse().ok()).unwrap_or_default()
    }

    /// What is left out of the surface.
    pub fn surface_options(&self) -> SurfaceOptions {
        let entry = self.surface.as_ref();
        SurfaceOptions {
            max_edge: entry.and_then(|surface| surface.max_edge),
            thinning: entry.and_then(|surface| surface.thinning),
        }
    }

    /// All that can be set while the flight is looked at, without control points: those are not in this file.
    pub fn settings(&self) -> FlightSettings {
        FlightSettings {
            unit: self.unit().unwrap_or(LengthUnit::Metre),
            unit_known: self.unit().is_some(),
            ground: self.ground(),
            image: self.image(),
            pair: self.pair(),
            errors: self.errors(),
            surface: self.surface_options(),
            surface_up: self.surface_up(),
            scale_objects: self.scale_objects.iter().map(ScaleObject::from).collect(),
            decisions: self.decisions.iter().map(Decision::from).collect(),
            placed: self.placed(),
            plan: self.plan.as_ref().and_then(PlanEntry::asked).map(Box::new),
            control: ControlList::default(),
        }
    }

    /// How the whole flight was brought to the world.
    fn placed(&self) -> Option<Placed> {
        let entry = self.world.placed.as_ref()?;
        Some(Placed {
            // `parse` has checked it.
            transform: Box::new(entry.transform.as_slice().try_into().ok()?),
            crs: entry.crs.clone(),
        })
    }

    /// The folder of the image files, relative to flight.toml.
    pub fn photo_folder(&self) -> Option<&str> {
        self.photos.folder.as_deref()
    }

    /// The topic of a ROS recording whose poses are meant.
    pub fn topic(&self) -> Option<&str> {
        self.photos.topic.as_deref()
    }

    /// Where the posed photos come from.
    pub fn photo_source(&self) -> PhotoSource<'_> {
        let photos = &self.photos;
        match &photos.reconstruction {
            Some(path) => {
                let transform = photos.transform.as_deref();
                PhotoSource::Reconstruction(path, transform.and_then(|t| t.try_into().ok()))
            }
            // `parse` has checked that one of the two is there, or a plan.
            None => match &photos.poses {
                Some(poses) => PhotoSource::Poses(poses),
                None => PhotoSource::None,
            },
        }
    }
}

#[cfg(test)]
mod tests;
