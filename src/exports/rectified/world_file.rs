//! World files: six lines that say where the pixels of a picture lie, as map programs read them: the
//! steps of x and y of a pixel to the right and of one down, and the middle of the first pixel.
//!
//! Of a horizontal picture they are world coordinates. Of a tilted plane they are coordinates on the
//! plane: x to the right and y up, from the middle of what the photo shows of the surface. A seventh
//! line, which programs do not read, says which, and who wrote it.

use glam::DVec2;

use crate::files::WORLD_FILE_MARK;
use crate::scale::{Onto, PlaneRaster};

pub(super) fn text(raster: &PlaneRaster, onto: Onto) -> String {
    let middle = raster.plane_from_picture(DVec2::splat(0.5));
    let (x, y) = match onto {
        Onto::FittedPlane => (middle.x, -middle.y),
        Onto::HorizontalPlane | Onto::Surface => {
            let middle = raster.world_from_picture(DVec2::splat(0.5));
            (middle.x, middle.y)
        }
    };
    let whose = match onto {
        Onto::FittedPlane => "coordinates on the fitted plane, not of the world",
        Onto::HorizontalPlane | Onto::Surface => "coordinates of the world",
    };
    let pixel = raster.pixel;
    format!("{pixel}\n0\n0\n-{pixel}\n{x}\n{y}\n{WORLD_FILE_MARK}{whose}\n")
}
