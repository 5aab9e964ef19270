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
    /// What was measured, as it is copied: the distance, its level and its upright part, all digits, with tabs between them.
    pub fn copied(self) -> Option<String> {
        let Self::Both(first, second) = self else {
            return None;
        };
        let way = second - first;
        let (length, level) = (way.length(), way.truncate().length());
        Some(format!("{length}\t{level}\t{}", way.z))
    }

    /// The points that it has; the mouse is the second until that is clicked.
    pub fn points(self, hover: Option<DVec3>) -> Vec<DVec3> {
        match self {
            Self::Off | Self::First => Vec::new(),
            Self::Second(first) => std::iter::once(first).chain(hover).collect(),
            Self::Both(first, second) => vec![first, second],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_distance_is_copied_with_its_parts() {
        let measured = Measure::Both(DVec3::new(1.0, 1.0, 2.0), DVec3::new(4.0, 5.0, -10.0));
        assert_eq!(measured.copied().as_deref(), Some("13\t5\t-12"));
        assert_eq!(Measure::Second(DVec3::ZERO).copied(), None);
    }
}
