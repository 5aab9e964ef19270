//! Control points in the window: what is chosen of them, what is found from their marks, and the steps that change
//! them. The points themselves are settings of the flight, so that undo goes over them.
//!
//! ```text
//! finding   what follows from the marks: places, epipolar lines, photos that show a point
//! applying  what the commands do: marking, loading a list, bringing the flight to the world
//! saving    the list beside the flight
//! ```

mod applying;
mod finding;
mod saving;

use std::path::PathBuf;

use glam::{DVec2, DVec3};

use crate::control::{ControlList, ScaleBar};
use crate::flight::Placed;
use crate::opening::Georeferenced;
pub use finding::Found;

/// A step of marking control points. Points and bars are told by their places in the lists.
#[derive(Debug, Clone, PartialEq)]
pub enum ControlStep {
    /// Takes the tool, or puts it away; the points stay.
    Toggle,
    /// Adds a point and chooses it.
    Add,
    /// Chooses a point: clicks in the photo view mark it.
    Choose(Option<usize>),
    /// Calls a point so; scale bars follow.
    Rename(usize, String),
    /// Says where it was surveyed; `None` for a point that is only an end of a scale bar.
    Survey(usize, Option<DVec3>),
    /// Takes a point from the list, with the scale bars that end at it.
    Remove(usize),
    /// Says which coordinate system the surveyed places are in.
    Crs(Option<String>),
    /// Marks a point in a photo, in pixels of the photo as shot; `None` takes the mark away.
    Mark {
        /// Which point.
        point: usize,
        /// Which photo.
        photo: usize,
        /// Where.
        pixel: Option<DVec2>,
    },
    /// Adds a scale bar between two points.
    AddBar,
    /// Changes a scale bar.
    Bar(usize, ScaleBar),
    /// Takes a scale bar from the list.
    RemoveBar(usize),
    /// Adds the points of a list.
    Load(PathBuf),
    /// With scale bars alone: whether to turn the surface level.
    Level(bool),
    /// Brings the flight to the world by them.
    Apply,
}

/// What came of bringing the flight to the world.
#[derive(Debug)]
pub enum Applied {
    /// This, as long as the flight is placed so and its points are these.
    Placed(Box<Georeferenced>, Option<Placed>, Box<ControlList>),
    /// Why not, in a line.
    Failed(String),
}

/// The control points of the flight on the screen.
#[derive(Debug, Default)]
pub struct Control {
    /// Whether clicks in the photo view mark points.
    pub is_on: bool,
    /// Which point they mark.
    pub chosen: Option<usize>,
    /// With scale bars alone: whether to turn the surface level.
    pub level: bool,
    /// What follows from the marks.
    pub found: Found,
    /// What came of it last.
    pub applied: Option<Applied>,
}
