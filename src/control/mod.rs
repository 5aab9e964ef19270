//! Control points: what surveyors know of a pile, and where photos show it.
//!
//! A point is marked in photos, in pixels of the photo as shot. Two marks say where it is in the frame of the
//! poses ([`locate()`]), and one where it can be in every other photo ([`EpipolarLine`]). Surveyed points bring
//! a flight to the world, scale bars (two points with a known distance) give it its unit alone.

mod epipolar;
mod locate;
#[cfg(test)]
mod test_camera;

pub use epipolar::EpipolarLine;
pub use locate::{Located, MarkedView, POOR_PX, locate};

use glam::{DVec2, DVec3};

use crate::units::LengthUnit;

/// A point of the pile that photos show.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ControlPoint {
    /// What it is called; no two points of a list are called the same.
    pub name: String,
    /// As it was surveyed, in the list's coordinate system: (easting, northing, height), or (degrees east,
    /// degrees north, metres up) where that is one of longitude and latitude. `None` for a point that is only
    /// the end of a scale bar.
    pub position: Option<DVec3>,
    /// Photos' names, and the pixel in the photo as shot, (0, 0) at its outer corner; each photo once.
    pub marks: Vec<(String, DVec2)>,
}

impl ControlPoint {
    /// Where a photo shows it.
    pub fn mark_in(&self, photo: &str) -> Option<DVec2> {
        let mark = self.marks.iter().find(|(marked, _)| marked == photo);
        mark.map(|(_, pixel)| *pixel)
    }

    /// Marks it in a photo, in the place of a mark before; `None` takes that away.
    pub fn set_mark(&mut self, photo: &str, pixel: Option<DVec2>) {
        let before = self.marks.iter().position(|(marked, _)| marked == photo);
        match (before, pixel) {
            (Some(place), Some(pixel)) => self.marks[place].1 = pixel,
            (Some(place), None) => {
                self.marks.remove(place);
            }
            (None, Some(pixel)) => self.marks.push((photo.to_owned(), pixel)),
            (None, None) => {}
        }
    }
}

/// Two points with a known distance.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleBar {
    /// The names of its two points.
    pub ends: [String; 2],
    /// In `unit`; 0 until somebody has said it.
    pub length: f64,
    /// Of its length.
    pub unit: LengthUnit,
}

impl ScaleBar {
    /// Whether somebody has said how long it is.
    pub fn is_known(&self) -> bool {
        self.length > 0.0
    }

    /// Its length in metres.
    pub fn metres(&self) -> f64 {
        self.length * self.unit.metres()
    }
}

/// Control points with their scale bars.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ControlList {
    /// The coordinate system of the surveyed positions: "EPSG:n", a PROJ text or WKT; `None` where nobody
    /// states one.
    pub crs: Option<String>,
    /// In the list's order.
    pub points: Vec<ControlPoint>,
    /// In the list's order.
    pub bars: Vec<ScaleBar>,
}

impl ControlList {
    /// Whether nothing is in it.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty() && self.bars.is_empty()
    }

    /// The point of this name.
    pub fn point(&self, name: &str) -> Option<&ControlPoint> {
        self.points.iter().find(|point| point.name == name)
    }
}
