//! The plan without its page as GeoTIFF (OGC 19-008r4): pixels, where they lie, in which coordinate system.

use std::borrow::Cow;

use serde::Serialize;

use super::{Grid, MapFrame, Plan, PlanGround, PlanInks, RoomForNames, photos};
use crate::drawing::{Dash, Pen, png};
use crate::fault::Fault;
use crate::geo_tags::{OnMap, geo_tags};
use crate::tiff_pages::{PROGRAM, Page, Pixels, tiff_of};

/// Pixels of the picture to a unit of the drawing at most: names stay readable where pixels are few.
const LARGEST: f64 = 4.0;
/// About how many units of the drawing a plan is across.
const ACROSS: f64 = 1000.0;

/// What the file says of itself, beside its georeference. Its keys are part of what others read.
#[derive(Debug, Serialize)]
struct Description<'a> {
    program: &'static str,
    flight: &'a str,
    /// The side of a pixel, world units.
    pixel: f64,
    /// "m", ...; null where nobody states it.
    world_unit: Option<&'static str>,
    /// "EPSG:n" or WKT; null where nobody says it.
    crs: Option<&'a str>,
    /// "relief", "photos", "colours" or "plain".
    ground: &'static str,
    definition: String,
}

/// What the picture is of, after its ground.
const DEFINITION: &str = "from straight above, with the footprints of the photos in the colours of their verdicts, their names, their middles and the cameras; transparent where there is no surface";

/// The file's bytes.
///
/// # Errors
/// Where it cannot be encoded.
pub(super) fn bytes(plan: &Plan) -> Result<Vec<u8>, Fault> {
    let raster = &plan.raster;
    let [width, height] = [raster.columns, raster.rows].map(f64::from);
    let pixels = (width.max(height) / ACROSS).clamp(1.0, LARGEST);
    let frame = MapFrame {
        at: [0.0, 0.0],
        size: [width / pixels, height / pixels],
        corner: raster.corner,
        scale: 1.0 / (raster.pixel * pixels),
    };
    let inks = &PlanInks::PAPER;
    let mut pen = Pen::default();
    let grid = Grid::of(&frame);
    let [min, max] = frame.bounds();
    for line in &grid.across {
        let ends = [min.y, max.y].map(|y| frame.place([line.at, y].into()));
        pen.line(&ends, inks.grid, 0.6, Dash::Solid);
    }
    for line in &grid.up {
        let ends = [min.x, max.x].map(|x| frame.place([x, line.at].into()));
        pen.line(&ends, inks.grid, 0.6, Dash::Solid);
    }
    let room = RoomForNames::all_of(&frame);
    photos::draw(plan, &frame, &room, inks, &mut pen);
    let mut picture = (*plan.ground).clone();
    png::draw_all(&mut picture, &pen.shapes, pixels);
    let description = Description {
        program: PROGRAM,
        flight: &plan.flight,
        pixel: raster.pixel,
        world_unit: plan.unit_known.then(|| plan.unit.symbol()),
        crs: plan.crs.as_deref(),
        ground: plan.ground_kind.name(),
        definition: format!("{} {DEFINITION}", of_ground(plan.ground_kind)),
    };
    let page = Page {
        width: raster.columns,
        height: raster.rows,
        pixels: Pixels::Colors(Cow::Owned(picture.into_raw())),
        // A struct of texts and finite numbers always has its JSON.
        description: serde_json::to_string(&description).unwrap_or_default(),
        resolution: None,
        georeference: Some(geo_tags(&OnMap {
            crs: plan.crs.as_deref(),
            unit: plan.unit_known.then_some(plan.unit),
            pixel: raster.pixel,
            corner: raster.corner,
        })),
    };
    tiff_of(std::iter::once(Ok(page)))
}

fn of_ground(ground: PlanGround) -> &'static str {
    match ground {
        PlanGround::Relief => "the surface's hillshade",
        PlanGround::Photos => "the photos laid over the surface",
        PlanGround::Colours => "the colours of the surface's points",
        PlanGround::Plain => "the flight",
    }
}
