//! What a page of a scale map says of itself: JSON in the description tag. Its keys are part of what
//! others read: they stay.

use serde::Serialize;

use super::{MapLayer, ScaleMap};
use crate::scale::ImageKind;
use crate::tiff_pages::PROGRAM;

/// One page's description.
#[derive(Debug, Serialize)]
struct Description<'a> {
    /// Who wrote it, with its version.
    program: &'static str,
    flight: &'a str,
    photo: &'a str,
    /// "undistorted" or "as-shot": which image has these pixels.
    image: &'static str,
    width: u32,
    height: u32,
    /// The name of the layer.
    layer: &'static str,
    /// Of the page's values.
    unit: String,
    /// What the values are.
    definition: &'static str,
    /// Of coordinates: what is to be added to the values of x, y and z; null of other layers.
    origin: Option<[f64; 3]>,
    world_unit: &'static str,
    /// "EPSG:n" or WKT; null where nobody says it.
    crs: Option<&'a str>,
}

const UNDISTORTED: &str = "sqrt(fx*fy)/Z: pixels per unit on the plane that is parallel to the image and goes through the surface point which the pixel shows, Z being that point's depth along the optical axis; NaN where the pixel's ray misses the surface; pixel (0, 0) has its middle at (0.5, 0.5)";
const AS_SHOT: &str = "sqrt(fx*fy*|det J|)/Z: pixels per unit on the plane that is parallel to the image and goes through the surface point which the pixel shows, Z being that point's depth along the optical axis and J the derivative of distorted by undistorted pixel; NaN where the pixel's ray misses the surface; pixel (0, 0) has its middle at (0.5, 0.5)";
const DEPTH: &str = "the depth of the surface point that the pixel shows, along the optical axis from the camera centre; NaN where the pixel's ray misses the surface";
const COORDINATE: &str = "a world coordinate of the surface point that the pixel shows, less that of origin; NaN where the pixel's ray misses the surface";

/// The description of a layer.
pub(super) fn description(map: &ScaleMap<'_>, layer: MapLayer, origin: [f64; 3]) -> String {
    let field = map.field;
    let as_shot = field.image() == ImageKind::AsShot;
    let is_coordinate = matches!(layer, MapLayer::X | MapLayer::Y | MapLayer::Z);
    let description = Description {
        program: PROGRAM,
        flight: map.flight,
        photo: map.photo,
        image: if as_shot { "as-shot" } else { "undistorted" },
        width: field.grid.columns,
        height: field.grid.rows,
        layer: layer.name(),
        unit: match layer {
            MapLayer::Scale => format!("px/{}", map.unit),
            _ => map.world_unit.symbol().to_owned(),
        },
        definition: match layer {
            MapLayer::Scale if as_shot => AS_SHOT,
            MapLayer::Scale => UNDISTORTED,
            MapLayer::Depth => DEPTH,
            MapLayer::X | MapLayer::Y | MapLayer::Z => COORDINATE,
        },
        origin: is_coordinate.then_some(origin),
        world_unit: map.world_unit.symbol(),
        crs: map.crs,
    };
    // A struct of texts and finite numbers always has its JSON.
    serde_json::to_string(&description).unwrap_or_default()
}
