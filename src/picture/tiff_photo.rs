//! Photos in TIFF files: 8 and 16 bits a colour, grey, RGB or YCbCr (TIFF 6.0, section 21; JPEG as in
//! Adobe's Technical Note 2), in the tiles, strips and compressions of [`crate::raster`].
//!
//! - Further samples (transparency, infrared) are left out; 16 bits become 8.
//! - JPEG is decoded by another program's rules for filling in the colours that it shares among pixels:
//!   beside libjpeg a pixel may differ by some levels. YCbCr that is not JPEG is taken as libtiff does:
//!   each pixel has the colour of its block.
//! - A tile that is not stored makes a photo incomplete, and is refused.

use std::io::{Cursor, Read, Seek};

use image::RgbImage;
use tiff::decoder::ifd::Value;
use tiff::tags::Tag;

use super::image_size::check_size;
use super::jpeg::{self, Colors};
use crate::fault::Fault;
use crate::raster::{Compression, Layout, NumberKind, TiffFile};

const YCBCR_COEFFICIENTS: u16 = 529;
const REFERENCE_BLACK_WHITE: u16 = 532;

/// What the samples of a pixel are, by `PhotometricInterpretation`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Photometric {
    WhiteIsZero,
    BlackIsZero,
    Rgb,
    YCbCr,
}

/// A photo and its colour profile, where it has one.
type PhotoWithProfile = (RgbImage, Option<Vec<u8>>);

/// The photo and its colour profile; `None` where it is of a kind that is left to others (CMYK, single
/// bits, floating point).
///
/// # Errors
/// Where it is damaged, cut off, or compressed in a way that is not read.
pub(super) fn decode(bytes: &[u8]) -> Result<Option<PhotoWithProfile>, Fault> {
    let mut file = TiffFile::open(Cursor::new(bytes), bytes.len() as u64)?;
    let layout = file.layout()?;
    check_size(layout.width, layout.height, bytes.len() as u64)?;
    if let Compression::Other(_) = layout.compression {
        return Err(Fault::new(
            format!(
                "its compression is {}, which is not supported",
                layout.compression.name()
            ),
            "save it with LZW, deflate or JPEG",
        ));
    }
    let whole_numbers = matches!(layout.kind, NumberKind::Unsigned | NumberKind::Other(4));
    let photometric = match (layout.photometric, layout.samples) {
        _ if !whole_numbers || !matches!(layout.bits, 8 | 16) => return Ok(None),
        (0, 1..) => Photometric::WhiteIsZero,
        (1, 1..) => Photometric::BlackIsZero,
        (2, 3..) => Photometric::Rgb,
        (6, 3) if layout.bits == 8 && !layout.planar => Photometric::YCbCr,
        (6, _) => {
            return Err(Fault::new(
                "its YCbCr colours are not three interleaved bytes, which is not supported",
                "save it as RGB",
            ));
        }
        (3, _) => {
            return Err(Fault::new(
                "its pixels are numbers of a palette, which is not supported",
                "save it as RGB",
            ));
        }
        _ => return Ok(None),
    };
    if layout.compression == Compression::Jpeg && layout.samples_a_chunk() == 2 {
        return Err(Fault::new(
            "its JPEGs are of two colours (grey with transparency), which is not supported",
            "save it without the transparency",
        ));
    }
    let is_rgb = photometric == Photometric::Rgb || photometric == Photometric::YCbCr;
    let tags = file.tags();
    let icc = tags.get_tag_u8_vec(Tag::IccProfile).ok();
    let tables = tags.get_tag_u8_vec(Tag::JPEGTables).ok();
    let colors = YCbCr::of(&mut file);
    let mut photo = Photo {
        image: RgbImage::new(layout.width, layout.height),
        layout: &layout,
        photometric,
        colors,
    };
    let planes = match (layout.planar, is_rgb) {
        (false, _) | (true, false) => 1,
        (true, true) => 3,
    };
    let in_plane = layout.across() * layout.down();
    for plane in 0..planes {
        for index in plane * in_plane..(plane + 1) * in_plane {
            match layout.compression {
                Compression::Jpeg => {
                    let stored = file.stored(&layout, index)?.ok_or_else(|| missing(index))?;
                    photo.take_jpeg(index, plane, tables.as_deref(), &stored)?;
                }
                _ => {
                    let chunk = file.chunk(&layout, index)?.ok_or_else(|| missing(index))?;
                    photo.take(index, plane, &chunk);
                }
            }
        }
    }
    Ok(Some((photo.image, icc.filter(|_| is_rgb))))
}

fn missing(index: u32) -> Fault {
    Fault::new(
        format!("tile or strip {index} of the photo is not in the file"),
        "copy the photo again",
    )
}

struct Photo<'a> {
    image: RgbImage,
    layout: &'a Layout,
    photometric: Photometric,
    colors: YCbCr,
}

