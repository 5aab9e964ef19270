//! Where something is written.

use std::path::PathBuf;

/// Where something is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Destination {
    /// The file or folder.
    pub path: PathBuf,
    /// Whether it may replace what is there: she was asked, and said so.
    pub replace: bool,
}

/// Replaces nothing.
impl From<PathBuf> for Destination {
    fn from(path: PathBuf) -> Self {
        Self {
            path,
            replace: false,
        }
    }
}

/// A table of what is measured on the surface, to be written as CSV.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasuredTable {
    /// The picked points.
    Points,
    /// The profile that is drawn.
    Profile,
    /// The volume that is drawn.
    Volume,
}

impl MeasuredTable {
    /// How its file is called if nobody types another name.
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Points => "points.csv",
            Self::Profile => "profile.csv",
            Self::Volume => "volume.csv",
        }
    }
}

/// A picture of the viewport to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureRequest {
    /// Where to.
    pub to: Destination,
    /// In pixels.
    pub size: [u32; 2],
    /// Without a background, or on white.
    pub transparent: bool,
    /// With the layers of the paper's figure.
    pub corner_rays: bool,
}
