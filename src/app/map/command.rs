//! What the engineer does on the map, as data. Lengths are points of the screen, y down.

use glam::DVec2;

use super::part::PartInSight;
use crate::command::Destination;
use crate::exports::PlanGround;

/// One thing to do on the page of the map.
#[derive(Debug, Clone, PartialEq)]
pub enum MapCommand {
    /// Makes the plan of the review as it is now.
    Make,
    /// Draws this part of it.
    Draw(PartInSight),
    /// Shows it larger (factor > 1) about the cursor.
    Zoom {
        /// Where the mouse is, from the frame's left upper corner.
        cursor: DVec2,
        /// Over 1 enlarges.
        factor: f64,
        /// The size of the frame.
        size: DVec2,
    },
    /// Moves it by so much.
    Pan {
        /// To the right and down.
        by: DVec2,
        /// The size of the frame.
        size: DVec2,
    },
    /// All of it is seen.
    Fit,
    /// Its ground.
    Ground(PlanGround),
    /// Writes it: GeoTIFF, SVG, PDF or PNG, by the name's ending.
    Save {
        /// Where to.
        to: Destination,
        /// The side of a pixel of the ground, world units; `None` as on the screen.
        pixel: Option<f64>,
    },
}
