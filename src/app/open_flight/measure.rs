//! The distance tool.

use glam::DVec3;

/// The distance tool.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Measure {
    /// Clicks select photos.
    #[default]
    Off,
    /// Waits for the first point.
    First,
    /// Has one.
    Second(DVec3),
    /// Has both; the next click begins anew.
    Both(DVec3, DVec3),
}

impl Measure {
    /// The points that it has; the mouse is the second until that is clicked.
    pub fn points(self, hover: Option<DVec3>) -> Vec<DVec3> {
        match self {
            Self::Off | Self::First => Vec::new(),
            Self::Second(first) => std::iter::once(first).chain(hover).collect(),
            Self::Both(first, second) => vec![first, second],
        }
    }
}
