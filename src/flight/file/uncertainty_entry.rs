//! The table `[uncertainty]` of a flight.toml (contract, section 8), as it stands in the text.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::scale::{PoseErrors, StatedErrors};

/// `[uncertainty]`: standard deviations; a key left out is not stated here.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct UncertaintyEntry {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    position: Option<Axes>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    angle: Option<Axes>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    focal: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    surface: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    world_scale: Option<f64>,
}

/// The same along each axis, or one for each.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or [x, y, z]")]
pub(super) enum Axes {
    All(f64),
    Each([f64; 3]),
}

impl From<DVec3> for Axes {
    fn from(axes: DVec3) -> Self {
        match axes == DVec3::splat(axes.x) {
            true => Self::All(axes.x),
            false => Self::Each(axes.to_array()),
        }
    }
}

impl From<Axes> for DVec3 {
    fn from(axes: Axes) -> Self {
        match axes {
            Axes::All(value) => Self::splat(value),
            Axes::Each(values) => Self::from_array(values),
        }
    }
}

impl UncertaintyEntry {
    /// Whether nothing is stated.
    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl From<UncertaintyEntry> for StatedErrors {
    fn from(entry: UncertaintyEntry) -> Self {
        Self {
            pose: PoseErrors {
                position: entry.position.map(DVec3::from),
                angle: entry.angle.map(DVec3::from),
            },
            focal: entry.focal,
            surface: entry.surface,
            world_scale: entry.world_scale,
        }
    }
}

impl From<StatedErrors> for UncertaintyEntry {
    fn from(errors: StatedErrors) -> Self {
        Self {
            position: errors.pose.position.map(Axes::from),
            angle: errors.pose.angle.map(Axes::from),
            focal: errors.focal,
            surface: errors.surface,
            world_scale: errors.world_scale,
        }
    }
}
