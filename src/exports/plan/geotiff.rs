//! The plan without its page as GeoTIFF (OGC 19-008r4): pixels, where they lie, in which coordinate system.

use std::borrow::Cow;

use serde::Serialize;

use super::{Grid, MapFrame, Plan, PlanGround, PlanInks, RoomForNames, photos};
use crate::drawing::{Dash, Pen, png};
use crate::fault::Fault;
use crate::geodesy::Crs;
use crate::tiff_pages::{GeoTags, PROGRAM, Page, Pixels, tiff_of};
use crate::units::LengthUnit;

/// Pixels of the picture to a unit of the drawing at most: names stay readable where pixels are few.
const LARGEST: f64 = 4.0;
/// About how many units of the drawing a plan is across.
const ACROSS: f64 = 1000.0;

/// Keys of the directory (OGC 19-008r4, 7.5).
const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const CITATION: u16 = 1026;
const PROJECTED_CRS: u16 = 3072;
const PROJECTED_CITATION: u16 = 3073;
const LINEAR_UNITS: u16 = 3076;
/// Where a key's text is.
const ASCII_PARAMS: u16 = 34_737;
const PROJECTED: u16 = 1;
const USER_DEFINED: u16 = 32_767;
const PIXEL_IS_AREA: u16 = 1;

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
        georeference: Some(georeference(plan)),
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

fn georeference(plan: &Plan) -> GeoTags {
    let raster = &plan.raster;
    let mut keys = Keys::default();
    let projected = plan.projected();
    match &projected {
        Some(crs) => {
            keys.short(MODEL_TYPE, PROJECTED);
            keys.short(RASTER_TYPE, PIXEL_IS_AREA);
            match code(crs) {
                Some(code) => keys.short(PROJECTED_CRS, code),
                None => {
                    // The words by which GDAL and ArcGIS know that WKT follows.
                    let wkt = plan.crs.as_deref().unwrap_or_default();
                    keys.short(PROJECTED_CRS, USER_DEFINED);
                    keys.text(PROJECTED_CITATION, &format!("ESRI PE String = {wkt}"));
                    keys.unit(plan);
                }
            }
        }
        None => {
            keys.short(MODEL_TYPE, USER_DEFINED);
            keys.short(RASTER_TYPE, PIXEL_IS_AREA);
            keys.text(CITATION, &plan.crs_in_words());
            keys.unit(plan);
        }
    }
    let (keys, texts) = keys.end();
    GeoTags {
        pixel_scale: [raster.pixel, raster.pixel, 0.0],
        // Column, row and 0 of the first pixel's outer corner lie at x, y and 0.
        tie_point: [0.0, 0.0, 0.0, raster.corner.x, raster.corner.y, 0.0],
        keys,
        texts,
    }
}

/// The EPSG code of the map, without that of its heights, where a key can hold it.
fn code(crs: &Crs) -> Option<u16> {
    let code = crs.name().strip_prefix("EPSG:")?.split('+').next()?;
    let code: u16 = code.parse().ok()?;
    // OGC 19-008r4, 7.6.2: codes of EPSG lie there.
    (1024..USER_DEFINED).contains(&code).then_some(code)
}

/// The directory of keys, in ascending order.
#[derive(Default)]
struct Keys {
    entries: Vec<[u16; 4]>,
    texts: String,
}

impl Keys {
    fn short(&mut self, key: u16, value: u16) {
        self.entries.push([key, 0, 1, value]);
    }

    fn text(&mut self, key: u16, text: &str) {
        let text: String = text.chars().map(ascii).collect();
        let text = text + "|";
        // Texts that are longer than a key can say are none.
        if let (Ok(count), Ok(offset)) =
            (u16::try_from(text.len()), u16::try_from(self.texts.len()))
        {
            self.entries.push([key, ASCII_PARAMS, count, offset]);
            self.texts += &text;
        }
    }

    fn unit(&mut self, plan: &Plan) {
        // EPSG's codes of units; of the others none.
        let code = match plan.unit {
            LengthUnit::Metre => 9001,
            LengthUnit::Foot => 9002,
            LengthUnit::UsSurveyFoot => 9003,
            LengthUnit::Millimetre => 1025,
            LengthUnit::Centimetre => 1033,
            LengthUnit::Inch => return,
        };
        if plan.unit_known {
            self.short(LINEAR_UNITS, code);
        }
    }

    fn end(mut self) -> (Vec<u16>, String) {
        self.entries.sort_unstable();
        let count = u16::try_from(self.entries.len()).unwrap_or(0);
        // Version 1, revision 1.0.
        let mut keys = vec![1, 1, 0, count];
        keys.extend(self.entries.concat());
        (keys, self.texts)
    }
}

/// '|' ends a text in the file.
fn ascii(c: char) -> char {
    match c {
        '|' | '\0' => ' ',
        c if c.is_ascii() && !c.is_control() => c,
        c if c.is_whitespace() => ' ',
        _ => '?',
    }
}
