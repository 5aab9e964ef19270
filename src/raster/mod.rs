//! Rasters in TIFF files, tile by tile or strip by strip: elevation models and photos alike.
//!
//! Written from TIFF 6.0 (Adobe, 1992), Adobe's Photoshop TIFF Technical Notes (2002: deflate) and
//! Technical Note 3 (2005: the floating-point predictor), the BigTIFF proposal, and what libtiff 4.7
//! writes where these are silent (zstd is 50000; a predictor belongs to LZW, deflate and zstd alone).
//! The `tiff` crate reads the directories. The data are taken apart here: that crate refuses whole LZW
//! ("no lzw end code found"), has no zstd without a second copy of its library, applies predictors that
//! libtiff ignores, turns WhiteIsZero around in elevations, and hands over no YCbCr as it is stored.
//!
//! - Compression: none, LZW, deflate (both numbers), PackBits, zstd; JPEG as it is stored, for whoever
//!   can decode it. All others are refused by their names.
//! - Predictors 1, 2 (whole numbers of 8, 16, 32 and 64 bits) and 3 (the floating-point one).
//! - Chunky and planar; classic and BigTIFF; both byte orders.
//! - The image is the first directory that is neither a reduced one (an overview) nor a mask.
//! - What a header claims takes no memory before the bytes for it are there.

mod compression;
mod predictor;

use std::io::{Read, Seek, SeekFrom};

use tiff::decoder::Decoder;
use tiff::tags::{ByteOrder, Tag};

use crate::fault::Fault;
pub use compression::Compression;

const REMEDY: &str = "copy or export it again";

/// Directories that are looked through for the image, and for its mask.
const MOST_DIRECTORIES: usize = 64;
/// And where images are counted, of which a stack has many.
const MOST_COUNTED: usize = 1000;

/// The largest tile or strip, in bytes when taken apart.
const MOST_BYTES: u64 = 1 << 32;

/// `NewSubfileType`: bits for a reduced image and for a mask.
const REDUCED: u32 = 1;
const MASK: u32 = 4;

/// `PhotometricInterpretation` that matters to the layout.
const YCBCR: u16 = 6;

/// A TIFF file of which one image is looked at.
#[derive(Debug)]
pub struct TiffFile<R: Read + Seek> {
    decoder: Decoder<R>,
    /// Of the whole file, in bytes.
    size: u64,
}

/// What the numbers of an image are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberKind {
    /// Whole, from 0.
    Unsigned,
    /// Whole, two's complement.
    Signed,
    /// IEEE floating point.
    Float,
    /// By its number of the tag `SampleFormat`: 5 and 6 are complex, 4 is undefined.
    Other(u16),
}

/// How an image lies in its file.
#[derive(Debug, Clone)]
pub struct Layout {
    /// In cells.
    pub width: u32,
    /// In cells.
    pub height: u32,
    /// Of a tile or strip, in cells. The last strip may be lower, a tile never.
    pub chunk: (u32, u32),
    /// Whether the chunks are tiles.
    pub tiled: bool,
    /// Numbers a cell, in all planes.
    pub samples: u16,
    /// Whether each sample has chunks of its own, one plane behind the other.
    pub planar: bool,
    /// Of a number.
    pub bits: u16,
    /// Of all numbers.
    pub kind: NumberKind,
    /// Of all chunks.
    pub compression: Compression,
    /// The tag `PhotometricInterpretation`.
    pub photometric: u16,
    /// Cells across and down that share their colour, where colours are stored so (YCbCr that is not
    /// JPEG). Each such block is stored as its luminances, then Cb, then Cr.
    pub subsampling: Option<(u16, u16)>,
    predictor: u16,
    big_endian: bool,
    /// Of each chunk, in the file: where it begins and how long it is (0: it is left out).
    places: Vec<(u64, u64)>,
}

impl<R: Read + Seek> TiffFile<R> {
    /// Opens a file of `size` bytes at its image.
    ///
    /// # Errors
    /// Where it is no TIFF, or its directory is broken.
    pub fn open(input: R, size: u64) -> Result<Self, Fault> {
        let mut decoder = Decoder::new(input).map_err(broken)?;
        let mut looked_at = 1;
        while subfile(&mut decoder) & (REDUCED | MASK) != 0 {
            if looked_at == MOST_DIRECTORIES || !decoder.more_images() {
                let what = "all its images are overviews or masks";
                return Err(Fault::new(what, REMEDY));
            }
            decoder.next_image().map_err(broken)?;
            looked_at += 1;
        }
        Ok(Self { decoder, size })
    }

