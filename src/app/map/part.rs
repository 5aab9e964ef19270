//! A part of the plan: what is asked for, and what was drawn of it.

use glam::DVec2;

use crate::exports::{MapFrame, RoomForNames};

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
    /// What lies over the map (north, scale bar), points from the frame's left upper corner: least and greatest.
    pub covered: [[DVec2; 2]; 2],
}

/// What was drawn.
#[derive(Clone)]
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

impl DrawnPart {
    /// Whether all of this part of the map (least and greatest x and y) is on it.
    pub(super) fn holds(&self, [min, max]: [DVec2; 2]) -> bool {
        let [least, greatest] = self.frame.bounds();
        min.cmpge(least).all() && max.cmple(greatest).all()
    }

    /// Whether it shows the same plan in the same colours.
    pub(super) fn is_as(&self, other: &Self) -> bool {
        let [own, other] = [self, other].map(|drawn| (drawn.part.revision, drawn.part.dark));
        own == other
    }
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

    /// Where names are read whole: what is drawn beyond the frame comes into sight only by moving the map.
    pub(super) fn room_for_names(&self) -> RoomForNames {
        let corner = self.size * BEYOND;
        let moved = |ends: [DVec2; 2]| ends.map(|end| (corner + end).to_array());
        RoomForNames {
            sight: moved([DVec2::ZERO, self.size]),
            covered: self.covered.map(moved).to_vec(),
        }
    }

    fn drawn_size(&self) -> DVec2 {
        self.size * (1.0 + 2.0 * BEYOND)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of 400 x 300 points at 10 points a metre shows 40 m x 30 m; names are drawn within just these.
    #[test]
    fn names_have_room_in_what_is_seen() {
        let part = PartInSight {
            revision: 1,
            middle: DVec2::new(1000.0, 2000.0),
            scale: 10.0,
            size: DVec2::new(400.0, 300.0),
            pixels: 2.0,
            dark: true,
            covered: [
                [DVec2::new(350.0, 0.0), DVec2::new(400.0, 60.0)],
                [DVec2::new(300.0, 250.0), DVec2::new(400.0, 300.0)],
            ],
        };
        let (frame, room) = (part.frame(), part.room_for_names());
        let [top_left, bottom_right] = room.sight.map(|place| frame.point(place));
        assert!(top_left.distance(DVec2::new(980.0, 2015.0)) < 1e-9);
        assert!(bottom_right.distance(DVec2::new(1020.0, 1985.0)) < 1e-9);
        let bar = room.covered[1].map(|place| frame.point(place));
        assert!(bar[0].distance(DVec2::new(1010.0, 1990.0)) < 1e-9);
        assert!(bar[1].distance(DVec2::new(1020.0, 1985.0)) < 1e-9);
    }
}
