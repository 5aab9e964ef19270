//! Where a picture that looks straight down with north up lies on the map, as tags of GeoTIFF (OGC 19-008r4).

use glam::DVec2;

use crate::geodesy::{Crs, CrsKind};
use crate::tiff_pages::GeoTags;
use crate::units::LengthUnit;

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

/// A picture that looks straight down with north up.
pub(crate) struct OnMap<'a> {
    /// "EPSG:n" or WKT, if it is stated.
    pub(crate) crs: Option<&'a str>,
    /// Of the world, if it is known.
    pub(crate) unit: Option<LengthUnit>,
    /// The side of a pixel, world units.
    pub(crate) pixel: f64,
    /// The outer corner of the first pixel.
    pub(crate) corner: DVec2,
}

/// The system, if it is one of a map.
pub(crate) fn projected(crs: Option<&str>) -> Option<Crs> {
    let crs = Crs::understand(crs?).ok()?;
    (crs.kind() == CrsKind::Projected).then_some(crs)
}

/// What to call a coordinate system: its code, the name that its WKT has, or that none is stated.
pub fn crs_in_words(crs: Option<&str>) -> String {
    match crs {
        None => "own frame, no coordinate system is stated".to_owned(),
        Some(text) if text.contains('[') => {
            let name = text.split('"').nth(1).unwrap_or("WKT");
            name.to_owned()
        }
        Some(text) => text.to_owned(),
    }
}

/// Its tags.
pub(crate) fn geo_tags(picture: &OnMap<'_>) -> GeoTags {
    let mut keys = Keys::default();
    let map = projected(picture.crs);
    let wkt = picture.crs.filter(|crs| crs.contains('['));
    let code = map.as_ref().and_then(code);
    keys.short(MODEL_TYPE, code.map_or(USER_DEFINED, |_| PROJECTED));
    keys.short(RASTER_TYPE, PIXEL_IS_AREA);
    match (code, wkt.filter(|_| map.is_some())) {
        (Some(code), _) => keys.short(PROJECTED_CRS, code),
        (None, Some(wkt)) => {
            // The words by which GDAL and ArcGIS know that WKT follows; GDAL looks for them only where the model is none that keys
            // describe (rasterio 1.4.4 reads ESRI's WKT, GDAL's and WKT 2 of it, with their units).
            keys.short(PROJECTED_CRS, USER_DEFINED);
            keys.text(PROJECTED_CITATION, &format!("ESRI PE String = {wkt}"));
            keys.unit(picture.unit);
        }
        (None, None) => {
            keys.text(CITATION, &crs_in_words(picture.crs));
            keys.unit(picture.unit);
        }
    }
    let (keys, texts) = keys.end();
    GeoTags {
        pixel_scale: [picture.pixel, picture.pixel, 0.0],
        // Column, row and 0 of the first pixel's outer corner lie at x, y and 0.
        tie_point: [0.0, 0.0, 0.0, picture.corner.x, picture.corner.y, 0.0],
        keys,
        texts,
    }
}

/// The EPSG code of the map, without that of its heights, where a key can hold it.
fn code(crs: &Crs) -> Option<u16> {
    let code = crs.map_name().strip_prefix("EPSG:")?;
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

    fn unit(&mut self, unit: Option<LengthUnit>) {
        // EPSG's codes of units; of the others none.
        let code = match unit {
            Some(LengthUnit::Metre) => 9001,
            Some(LengthUnit::Foot) => 9002,
            Some(LengthUnit::UsSurveyFoot) => 9003,
            Some(LengthUnit::Millimetre) => 1025,
            Some(LengthUnit::Centimetre) => 1033,
            Some(LengthUnit::Inch) | None => return,
        };
        self.short(LINEAR_UNITS, code);
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