    /// The tags of the image.
    pub fn tags(&mut self) -> &mut Decoder<R> {
        &mut self.decoder
    }

    /// Width and height of the image, in cells.
    ///
    /// # Errors
    /// Where the tags do not say them.
    pub fn size(&mut self) -> Result<(u32, u32), Fault> {
        self.decoder.dimensions().map_err(broken)
    }

    /// How the image lies in the file.
    ///
    /// # Errors
    /// Where its tags contradict each other.
    pub fn layout(&mut self) -> Result<Layout, Fault> {
        Layout::of(&mut self.decoder)
    }

    /// The image's mask, where it has one: an image of the same size that says which cells count. The
    /// tags are those of another directory afterwards.
    pub fn mask(&mut self, image: &Layout) -> Option<Layout> {
        for _ in 1..MOST_DIRECTORIES {
            if self.next_kind()? == MASK {
                let mask = Layout::of(&mut self.decoder).ok()?;
                return ((mask.width, mask.height) == (image.width, image.height)).then_some(mask);
            }
        }
        None
    }

    /// How many images there are of the size of this one, itself with them, which are neither overviews nor masks, and whether
    /// these are all: no more than 1000 directories are looked through. The tags are those of another directory afterwards.
    pub fn images_alike(&mut self, image: &Layout) -> (usize, bool) {
        let mut count = 1;
        // One that leads back to an earlier one is an error to the crate that reads them: the walk ends there.
        for _ in 1..MOST_COUNTED {
            let Some(kind) = self.next_kind() else {
                return (count, true);
            };
            let has_its_size = self
                .size()
                .is_ok_and(|size| size == (image.width, image.height));
            count += usize::from(kind == 0 && has_its_size);
        }
        (count, !self.decoder.more_images())
    }

    /// Goes to the next directory, and says whether it is an overview or a mask (0: neither); `None` behind the last.
    fn next_kind(&mut self) -> Option<u32> {
        let is_there = self.decoder.more_images() && self.decoder.next_image().is_ok();
        is_there.then(|| subfile(&mut self.decoder) & (REDUCED | MASK))
    }

    /// The bytes of a chunk as they are in the file; `None` where it is left out.
    ///
    /// # Errors
    /// Where the file ends before.
    pub fn stored(&mut self, layout: &Layout, index: u32) -> Result<Option<Vec<u8>>, Fault> {
        let place = layout.places.get(index as usize);
        let &(begin, length) = place.ok_or_else(|| too_short(index))?;
        if length == 0 {
            return Ok(None);
        }
        let end = begin.checked_add(length);
        let (Some(_), Ok(length)) = (end.filter(|&end| end <= self.size), usize::try_from(length))
        else {
            return Err(Fault::new(
                format!(
                    "it is cut off: tile or strip {index} lies beyond its {} bytes",
                    self.size
                ),
                REMEDY,
            ));
        };
        let input = self.decoder.inner();
        let mut bytes = vec![0; length];
        input
            .seek(SeekFrom::Start(begin))
            .and_then(|_| input.read_exact(&mut bytes))
            .map_err(|e| Fault::new(format!("it cannot be read ({e})"), REMEDY))?;
        Ok(Some(bytes))
    }

