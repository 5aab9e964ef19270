//! Elevation models as GeoTIFF: TIFF 6.0 and BigTIFF, taken apart by [`crate::raster`], with the
//! georeference of OGC 19-008r4 ([`georeference`]) and GDAL's tags.
//!
//! - Whole numbers of 8 to 64 bits, with and without a sign, and floating point of 32 and 64; each cell
//!   becomes a point at its middle (PixelIsArea), or where the raster has it (PixelIsPoint). No faces: a
//!   cloud's surface is its triangulation. Of several bands the first is taken, and a warning says so.
//! - Half floats, complex numbers, numbers of odd bits and compressions that are not read (LERC, LZMA,
//!   JPEG, WebP, JPEG XL) are refused by name: JPEG and WebP would change the elevations.
//! - GDAL_NODATA (42113) is the value of cells without an elevation; so is NaN, a tile that is not
//!   stored, and where nothing is declared, -9999, -32767, -32768 and what lies beyond 1e30. So is a
//!   cell that a mask in the file leaves out (a directory of NewSubfileType 4, as GDAL writes it).
//! - GDAL_METADATA (42112) may have a scale and an offset for the values, and their unit.
//! - Of larger rasters than [`MOST_CELLS`] only every n-th cell is taken, and a warning says so.
//! - A picture, georeferenced or not, is refused. One band of bytes may be either: it is read, and a
//!   warning says what it may be.

mod georeference;
mod number;

use std::io::{Read, Seek};

use tiff::decoder::Decoder;
use tiff::tags::Tag;

use crate::clouds::cloud_file::CloudFile;
use crate::clouds::geo_keys::{StatedHeights, metres_of_words};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::raster::{Compression, Layout, TiffFile};
use crate::text::xml_document;
use georeference::Georeference;
pub(crate) use number::Number;

/// The most cells that become points.
const MOST_CELLS: u64 = 25_000_000;

/// GDAL's metadata, as XML.
const GDAL_METADATA: u16 = 42_112;

const REMEDY: &str = "export it again";

/// Reads an elevation model of `size` bytes.
///
/// # Errors
/// Where it is no such file, is a picture, has no georeference or no elevation.
pub(crate) fn read(
    input: impl Read + Seek,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut tiff = TiffFile::open(input, size)?;
    let mut file = CloudFile::default();
    let georeference = Georeference::read(tiff.tags(), &mut file)?;
    let layout = tiff.layout()?;
    if is_picture(&layout) || (georeference.is_none() && layout.bits <= 8) {
        return Err(Fault::new(
            "it is a picture, not an elevation model (one band of numbers)",
            "give the DSM or DTM; photos belong into the photos' folder",
        ));
    }
    let Some(georeference) = georeference else {
        return Err(Fault::new(
            "it has no georeferencing: where its cells are is not known",
            "export it as GeoTIFF",
        ));
    };
    let mut cells = Cells::of(&mut tiff, layout)?;
    let heights = StatedHeights {
        // GDAL writes both, and reads this one first.
        unit: cells.metadata.unit.or(georeference.heights.unit),
        ..georeference.heights
    };
    let factor = heights.tell(&mut file);
    cells.metadata.scale *= factor;
    cells.metadata.offset *= factor;
    if cells.number == Number::U8 {
        let what = "its elevations are whole numbers from 0 to 255, as grey pictures have them: make sure that it is no shaded relief and no orthophoto";
        file.warnings.push(what.to_owned());
    }
    let layout = &cells.layout;
    if layout.samples > 1 {
        file.warnings.push(format!(
            "it has {} bands; the first is taken for the elevations",
            layout.samples
        ));
    }
    let step = step_for(layout.width, layout.height);
    if step > 1 {
        let (width, height) = georeference.cell();
        file.warnings.push(format!(
            "it has {} x {} cells; one of {step} in both directions is taken, {:.3} x {:.3} apart",
            layout.width,
            layout.height,
            width * f64::from(step),
            height * f64::from(step)
        ));
    }
    let mut missing = 0_u64;
    cells.read(&mut tiff, step, progress, |column, row, z| match z {
        Some(z) => file.cloud.points.push(georeference.point(column, row, z)),
        None => missing += 1,
    })?;
    if file.cloud.points.is_empty() {
        return Err(Fault::new("none of its cells has an elevation", REMEDY));
    }
    if !file.cloud.points.iter().all(|point| point.is_finite()) {
        return Err(Fault::new("its cells lie at infinity", REMEDY));
    }
    if missing > 0 {
        let all = missing + file.cloud.points.len() as u64;
        file.warnings
            .push(format!("{missing} of {all} cells have no elevation"));
    }
    Ok(file)
}

/// By what its numbers mean: colours of any kind, bytes in several bands (grey with transparency), and
/// single bits. `PhotometricInterpretation` 0 and 1 are grey.
fn is_picture(layout: &Layout) -> bool {
    let bytes = Number::of(layout).ok() == Some(Number::U8);
    layout.photometric > 1 || layout.bits == 1 || (bytes && layout.samples > 1)
}

/// Every how many cells one is taken.
fn step_for(width: u32, height: u32) -> u32 {
    let all = u64::from(width) * u64::from(height);
    let mut step = 1_u32;
    while all / (u64::from(step) * u64::from(step)) > MOST_CELLS {
        step += 1;
    }
    step
}

/// The raster, and what its values mean.
struct Cells {
    layout: Layout,
    number: Number,
    /// Which cells count, in the same tiles or strips.
    mask: Option<Layout>,
    /// Declared by the file.
    no_data: Option<f64>,
    metadata: Metadata,
}

