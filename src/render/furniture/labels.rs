//! The words on a picture, as data: the window writes them with its own font, files with another.

use glam::DVec2;

use crate::picture::Anchor;

/// A short text on the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// In viewport pixels.
    pub at: DVec2,
    /// What it says.
    pub text: String,
    /// Which place of it is at `at`.
    pub anchor: Anchor,
    /// Red, green, blue.
    pub color: [u8; 3],
}

/// What the colours of the surface mean: viridis from the first to the second value.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// What is coloured, with its unit.
    pub title: String,
    /// The values of the colour map's two ends.
    pub range: [f64; 2],
}

/// The scale bar of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleBar {
    /// In world units: 1, 2 or 5 times a power of ten.
    pub length: f64,
    /// In viewport pixels.
    pub pixels: f64,
}
