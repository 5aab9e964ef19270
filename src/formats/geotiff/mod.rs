//! Elevation models as GeoTIFF: TIFF 6.0 and BigTIFF, decoded by the tiff crate, with the georeference
//! of OGC 19-008r4 ([`georeference`]) and GDAL's tags.
//!
//! - One band of numbers of 16 bits and more; each cell becomes a point at its middle (PixelIsArea),
//!   or where the raster has it (PixelIsPoint). No faces: a cloud's surface is its triangulation.
//! - GDAL_NODATA (42113) is the value of cells without an elevation; so is NaN, a tile that is not
//!   stored, and where nothing is declared, -9999, -32767, -32768 and what lies beyond 1e30.
//! - GDAL_METADATA (42112) may have a scale and an offset for the values.
//! - Of larger rasters than [`MOST_CELLS`] only every n-th cell is taken, and a warning says so.
//! - A picture, georeferenced or not, is refused.

mod georeference;

use std::io::{Read, Seek};

use tiff::ColorType;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::cloud_file::CloudFile;
use super::xml_document;
use crate::fault::Fault;
use crate::jobs::Progress;
use georeference::Georeference;

/// The most cells that become points.
const MOST_CELLS: u64 = 25_000_000;

/// How many bytes a byte of compressed data can stand for, at most (deflate).
const MOST_PER_BYTE: u64 = 1100;

/// GDAL's metadata, as XML.
const GDAL_METADATA: u16 = 42_112;

const REMEDY: &str = "export it again";

