//! A part of the plan: what is asked for, and what was drawn of it.

use glam::DVec2;

use crate::exports::MapFrame;

/// How much farther than the frame is drawn, in its size: a map that is moved shows what lies there at once.
const BEYOND: f64 = 0.15;

/// The longest side of a picture, pixels: more is not drawn in time.
const LONGEST: f64 = 8192.0;

/// What is to be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartInSight {
    /// The plan of this number.
    pub revision: u64,
    /// World x and y in the middle.
    pub middle: DVec2,
    /// Points of the screen to a world unit.
    pub scale: f64,
    /// The size of the frame, points.
    pub size: DVec2,
    /// Pixels of the screen to a point.
    pub pixels: f64,
    /// For a dark window.
    pub dark: bool,
}

/// What was drawn.
pub struct DrawnPart {
    /// What was asked for.
    pub part: PartInSight,
    /// Which part of the map it shows; it counts from its own corner.
    pub frame: MapFrame,
    /// Photos, cameras and names.
    pub photos: egui::TextureHandle,
    /// The ground and what of the map it covers (least and greatest x and y), where that of the whole plan is
    /// too coarse.
    pub ground: Option<(egui::TextureHandle, [DVec2; 2])>,
}

impl PartInSight {
    /// What is drawn for it.
    pub(super) fn frame(&self) -> MapFrame {
        let size = self.drawn_size();
        MapFrame::around(self.middle, [0.0, 0.0], size.to_array(), self.scale)
    }

    /// Pixels of its picture to a point of the screen: fewer than the screen has where the textures of the
    /// graphics device are not longer than `most` pixels.
    pub(super) fn pixels_of_picture(&self, most: f64) -> f64 {
        // Rounded up to a whole pixel.
        let most = (most.min(LONGEST) - 1.0).max(1.0);
        self.pixels.min(most / self.drawn_size().max_element())
    }

    fn drawn_size(&self) -> DVec2 {
        self.size * (1.0 + 2.0 * BEYOND)
    }
}