impl Cells {
    /// The tags of `tiff` are those of a mask afterwards, where it has one.
    fn of<R: Read + Seek>(tiff: &mut TiffFile<R>, layout: Layout) -> Result<Self, Fault> {
        let number = Number::of(&layout)?;
        if let Compression::Jpeg | Compression::Other(_) = layout.compression {
            return Err(Fault::new(
                format!(
                    "its compression is {}, which is not supported",
                    layout.compression.name()
                ),
                "export it with deflate, LZW or zstd",
            ));
        }
        let no_data = text(tiff.tags(), Tag::GdalNodata);
        let no_data = no_data.and_then(|text| text.trim_matches(['\0', ' ']).parse().ok());
        let metadata = text(tiff.tags(), Tag::from_u16_exhaustive(GDAL_METADATA));
        let metadata = Metadata::of(&metadata.unwrap_or_default());
        let mask = tiff.mask(&layout);
        if let Some(mask) = &mask
            && (mask.chunk != layout.chunk || mask.samples != 1 || !matches!(mask.bits, 1 | 8))
        {
            return Err(Fault::new(
                "its mask lies in other tiles than its cells, which is not supported",
                "export it with a nodata value instead of a mask",
            ));
        }
        Ok(Self {
            layout,
            number,
            mask,
            no_data,
            metadata,
        })
    }

    /// The elevation that a value means.
    fn elevation(&self, value: f64) -> Option<f64> {
        let missing = match self.no_data {
            // The text may have more digits than a float, or fewer.
            Some(no_data) => value == no_data || value as f32 == no_data as f32,
            None => [-9999.0, -32_767.0, -32_768.0].contains(&value),
        };
        let is_number = value.is_finite() && value.abs() < 1e30;
        (is_number && !missing).then_some(value * self.metadata.scale + self.metadata.offset)
    }

    /// Hands over every `step`th cell: column, row, elevation.
    fn read<R: Read + Seek>(
        &self,
        tiff: &mut TiffFile<R>,
        step: u32,
        progress: &Progress,
        mut take: impl FnMut(u32, u32, Option<f64>),
    ) -> Result<(), Fault> {
        let layout = &self.layout;
        // Of a planar raster the first plane's: the first band.
        let chunks = layout.across().saturating_mul(layout.down());
        let cell = layout.samples_a_chunk() * self.number.bytes();
        let row_bytes = layout.chunk.0 as usize * cell;
        for index in 0..chunks {
            progress.advance(index.into(), chunks.into())?;
            let ((left, top), (width, height)) = layout.extent(index);
            let values = tiff.chunk(layout, index)?;
            let mask = match (&self.mask, &values) {
                (Some(mask), Some(_)) => Some((mask.bits, tiff.chunk(mask, index)?)),
                _ => None,
            };
            // The first of the raster's every step-th that lies in the chunk, if one does.
            let from = |first: u32| first.checked_next_multiple_of(step).unwrap_or(u32::MAX);
            for row in (from(top)..top + height).step_by(step as usize) {
                let place = (row - top) as usize * row_bytes;
                let values = values.as_deref().and_then(|values| values.get(place..));
                for column in (from(left)..left + width).step_by(step as usize) {
                    let (across, down) = ((column - left) as usize, (row - top) as usize);
                    let counts = match &mask {
                        Some((bits, mask)) => {
                            is_set(mask.as_deref(), *bits, layout.chunk.0, across, down)
                        }
                        None => true,
                    };
                    let value = values.filter(|_| counts);
                    let value = value.and_then(|row| self.number.read(row.get(across * cell..)?));
                    take(column, row, value.and_then(|value| self.elevation(value)));
                }
            }
        }
        Ok(())
    }
}

/// Whether a cell of a mask's tile counts; none does where the tile is left out.
fn is_set(mask: Option<&[u8]>, bits: u16, width: u32, across: usize, down: usize) -> bool {
    let row_bytes = (width as usize * usize::from(bits)).div_ceil(8);
    let byte = |at: usize| mask.and_then(|mask| mask.get(down * row_bytes + at));
    match bits {
        1 => byte(across / 8).is_some_and(|byte| byte >> (7 - across % 8) & 1 == 1),
        _ => byte(across).is_some_and(|byte| *byte != 0),
    }
}

fn text<R: Read + Seek>(tags: &mut Decoder<R>, tag: Tag) -> Option<String> {
    tags.find_tag(tag).ok()??.into_string().ok()
}

/// What GDAL's metadata say of the first band.
#[derive(Debug, PartialEq)]
struct Metadata {
    scale: f64,
    offset: f64,
    /// Metres in the unit of the elevations.
    unit: Option<f64>,
}

impl Metadata {
    /// `<GDALMetadata><Item name="SCALE" sample="0" role="scale">0.01</Item> ...`
    fn of(text: &str) -> Self {
        let document = xml_document::parse(text.trim_end_matches('\0'));
        let role = |role: &str| {
            let document = document.as_ref().ok()?;
            let item = document.descendants().find(|node| {
                node.attribute("role") == Some(role)
                    && matches!(node.attribute("sample"), None | Some("0"))
            })?;
            item.text()
        };
        let number = |name: &str| {
            let number: f64 = role(name)?.trim().parse().ok()?;
            number.is_finite().then_some(number)
        };
        Self {
            scale: number("scale").unwrap_or(1.0),
            offset: number("offset").unwrap_or(0.0),
            unit: role("unittype").and_then(metres_of_words),
        }
    }
}

#[cfg(test)]
mod tests;