impl Photo<'_> {
    /// A tile or strip of numbers.
    fn take(&mut self, index: u32, plane: u32, chunk: &[u8]) {
        if let Some(sampling) = self.layout.subsampling {
            return self.take_blocks(index, sampling, chunk);
        }
        let samples = self.layout.samples_a_chunk();
        let bytes = usize::from(self.layout.bits / 8);
        let row_bytes = self.layout.chunk.0 as usize * samples * bytes;
        self.take_rows(index, plane, chunk, row_bytes, samples, bytes);
    }

    /// Rows of numbers of so many bytes, so many a pixel.
    fn take_rows(
        &mut self,
        index: u32,
        plane: u32,
        rows: &[u8],
        row_bytes: usize,
        samples: usize,
        bytes: usize,
    ) {
        let ((left, top), (width, height)) = self.layout.extent(index);
        let level = |sample: &[u8]| match sample {
            [low, high] => {
                // As `image` brings 16 bits to 8.
                let value = u32::from(u16::from_le_bytes([*low, *high]));
                ((value + 128) / 257) as u8
            }
            [level, ..] => *level,
            [] => 0,
        };
        for (row, y) in rows.chunks(row_bytes.max(1)).zip(top..top + height) {
            let pixels = row.chunks_exact(samples * bytes);
            for (pixel, x) in pixels.zip(left..left + width) {
                let mut levels = pixel.chunks_exact(bytes).map(level);
                let first = levels.next().unwrap_or_default();
                let target = &mut self.image.get_pixel_mut(x, y).0;
                match (self.photometric, samples) {
                    (Photometric::WhiteIsZero, _) => *target = [255 - first; 3],
                    (Photometric::BlackIsZero, _) => *target = [first; 3],
                    (_, 1 | 2) => target[plane.min(2) as usize] = first,
                    _ => {
                        let mut next = || levels.next().unwrap_or_default();
                        *target = [first, next(), next()];
                        if self.photometric == Photometric::YCbCr
                            && self.layout.compression != Compression::Jpeg
                        {
                            *target = self.colors.rgb(*target);
                        }
                    }
                }
            }
        }
    }

    /// Blocks of pixels that share a colour: their luminances row by row, Cb, Cr.
    fn take_blocks(&mut self, index: u32, (across, down): (u16, u16), chunk: &[u8]) {
        let ((left, top), (width, height)) = self.layout.extent(index);
        let (across, down) = (u32::from(across), u32::from(down));
        let in_block = (across * down) as usize;
        let in_row = self.layout.chunk.0.div_ceil(across);
        for (block, place) in chunk.chunks_exact(in_block + 2).zip(0_u32..) {
            let (column, row) = (place % in_row * across, place / in_row * down);
            let (luminances, shared) = block.split_at(in_block);
            for (luminance, at) in luminances.iter().zip(0_u32..) {
                let (x, y) = (column + at % across, row + at / across);
                if x < width && y < height {
                    let rgb = self.colors.rgb([*luminance, shared[0], shared[1]]);
                    self.image.get_pixel_mut(left + x, top + y).0 = rgb;
                }
            }
        }
    }

    fn take_jpeg(
        &mut self,
        index: u32,
        plane: u32,
        tables: Option<&[u8]>,
        stored: &[u8],
    ) -> Result<(), Fault> {
        let colors = match self.photometric {
            Photometric::YCbCr => Colors::ToRgb,
            _ => Colors::AsStored,
        };
        let in_chunk = |fault: Fault| {
            let what = format!("tile or strip {index}: {}", fault.what);
            Fault::new(what, fault.remedy)
        };
        let (width, height, samples, rows) =
            jpeg::decode_part(tables, stored, colors).map_err(in_chunk)?;
        let (_, (used_across, used_down)) = self.layout.extent(index);
        if width < used_across || height < used_down || samples != self.layout.samples_a_chunk() {
            return Err(in_chunk(Fault::new(
                format!("it is a JPEG of {width} x {height} with {samples} colours"),
                "copy the photo again",
            )));
        }
        self.take_rows(index, plane, &rows, width as usize * samples, samples, 1);
        Ok(())
    }
}

/// From luminance and two colour differences to red, green and blue.
struct YCbCr {
    /// The parts of red, green and blue in the luminance.
    parts: [f32; 3],
    /// Black (or no colour) and white (or the most colour) of the three.
    references: [(f32, f32); 3],
}

impl YCbCr {
    /// As the tags have it; the specification's defaults, with no colour at 128, where they do not.
    fn of<R: Read + Seek>(file: &mut TiffFile<R>) -> Self {
        let mut fractions = |tag| -> Option<Vec<f32>> {
            let tag = Tag::from_u16_exhaustive(tag);
            let Value::List(values) = file.tags().find_tag(tag).ok()?? else {
                return None;
            };
            let fraction = |value| match value {
                Value::Rational(above, below) if below > 0 => Some(above as f32 / below as f32),
                _ => None,
            };
            values.into_iter().map(fraction).collect()
        };
        let parts = match fractions(YCBCR_COEFFICIENTS).as_deref() {
            Some(&[red, green, blue]) if green > 0.0 => [red, green, blue],
            _ => [0.299, 0.587, 0.114],
        };
        let references = match fractions(REFERENCE_BLACK_WHITE).as_deref() {
            Some(&[a, b, c, d, e, f]) if a < b && c < d && e < f => [(a, b), (c, d), (e, f)],
            _ => [(0.0, 255.0), (128.0, 255.0), (128.0, 255.0)],
        };
        Self { parts, references }
    }

    fn rgb(&self, [y, cb, cr]: [u8; 3]) -> [u8; 3] {
        let [of_y, of_cb, of_cr] = self.references;
        let share = |level: u8, (from, to): (f32, f32)| (f32::from(level) - from) / (to - from);
        let y = 255.0 * share(y, of_y);
        let cb = 127.0 * share(cb, of_cb);
        let cr = 127.0 * share(cr, of_cr);
        let [red_part, green_part, blue_part] = self.parts;
        let red = y + cr * (2.0 - 2.0 * red_part);
        let blue = y + cb * (2.0 - 2.0 * blue_part);
        let green = (y - red_part * red - blue_part * blue) / green_part;
        // `as` saturates.
        [red, green, blue].map(|level| level.round() as u8)
    }
}
