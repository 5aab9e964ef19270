//! Which part of the map is drawn where.

use glam::DVec2;

/// A rectangle of a drawing with the part of the map that it shows, north up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapFrame {
    /// Its left upper corner, units of the drawing, y down.
    pub at: [f64; 2],
    /// Width and height, units of the drawing.
    pub size: [f64; 2],
    /// World x and y of its left upper corner.
    pub corner: DVec2,
    /// Units of the drawing to a unit of the world.
    pub scale: f64,
}

impl MapFrame {
    /// A frame of this size around the middle of a part of the map.
    pub fn around(middle: DVec2, at: [f64; 2], size: [f64; 2], scale: f64) -> Self {
        let half = DVec2::from(size) / 2.0 / scale;
        Self {
            at,
            size,
            corner: middle + DVec2::new(-half.x, half.y),
            scale,
        }
    }

    /// The place on the drawing of a point of the map.
    pub fn place(&self, point: DVec2) -> [f64; 2] {
        let off = (point - self.corner) * self.scale;
        [self.at[0] + off.x, self.at[1] - off.y]
    }

    /// The point of the map at a place of the drawing.
    pub fn point(&self, [x, y]: [f64; 2]) -> DVec2 {
        let off = DVec2::new(x - self.at[0], self.at[1] - y) / self.scale;
        self.corner + off
    }

    /// Least and greatest coordinates of what it shows.
    pub fn bounds(&self) -> [DVec2; 2] {
        let opposite = self.point([self.at[0] + self.size[0], self.at[1] + self.size[1]]);
        [self.corner.min(opposite), self.corner.max(opposite)]
    }
}
