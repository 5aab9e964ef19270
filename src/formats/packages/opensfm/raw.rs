//! A `reconstruction.json` as it is written.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, SeqAccess, Visitor};

use super::camera::CameraModel;
use super::reference::RawReference;
use super::rig::{RawRigCamera, RawRigInstance};
use crate::text::json::Object;

#[derive(Deserialize)]
pub(super) struct RawReconstruction {
    pub(super) cameras: Object<CameraModel>,
    pub(super) shots: Object<RawShot>,
    #[serde(default)]
    pub(super) points: Object<RawPoint>,
    #[serde(default)]
    pub(super) pano_shots: Object<IgnoredAny>,
    pub(super) reference_lla: Option<RawReference>,
    #[serde(default)]
    pub(super) rig_cameras: Object<RawRigCamera>,
    #[serde(default)]
    pub(super) rig_instances: Object<RawRigInstance>,
}

#[derive(Deserialize)]
pub(super) struct RawShot {
    pub(super) camera: String,
    pub(super) rotation: Option<[f64; 3]>,
    pub(super) translation: Option<[f64; 3]>,
    pub(super) gps_position: Option<[f64; 3]>,
    pub(super) gps_dop: Option<f64>,
    /// Of any shape: it only adds to the pose.
    #[serde(default)]
    pub(super) covariance: serde_json::Value,
}

#[derive(Deserialize)]
pub(super) struct RawPoint {
    pub(super) coordinates: [f64; 3],
    pub(super) color: Option<[f64; 3]>,
}

/// The reconstruction with most shots, of equals the first, and of the others only how many there are.
#[derive(Default)]
pub(super) struct List {
    pub(super) largest: Option<RawReconstruction>,
    pub(super) others: usize,
    pub(super) other_shots: usize,
}

impl<'de> Deserialize<'de> for List {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(ListVisitor)
    }
}

struct ListVisitor;

impl<'de> Visitor<'de> for ListVisitor {
    type Value = List;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of reconstructions")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<List, A::Error> {
        let mut list = List::default();
        while let Some(mut next) = seq.next_element::<RawReconstruction>()? {
            let Some(largest) = &mut list.largest else {
                list.largest = Some(next);
                continue;
            };
            if next.shots.0.len() > largest.shots.0.len() {
                std::mem::swap(largest, &mut next);
            }
            list.others += 1;
            list.other_shots += next.shots.0.len();
        }
        Ok(list)
    }
}