    /// The numbers of a chunk, row by row without gaps, little-endian whatever the file is; `None`
    /// where it is left out. Rows of 1-bit numbers begin at whole bytes, the first in the highest bit.
    ///
    /// # Errors
    /// Where it is damaged, or compressed in a way that is not read here.
    pub fn chunk(&mut self, layout: &Layout, index: u32) -> Result<Option<Vec<u8>>, Fault> {
        let (rows, row_bytes) = layout.rows_of(index)?;
        let Some(stored) = self.stored(layout, index)? else {
            return Ok(None);
        };
        let expected = u64::from(rows)
            .checked_mul(row_bytes)
            .filter(|&bytes| bytes <= MOST_BYTES)
            .and_then(|bytes| usize::try_from(bytes).ok())
            .ok_or_else(|| Fault::new("its tiles or strips are over 4 GiB", REMEDY))?;
        let mut bytes = layout
            .compression
            .unpacked(stored, expected)
            .map_err(|fault| {
                Fault::new(format!("tile or strip {index}: {}", fault.what), REMEDY)
            })?;
        let row_bytes = usize::try_from(row_bytes).unwrap_or(usize::MAX).max(1);
        let samples = layout.samples_a_chunk();
        let number_bytes = usize::from(layout.bits / 8);
        match (layout.predictor, number_bytes) {
            (3, 2 | 4 | 8) => {
                for row in bytes.chunks_exact_mut(row_bytes) {
                    predictor::undo_floating_point(row, samples, number_bytes);
                }
            }
            (predictor, 1 | 2 | 4 | 8) => {
                if layout.big_endian {
                    predictor::reverse_numbers(&mut bytes, number_bytes);
                }
                if predictor == 2 {
                    for row in bytes.chunks_exact_mut(row_bytes) {
                        predictor::undo_horizontal(row, samples, number_bytes);
                    }
                }
            }
            _ => {}
        }
        Ok(Some(bytes))
    }
}

/// `NewSubfileType` of the directory.
fn subfile<R: Read + Seek>(decoder: &mut Decoder<R>) -> u32 {
    let tag = decoder.find_tag_unsigned(Tag::NewSubfileType);
    tag.ok().flatten().unwrap_or(0)
}

fn broken(error: tiff::TiffError) -> Fault {
    Fault::new(format!("it cannot be read as TIFF ({error})"), REMEDY)
}

fn too_short(index: u32) -> Fault {
    Fault::new(format!("it has no tile or strip {index}"), REMEDY)
}

impl Layout {
    fn of<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<Self, Fault> {
        let (width, height) = decoder.dimensions().map_err(broken)?;
        let mut number = |tag, otherwise: u32| {
            let tag = decoder.find_tag_unsigned(tag);
            tag.map(|value| value.unwrap_or(otherwise)).map_err(broken)
        };
        let tile = (number(Tag::TileWidth, 0)?, number(Tag::TileLength, 0)?);
        let rows = number(Tag::RowsPerStrip, height)?.min(height);
        let samples = short(number(Tag::SamplesPerPixel, 1)?)?;
        let planar = number(Tag::PlanarConfiguration, 1)? == 2 && samples > 1;
        let photometric = short(number(Tag::PhotometricInterpretation, 1)?)?;
        let compression = Compression::of(short(number(Tag::Compression, 1)?)?);
        let predictor = match compression.has_predictor() {
            true => short(number(Tag::Predictor, 1)?)?,
            false => 1,
        };
        let fill_order = number(Tag::FillOrder, 1)?;
        let mut numbers = |tag| {
            let tag = decoder.find_tag_unsigned_vec::<u64>(tag);
            tag.map(Option::unwrap_or_default).map_err(broken)
        };
        let first = |values: Vec<u64>, otherwise| values.first().copied().unwrap_or(otherwise);
        let bits = short(first(numbers(Tag::BitsPerSample)?, 1).min(u64::from(u16::MAX)) as u32)?;
        let kind = match first(numbers(Tag::SampleFormat)?, 1) {
            1 => NumberKind::Unsigned,
            2 => NumberKind::Signed,
            3 => NumberKind::Float,
            other => NumberKind::Other(u16::try_from(other).unwrap_or(u16::MAX)),
        };
        let tiled = tile != (0, 0);
        let (chunk, tags) = match tiled {
            true => (tile, (Tag::TileOffsets, Tag::TileByteCounts)),
            false => ((width, rows), (Tag::StripOffsets, Tag::StripByteCounts)),
        };
        if chunk.0 == 0 || chunk.1 == 0 {
            return Err(Fault::new("its tiles or strips have no size", REMEDY));
        }
        let begins = numbers(tags.0)?;
        let lengths = numbers(tags.1)?;
        let subsampling = match &numbers(Tag::ChromaSubsampling)?[..] {
            _ if photometric != YCBCR || compression == Compression::Jpeg => None,
            // The specification's default.
            [] => Some((2, 2)),
            [across, down] => Some((short(*across as u32)?, short(*down as u32)?)),
            _ => {
                return Err(Fault::new(
                    "its YCbCrSubSampling is not two numbers",
                    REMEDY,
                ));
            }
        };
        let layout = Self {
            width,
            height,
            chunk,
            tiled,
            samples,
            planar,
            bits,
            kind,
            compression,
            photometric,
            subsampling,
            predictor,
            big_endian: decoder.byte_order() == ByteOrder::BigEndian,
            places: begins.into_iter().zip(lengths).collect(),
        };
        layout.check(fill_order)?;
        Ok(layout)
    }

