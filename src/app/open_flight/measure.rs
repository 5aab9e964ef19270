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
    /// The points that it has.
    pub fn points(self) -> Vec<DVec3> {
        match self {
            Self::Off | Self::First => Vec::new(),
            Self::Second(first) => vec![first],
            Self::Both(first, second) => vec![first, second],
        }
    }
}
