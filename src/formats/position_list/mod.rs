//! Known places as data: where photos were taken, and ground control points with their marks in
//! photos. For bringing a reconstruction in a frame of its own to the world.

use std::path::Path;

use glam::{DVec2, DVec3};

use super::input::FileError;

/// Where photos were taken, as a list beside them or their own headers say it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PositionList {
    /// The coordinate system that the list states: "EPSG:n", a PROJ string or WKT; `None` where it
    /// states none.
    pub crs: Option<String>,
    /// In the list's order; no name stands twice.
    pub positions: Vec<NamedPosition>,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

/// The position of one photo.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPosition {
    /// The image file's name, as the list writes it.
    pub name: String,
    /// In the list's `crs`: (easting, northing, height), or (degrees east, degrees north, metres up)
    /// where that is one of longitude and latitude.
    pub position: DVec3,
    /// Standard deviations towards east, north and up, in metres, where the list states them.
    pub accuracy: Option<DVec3>,
}

/// Ground control points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ControlPoints {
    /// The coordinate system that the list states, as in [`PositionList::crs`].
    pub crs: Option<String>,
    /// In the list's order; no name stands twice.
    pub points: Vec<ControlPoint>,
    /// What the reader had to assume or leave out, one sentence each.
    pub warnings: Vec<String>,
}

/// A surveyed point and where photos show it.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlPoint {
    /// What the list calls it; "point 1", ... where it calls it nothing.
    pub name: String,
    /// In the list's `crs`, as in [`NamedPosition::position`].
    pub position: DVec3,
    /// Photos' names, and the pixel in the photo as shot, (0, 0) at its outer corner. Empty where the
    /// list has no marks.
    pub marks: Vec<(String, DVec2)>,
}

/// Reads a list of photos' positions.
///
/// # Errors
/// With the line: what is no such list, a number that is not finite, a name that stands twice.
pub fn read_positions(_path: &Path) -> Result<PositionList, FileError> {
    Ok(PositionList::default())
}

/// Reads a list of ground control points, with or without marks.
///
/// # Errors
/// With the line: what is no such list, a number that is not finite.
pub fn read_control_points(_path: &Path) -> Result<ControlPoints, FileError> {
    Ok(ControlPoints::default())
}

/// The positions that the photos in a folder carry in their EXIF and XMP.
///
/// # Errors
/// Where the folder cannot be read.
pub fn positions_of_photos(_folder: &Path) -> Result<PositionList, FileError> {
    Ok(PositionList::default())
}