    /// Refuses what would be read wrongly.
    fn check(&self, fill_order: u32) -> Result<(), Fault> {
        let planes = if self.planar { self.samples } else { 1 };
        let chunks = u64::from(self.across()) * u64::from(self.down()) * u64::from(planes);
        if self.places.len() as u64 != chunks {
            let found = self.places.len();
            let what = format!("it has {found} tiles or strips instead of {chunks}");
            return Err(Fault::new(what, REMEDY));
        }
        let refuse = |what: String| {
            let remedy = "export it again, with LZW or deflate";
            Err(Fault::new(
                format!("{what}, which is not supported"),
                remedy,
            ))
        };
        if fill_order != 1 {
            return refuse(format!("its bits are in FillOrder {fill_order}"));
        }
        let whole_bytes = matches!(self.bits, 8 | 16 | 32 | 64);
        match self.predictor {
            1 => {}
            2 if whole_bytes && self.subsampling.is_none() => {}
            3 if self.kind == NumberKind::Float && matches!(self.bits, 16 | 32 | 64) => {}
            other => {
                return refuse(format!(
                    "it has predictor {other} with numbers of {} bits",
                    self.bits
                ));
            }
        }
        if self.subsampling.is_some() && (self.planar || self.samples != 3 || self.bits != 8) {
            return refuse("its YCbCr colours are not three interleaved bytes".to_owned());
        }
        if matches!(self.subsampling, Some((across, down)) if !(matches!(across, 1 | 2 | 4) && matches!(down, 1 | 2 | 4)))
        {
            return refuse(format!("its YCbCr subsampling is {:?}", self.subsampling));
        }
        Ok(())
    }

    /// Chunks side by side.
    pub fn across(&self) -> u32 {
        self.width.div_ceil(self.chunk.0)
    }

    /// Chunks one below the other.
    pub fn down(&self) -> u32 {
        self.height.div_ceil(self.chunk.1)
    }

    /// Numbers a cell in one chunk.
    pub fn samples_a_chunk(&self) -> usize {
        if self.planar { 1 } else { self.samples.into() }
    }

    /// The first column and row of a chunk, and its cells across and down that lie in the image.
    pub fn extent(&self, index: u32) -> ((u32, u32), (u32, u32)) {
        let in_plane = index % self.across().saturating_mul(self.down()).max(1);
        let first = (
            in_plane % self.across() * self.chunk.0,
            in_plane / self.across() * self.chunk.1,
        );
        let size = (
            self.chunk.0.min(self.width - first.0),
            self.chunk.1.min(self.height - first.1),
        );
        (first, size)
    }

    /// Rows that a chunk has in the file, and the bytes of one. Of subsampled colours the rows are
    /// rows of blocks.
    fn rows_of(&self, index: u32) -> Result<(u32, u64), Fault> {
        let rows = match self.tiled {
            true => self.chunk.1,
            false => self.extent(index).1.1,
        };
        if let Some((across, down)) = self.subsampling {
            let block = u64::from(across) * u64::from(down) + 2;
            let blocks = u64::from(self.chunk.0.div_ceil(across.into()));
            return Ok((rows.div_ceil(down.into()), blocks * block));
        }
        let bits = u64::from(self.bits) * self.samples_a_chunk() as u64;
        let bits = bits.checked_mul(self.chunk.0.into());
        let bits = bits.ok_or_else(|| Fault::new("its rows are too long", REMEDY))?;
        Ok((rows, bits.div_ceil(8)))
    }
}

fn short(value: u32) -> Result<u16, Fault> {
    u16::try_from(value).map_err(|_| Fault::new("a tag's number is too large", REMEDY))
}

#[cfg(test)]
mod tests;
