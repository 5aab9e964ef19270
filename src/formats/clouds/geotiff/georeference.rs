//! Where a GeoTIFF's cells are: OGC 19-008r4, "OGC GeoTIFF Standard 1.1", which repeats GeoTIFF 1.0.

use std::io::{Read, Seek};

use glam::{DVec2, DVec3};
use tiff::decoder::Decoder;
use tiff::tags::Tag;

use crate::clouds::cloud_file::CloudFile;
use crate::clouds::geo_keys::{
    GEODETIC_CRS, MODEL_TYPE, PROJECTED_CRS, RASTER_TYPE, StatedHeights, USER_DEFINED,
};
use crate::fault::Fault;

/// The words in front of WKT.
const PE_STRING: &str = "ESRI PE String = ";

/// What people call the system; the second for the projected one alone.
const CITATIONS: [u16; 2] = [3073, 1026];

/// From cells to the world.
#[derive(Debug, PartialEq)]
pub(super) struct Georeference {
    /// The world's (x, y) of the raster's origin, of a step along a row, and of a step to the next row.
    origin: DVec2,
    along_row: DVec2,
    to_next_row: DVec2,
    /// Where in a cell its value belongs: its middle, or the raster's own corner point.
    within_cell: f64,
    /// What the keys say of heights.
    pub(super) heights: StatedHeights,
}

impl Georeference {
    /// Reads the tags; what they say about the coordinate system goes into `file`. `None` where there
    /// are none.
    ///
    /// # Errors
    /// Where they cannot be a straight grid over the world's x and y.
    pub(super) fn read<R: Read + Seek>(
        decoder: &mut Decoder<R>,
        file: &mut CloudFile,
    ) -> Result<Option<Self>, Fault> {
        let mut numbers = |tag| {
            let value = decoder.find_tag(tag).ok().flatten();
            value.and_then(|value| value.into_f64_vec().ok())
        };
        let scale = numbers(Tag::ModelPixelScaleTag);
        let tie_points = numbers(Tag::ModelTiepointTag);
        let matrix = numbers(Tag::ModelTransformationTag);
        let keys = Keys::read(decoder);
        let (origin, along_row, to_next_row) = match (matrix, scale, tie_points) {
            (Some(matrix), ..) => {
                let [a, b, _, x, d, e, _, y, ..] = matrix[..] else {
                    return Err(bad_tag("ModelTransformation", &matrix));
                };
                (DVec2::new(x, y), DVec2::new(a, d), DVec2::new(b, e))
            }
            (None, Some(scale), Some(tie)) => {
                let [width, height, ..] = scale[..] else {
                    return Err(bad_tag("ModelPixelScale", &scale));
                };
                let [column, row, _, x, y, ..] = tie[..] else {
                    return Err(bad_tag("ModelTiepoint", &tie));
                };
                // Rows run south, also where a writer says so by a minus, as GDAL takes it.
                let height = height.abs();
                let origin = DVec2::new(x - column * width, y + row * height);
                (origin, DVec2::new(width, 0.0), DVec2::new(0.0, -height))
            }
            (None, None, Some(tie)) => {
                return Err(Fault::new(
                    format!(
                        "it is placed by {} control points, not by a grid",
                        tie.len() / 6
                    ),
                    "rectify it first, with gdalwarp for example",
                ));
            }
            (None, _, None) => return Ok(None),
        };
        let grid = Self {
            origin,
            along_row,
            to_next_row,
            within_cell: if keys.short(RASTER_TYPE) == Some(2) {
                0.0
            } else {
                0.5
            },
            heights: StatedHeights::of(|key| keys.short(key)),
        };
        let finite = origin.is_finite() && along_row.is_finite() && to_next_row.is_finite();
        if !finite || along_row.perp_dot(to_next_row) == 0.0 {
            return Err(Fault::new(
                "its cells have no size, or lie on one line",
                "export it again",
            ));
        }
        keys.tell(file)?;
        Ok(Some(grid))
    }

    /// The world's (x, y) of what the value of a cell belongs to.
    pub(super) fn point(&self, column: u32, row: u32, z: f64) -> DVec3 {
        let column = f64::from(column) + self.within_cell;
        let row = f64::from(row) + self.within_cell;
        (self.origin + column * self.along_row + row * self.to_next_row).extend(z)
    }

    /// The length of a step from cell to cell, along a row and to the next.
    pub(super) fn cell(&self) -> (f64, f64) {
        (self.along_row.length(), self.to_next_row.length())
    }
}

fn bad_tag(name: &str, values: &[f64]) -> Fault {
    Fault::new(
        format!("its tag {name} has {} numbers, too few", values.len()),
        "export it again",
    )
}

/// The key directory: of each key its number, the tag that holds its value (0: none), how many, and
/// the value or where it begins.
#[derive(Debug, Default)]
struct Keys {
    directory: Vec<u16>,
    ascii: String,
}

impl Keys {
    fn read<R: Read + Seek>(decoder: &mut Decoder<R>) -> Self {
        let mut tag = |tag| decoder.find_tag(tag).ok().flatten();
        let directory = tag(Tag::GeoKeyDirectoryTag).and_then(|v| v.into_u16_vec().ok());
        let ascii = tag(Tag::GeoAsciiParamsTag).and_then(|v| v.into_string().ok());
        Self {
            directory: directory.unwrap_or_default(),
            ascii: ascii.unwrap_or_default(),
        }
    }

    fn find(&self, key: u16) -> Option<[u16; 4]> {
        let entries = self.directory.get(4..)?.as_chunks::<4>().0;
        entries.iter().copied().find(|entry| entry[0] == key)
    }

    /// The value of a key that holds a whole number.
    fn short(&self, key: u16) -> Option<u16> {
        match self.find(key)? {
            [_, 0, _, value] => Some(value),
            _ => None,
        }
    }

    fn citation(&self) -> Option<&str> {
        CITATIONS.into_iter().find_map(|key| {
            let [_, tag, count, begin] = self.find(key)?;
            if tag != Tag::GeoAsciiParamsTag.to_u16() {
                return None;
            }
            let begin = usize::from(begin);
            let text = self.ascii.get(begin..begin + usize::from(count))?;
            Some(text.trim_matches(|c: char| c == '|' || c == '\0' || c.is_whitespace()))
        })
    }

    /// Says what is known of the coordinate system.
    fn tell(&self, file: &mut CloudFile) -> Result<(), Fault> {
        let model = self.short(MODEL_TYPE);
        if model == Some(3) {
            return Err(Fault::new(
                "its coordinates are geocentric",
                "project it to a metric system, such as UTM",
            ));
        }
        let geographic = model == Some(2);
        let key = if geographic {
            GEODETIC_CRS
        } else {
            PROJECTED_CRS
        };
        let wkt = self
            .citation()
            .and_then(|name| name.strip_prefix(PE_STRING));
        match self.short(key) {
            Some(0) | None => {}
            // GDAL, ArcGIS and fragscale write WKT behind these words.
            Some(USER_DEFINED) if wkt.is_some() => file.crs = wkt.map(str::to_owned),
            Some(USER_DEFINED) => {
                let name = self.citation().unwrap_or("unnamed");
                file.warnings.push(format!(
                    "its coordinate system ('{name}') is defined by parameters, not by an EPSG code, and is not taken over"
                ));
            }
            Some(code) => file.crs = Some(format!("EPSG:{code}")),
        }
        file.set_geographic(geographic);
        Ok(())
    }
}
