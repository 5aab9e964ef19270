//! Changes of the view.

use glam::{DVec2, DVec3};

/// A change of the view: the free view is turned, or left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ViewChange {
    /// The mouse moved by these pixels: turn.
    Orbit(DVec2),
    /// The mouse moved by these pixels in a viewport of this size: move.
    Pan(DVec2, DVec2),
    /// Come closer (factor < 1) to what is under the cursor, in a viewport of this size.
    Zoom {
        /// Where the mouse is.
        cursor: DVec2,
        /// Of the viewport.
        size: DVec2,
        /// Under 1 comes closer.
        factor: f64,
    },
    /// The viewport has this size now, pixels.
    Resized(DVec2),
    /// Straight down.
    Top,
    /// To the north.
    Front,
    /// To the west.
    Side,
    /// From the opposite side.
    Opposite,
    /// The eye goes around what is in the middle, degrees.
    Turn {
        /// To the left.
        left: f64,
        /// Up, to straight above at most.
        up: f64,
    },
    /// Cameras and surface in sight, without its outliers.
    Fit,
    /// Everything in sight, outliers too.
    FitAll,
    /// The selected photo's footprint and camera in sight.
    FitSelected,
    /// This point in the middle.
    Center(DVec3),
    /// Through the camera of the selected photo, or back.
    Through,
    /// How much of the photo lies over the view.
    Blend(f64),
}
