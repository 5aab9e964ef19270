//! Square pixels of the map, north up.

use glam::DVec2;

use crate::fault::Fault;

/// A raster whose columns go to the east (x) and whose rows go to the south (-y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapRaster {
    /// World x and y of the outer corner of its first pixel, in the north-west.
    pub corner: DVec2,
    /// The side of a pixel, world units.
    pub pixel: f64,
    /// Pixels to the east.
    pub columns: u32,
    /// Pixels to the south.
    pub rows: u32,
}

impl MapRaster {
    /// Pixels of this size over a box of the map, from a whole number of them, so that rasters of one pixel
    /// size lie on each other.
    ///
    /// # Errors
    /// Where they are more than `most`, or the pixel is no positive length.
    pub fn over([min, max]: [DVec2; 2], pixel: f64, most: u64) -> Result<Self, Fault> {
        if !(pixel > 0.0 && pixel.is_finite()) {
            let what = "the pixel size is no positive length";
            return Err(Fault::new(what, "give one, as --pixel 5cm"));
        }
        let (west, east) = ((min.x / pixel).floor(), (max.x / pixel).ceil());
        let (south, north) = ((min.y / pixel).floor(), (max.y / pixel).ceil());
        let size = DVec2::new(east - west, north - south);
        // NaN is no size.
        if !size.is_finite()
            || size.max_element() > f64::from(u32::MAX)
            || size.x * size.y > most as f64
        {
            let what = format!(
                "the map would have {:.0} x {:.0} pixels, more than {} million",
                size.x,
                size.y,
                most / 1_000_000
            );
            return Err(Fault::new(what, "give a larger --pixel"));
        }
        let size = size.max(DVec2::ONE);
        Ok(Self {
            corner: DVec2::new(west, north) * pixel,
            pixel,
            // Within u32.
            columns: size.x as u32,
            rows: size.y as u32,
        })
    }

    /// World x and y of a place of the raster: pixels, (0, 0) at the outer corner of the first.
    pub fn world_from_pixel(&self, place: DVec2) -> DVec2 {
        self.corner + DVec2::new(place.x, -place.y) * self.pixel
    }

    /// The inverse.
    pub fn pixel_from_world(&self, point: DVec2) -> DVec2 {
        let off = (point - self.corner) / self.pixel;
        DVec2::new(off.x, -off.y)
    }

    /// The box that it covers: least and greatest x and y.
    pub fn bounds(&self) -> [DVec2; 2] {
        let size = DVec2::new(f64::from(self.columns), f64::from(self.rows));
        let opposite = self.world_from_pixel(size);
        [self.corner.min(opposite), self.corner.max(opposite)]
    }
}
