//! What a rectified photo says of itself: JSON in the description tag (TIFF) or text (PNG). Its keys are
//! part of what others read: they stay.

use serde::Serialize;

use super::RectifiedPhoto;
use crate::scale::Onto;
use crate::tiff_pages::PROGRAM;

#[derive(Debug, Serialize)]
struct Description<'a> {
    /// Who wrote it, with its version.
    program: &'static str,
    flight: &'a str,
    photo: &'a str,
    /// "fit", "horizontal" or "surface": what it is seen squarely onto.
    onto: &'static str,
    /// The side of a pixel.
    pixel: f64,
    /// Of that.
    unit: &'static str,
    /// Rows of the picture; those below belong to the bar.
    rows: u32,
    definition: &'static str,
    /// The world point that the outer corner of the first pixel lies at. Of the surface its height is that
    /// of the mean.
    corner: [f64; 3],
    /// Unit vectors of the world to the right and down the picture.
    right: [f64; 3],
    down: [f64; 3],
    /// Root mean square distance of the surface from the plane, world units; null of the surface.
    off_plane_rms: Option<f64>,
    /// Of corner and off_plane_rms.
    world_unit: &'static str,
    /// "EPSG:n" or WKT; null where nobody says it.
    crs: Option<&'a str>,
}

const ONTO_PLANE: &str = "the photo as seen squarely onto a plane: every pixel has this size on the plane; what stands out of it is displaced; transparent (white) where the photo does not show the plane";
const ONTO_SURFACE: &str = "the photo laid over the surface and seen straight from above: every pixel has this size on the map; transparent (white) where the photo does not show the surface or something nearer hides it";

pub(super) fn description(photo: &RectifiedPhoto<'_>) -> String {
    let raster = &photo.rectification.raster;
    let description = Description {
        program: PROGRAM,
        flight: photo.flight,
        photo: photo.photo,
        onto: photo.onto.name(),
        pixel: photo.pixel(),
        unit: photo.unit.symbol(),
        rows: raster.rows,
        definition: match photo.onto {
            Onto::Surface => ONTO_SURFACE,
            Onto::FittedPlane | Onto::HorizontalPlane => ONTO_PLANE,
        },
        corner: raster.world_from_picture(glam::DVec2::ZERO).to_array(),
        right: raster.frame.right.to_array(),
        down: raster.frame.down.to_array(),
        off_plane_rms: photo.rectification.off_plane,
        world_unit: photo.world_unit.symbol(),
        crs: photo.crs,
    };
    // A struct of texts and finite numbers always has its JSON.
    serde_json::to_string(&description).unwrap_or_default()
}