/// Reads an elevation model of `size` bytes.
///
/// # Errors
/// Where it is no such file, is a picture, has no georeference or no elevation.
pub(super) fn read(
    input: impl Read + Seek,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut limits = Limits::default();
    let most = usize::try_from(size.saturating_mul(MOST_PER_BYTE).min(1 << 32));
    limits.decoding_buffer_size = most.unwrap_or(limits.decoding_buffer_size);
    limits.intermediate_buffer_size = limits.decoding_buffer_size;
    let mut decoder = Decoder::new(input).map_err(broken)?.with_limits(limits);
    let mut file = CloudFile::default();
    let georeference = Georeference::read(&mut decoder, &mut file)?;
    let color = decoder.colortype().map_err(broken)?;
    let Some(georeference) = georeference.filter(|_| matches!(color, ColorType::Gray(16..))) else {
        return Err(match color {
            ColorType::Gray(16..) => Fault::new(
                "it has no georeferencing: where its cells are is not known",
                "export it as GeoTIFF",
            ),
            _ => Fault::new(
                "it is a picture, not an elevation model (one band of numbers of 16 bits or more)",
                "give the DSM or DTM; photos belong into the photos' folder",
            ),
        });
    };
    let cells = Cells::of(&mut decoder)?;
    let step = step_for(cells.width, cells.height);
    if step > 1 {
        let (width, height) = georeference.cell();
        file.warnings.push(format!(
            "it has {} x {} cells; every {step}th in both directions is taken, {:.3} x {:.3} apart",
            cells.width,
            cells.height,
            width * f64::from(step),
            height * f64::from(step)
        ));
    }
    let mut missing = 0_u64;
    cells.read(&mut decoder, step, progress, |column, row, z| match z {
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

fn broken(error: tiff::TiffError) -> Fault {
    Fault::new(format!("it cannot be read as TIFF ({error})"), REMEDY)
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
    width: u32,
    height: u32,
    /// Of a tile or strip, in cells.
    chunk: (u32, u32),
    /// Of each tile or strip, in the file; 0 where it is left out.
    chunk_bytes: Vec<u64>,
    /// Declared by the file.
    no_data: Option<f64>,
    scale: f64,
    offset: f64,
}

impl Cells {
    fn of<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Self, Fault> {
        let (width, height) = decoder.dimensions().map_err(broken)?;
        let mut number = |tag| decoder.find_tag_unsigned::<u32>(tag).ok().flatten();
        let tile = (number(Tag::TileWidth), number(Tag::TileLength));
        let rows = number(Tag::RowsPerStrip).unwrap_or(height).min(height);
        let (chunk, tag) = match (decoder.get_chunk_type(), tile) {
            (ChunkType::Tile, (Some(across), Some(down))) => ((across, down), Tag::TileByteCounts),
            (ChunkType::Tile, _) => return Err(Fault::new("its tiles have no size", REMEDY)),
            (ChunkType::Strip, _) => ((width, rows), Tag::StripByteCounts),
        };
        if chunk.0 == 0 || chunk.1 == 0 {
            return Err(Fault::new("its tiles have no size", REMEDY));
        }
        let chunk_bytes = decoder
            .find_tag_unsigned_vec::<u64>(tag)
            .map_err(broken)?
            .unwrap_or_default();
        let mut text = |tag| {
            let value = decoder.find_tag(tag).ok().flatten();
            value.and_then(|value| value.into_string().ok())
        };
        let no_data = text(Tag::GdalNodata);
        let no_data = no_data.and_then(|text| text.trim_matches(['\0', ' ']).parse().ok());
        let metadata = text(Tag::from_u16_exhaustive(GDAL_METADATA)).unwrap_or_default();
        let (scale, offset) = scale_and_offset(&metadata);
        Ok(Self {
            width,
            height,
            chunk,
            chunk_bytes,
            no_data,
            scale,
            offset,
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
        (is_number && !missing).then_some(value * self.scale + self.offset)
    }

    /// Hands over every `step`th cell: column, row, elevation.
    fn read<R: Read + Seek>(
        &self,
        decoder: &mut Decoder<R>,
        step: u32,
        progress: &Progress,
        mut take: impl FnMut(u32, u32, Option<f64>),
    ) -> Result<(), Fault> {
        let across = self.width.div_ceil(self.chunk.0);
        let down = self.height.div_ceil(self.chunk.1);
        let chunks = u64::from(across) * u64::from(down);
        if self.chunk_bytes.len() as u64 != chunks {
            return Err(Fault::new(
                format!(
                    "it has {} tiles or strips instead of {chunks}",
                    self.chunk_bytes.len()
                ),
                "copy or export it again",
            ));
        }
        for (index, bytes) in (0_u32..).zip(&self.chunk_bytes) {
            progress.advance(index.into(), chunks)?;
            let first = (index % across * self.chunk.0, index / across * self.chunk.1);
            let width = self.chunk.0.min(self.width - first.0);
            let height = self.chunk.1.min(self.height - first.1);
            let values = match bytes {
                0 => None,
                _ => Some(decoder.read_chunk(index).map_err(broken)?),
            };
            // The first of the raster's every step-th that lies in the chunk, if one does.
            let from = |first: u32| first.checked_next_multiple_of(step).unwrap_or(u32::MAX);
            let rows = from(first.1)..first.1 + height;
            for row in rows.step_by(step as usize) {
                let columns = from(first.0)..first.0 + width;
                for column in columns.step_by(step as usize) {
                    let place =
                        (row - first.1) as usize * width as usize + (column - first.0) as usize;
                    let elevation = match &values {
                        Some(values) => self.elevation(value(values, place).ok_or_else(|| {
                            Fault::new("a tile or strip is too short", "copy or export it again")
                        })?),
                        None => None,
                    };
                    take(column, row, elevation);
                }
            }
        }
        Ok(())
    }
}

fn value(values: &DecodingResult, place: usize) -> Option<f64> {
    Some(match values {
        DecodingResult::U8(v) => f64::from(*v.get(place)?),
        DecodingResult::U16(v) => f64::from(*v.get(place)?),
        DecodingResult::U32(v) => f64::from(*v.get(place)?),
        DecodingResult::U64(v) => *v.get(place)? as f64,
        DecodingResult::I8(v) => f64::from(*v.get(place)?),
        DecodingResult::I16(v) => f64::from(*v.get(place)?),
        DecodingResult::I32(v) => f64::from(*v.get(place)?),
        DecodingResult::I64(v) => *v.get(place)? as f64,
        DecodingResult::F16(v) => v.get(place)?.to_f64(),
        DecodingResult::F32(v) => f64::from(*v.get(place)?),
        DecodingResult::F64(v) => *v.get(place)?,
    })
}

/// `<GDALMetadata><Item name="SCALE" sample="0" role="scale">0.01</Item> ...`
fn scale_and_offset(metadata: &str) -> (f64, f64) {
    let document = xml_document::parse(metadata.trim_end_matches('\0'));
    let role = |role: &str| {
        let document = document.as_ref().ok()?;
        let item = document.descendants().find(|node| {
            node.attribute("role") == Some(role)
                && matches!(node.attribute("sample"), None | Some("0"))
        })?;
        let number: f64 = item.text()?.trim().parse().ok()?;
        number.is_finite().then_some(number)
    };
    (role("scale").unwrap_or(1.0), role("offset").unwrap_or(0.0))
}

#[cfg(test)]
mod tests;
