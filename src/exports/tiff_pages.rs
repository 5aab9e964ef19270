//! TIFF files of one or several pages, with the tags that say what the pixels mean. Plain enough for
//! every program that reads TIFF: strips, no tiles, no predictor, no BigTIFF. Colours and labels are deflated, on
//! all cores; values are not, because deflated without a predictor those of a real pile grow by 5 %, and
//! the predictor for floats is one that ImageJ does not know.

use std::borrow::Cow;
use std::io::{self, Cursor, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use tiff::encoder::{DirectoryEncoder, Rational, TiffEncoder, TiffKindStandard};
use tiff::tags::{
    CompressionMethod, ExtraSamples, PhotometricInterpretation, ResolutionUnit, SampleFormat, Tag,
};
use tiff::{TiffError, TiffResult};

use crate::fault::Fault;

/// What lies in a file as one, in bytes.
const STRIP: usize = 1 << 18;

/// Who wrote it.
pub(crate) const PROGRAM: &str = concat!("fragscale ", env!("CARGO_PKG_VERSION"));

/// What is in the pixels, row by row.
#[derive(Debug, Clone)]
pub(crate) enum Pixels<'a> {
    /// One number each; NaN where there is none.
    Values(Cow<'a, [f32]>),
    /// A whole number each.
    Numbers(Cow<'a, [u32]>),
    /// Red, green, blue, opacity (not premultiplied).
    Colors(Cow<'a, [u8]>),
}

/// One page.
#[derive(Debug, Clone)]
pub(crate) struct Page<'a> {
    /// In pixels.
    pub(crate) width: u32,
    /// In pixels.
    pub(crate) height: u32,
    /// As many as that.
    pub(crate) pixels: Pixels<'a>,
    /// JSON.
    pub(crate) description: String,
    /// Pixels per centimetre, as a fraction.
    pub(crate) resolution: Option<[u32; 2]>,
    /// Where it lies on the map.
    pub(crate) georeference: Option<GeoTags>,
}

/// The tags of GeoTIFF (OGC 19-008r4, 7.1 and 7.2).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GeoTags {
    /// The sides of a pixel in x, y and z.
    pub(crate) pixel_scale: [f64; 3],
    /// Column, row and 0 of a place of the picture, and its x, y and z.
    pub(crate) tie_point: [f64; 6],
    /// The directory of keys.
    pub(crate) keys: Vec<u16>,
    /// The texts of keys.
    pub(crate) texts: String,
}

/// The bytes of a file of these pages, which are made one after the other.
///
/// # Errors
/// What the pages say, and where the file would be larger than a TIFF can be.
pub(crate) fn tiff_of<'a>(
    pages: impl Iterator<Item = Result<Page<'a>, Fault>>,
) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let mut encoder = TiffEncoder::new(Cursor::new(&mut bytes)).map_err(not_encoded)?;
    for page in pages {
        let page = page?;
        let directory = encoder.image_directory().map_err(not_encoded)?;
        write(directory, &page).map_err(not_encoded)?;
    }
    Ok(bytes)
}

fn not_encoded(error: TiffError) -> Fault {
    let what = format!("the TIFF cannot be encoded ({error})");
    Fault::new(what, "make it smaller, or ask for fewer layers")
}

fn write<W: Write + io::Seek>(
    mut directory: DirectoryEncoder<'_, W, TiffKindStandard>,
    page: &Page<'_>,
) -> TiffResult<()> {
    // First in the file: by it the file is known as ours (`files::marks`).
    directory.write_tag(Tag::Software, PROGRAM)?;
    let description = ascii(&page.description);
    directory.write_tag(Tag::ImageDescription, description.as_str())?;
    directory.write_tag(Tag::ImageWidth, page.width)?;
    directory.write_tag(Tag::ImageLength, page.height)?;
    if let Some([n, d]) = page.resolution {
        for tag in [Tag::XResolution, Tag::YResolution] {
            directory.write_tag(tag, Rational { n, d })?;
        }
        directory.write_tag(Tag::ResolutionUnit, ResolutionUnit::Centimeter)?;
    }
    let row = match &page.pixels {
        Pixels::Values(_) => {
            directory.write_tag(Tag::Compression, CompressionMethod::None)?;
            directory.write_tag(Tag::BitsPerSample, 32_u16)?;
            directory.write_tag(Tag::SamplesPerPixel, 1_u16)?;
            directory.write_tag(Tag::SampleFormat, &[SampleFormat::IEEEFP][..])?;
            let grey = PhotometricInterpretation::BlackIsZero;
            directory.write_tag(Tag::PhotometricInterpretation, grey)?;
            directory.write_tag(Tag::GdalNodata, "nan")?;
            page.width as usize
        }
        Pixels::Numbers(_) => {
            directory.write_tag(Tag::Compression, CompressionMethod::Deflate)?;
            directory.write_tag(Tag::BitsPerSample, 32_u16)?;
            directory.write_tag(Tag::SamplesPerPixel, 1_u16)?;
            directory.write_tag(Tag::SampleFormat, &[SampleFormat::Uint][..])?;
            let grey = PhotometricInterpretation::BlackIsZero;
            directory.write_tag(Tag::PhotometricInterpretation, grey)?;
            page.width as usize
        }
        Pixels::Colors(_) => {
            directory.write_tag(Tag::Compression, CompressionMethod::Deflate)?;
            directory.write_tag(Tag::BitsPerSample, &[8_u16; 4][..])?;
            directory.write_tag(Tag::SamplesPerPixel, 4_u16)?;
            directory.write_tag(Tag::SampleFormat, &[SampleFormat::Uint; 4][..])?;
            let rgb = PhotometricInterpretation::RGB;
            directory.write_tag(Tag::PhotometricInterpretation, rgb)?;
            let opacity = [ExtraSamples::UnassociatedAlpha];
            directory.write_tag(Tag::ExtraSamples, &opacity[..])?;
            page.width as usize * 4
        }
    };
    let rows;
    let mut offsets = Vec::new();
    let mut counts = Vec::new();
    match &page.pixels {
        Pixels::Values(values) => {
            rows = (STRIP / 4 / row.max(1)).max(1);
            for strip in values.chunks((row * rows).max(1)) {
                offsets.push(u32::try_from(directory.write_data(strip)?)?);
                counts.push(u32::try_from(strip.len() * 4)?);
            }
        }
        Pixels::Numbers(numbers) => {
            rows = (STRIP / 4 / row.max(1)).max(1);
            let strips = numbers.par_chunks((row * rows).max(1)).map(|strip| {
                // In the byte order of the encoder, which is the machine's.
                let bytes: Vec<u8> = strip
                    .iter()
                    .flat_map(|number| number.to_ne_bytes())
                    .collect();
                deflated(&bytes)
            });
            for strip in strips.collect::<io::Result<Vec<_>>>()? {
                offsets.push(u32::try_from(directory.write_data(&strip[..])?)?);
                counts.push(u32::try_from(strip.len())?);
            }
        }
        Pixels::Colors(colors) => {
            rows = (STRIP / row.max(1)).max(1);
            let strips = colors.par_chunks((row * rows).max(1)).map(deflated);
            for strip in strips.collect::<io::Result<Vec<_>>>()? {
                offsets.push(u32::try_from(directory.write_data(&strip[..])?)?);
                counts.push(u32::try_from(strip.len())?);
            }
        }
    }
    directory.write_tag(Tag::RowsPerStrip, u32::try_from(rows)?)?;
    directory.write_tag(Tag::StripOffsets, &offsets[..])?;
    directory.write_tag(Tag::StripByteCounts, &counts[..])?;
    if let Some(geo) = &page.georeference {
        directory.write_tag(Tag::ModelPixelScaleTag, &geo.pixel_scale[..])?;
        directory.write_tag(Tag::ModelTiepointTag, &geo.tie_point[..])?;
        directory.write_tag(Tag::GeoKeyDirectoryTag, &geo.keys[..])?;
        if !geo.texts.is_empty() {
            directory.write_tag(Tag::GeoAsciiParamsTag, geo.texts.as_str())?;
        }
    }
    directory.finish()
}

fn deflated(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes)?;
    encoder.finish()
}

/// TIFF's texts are ASCII: what is not, as JSON escapes it.
pub(crate) fn ascii(text: &str) -> String {
    let mut ascii = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii() && c != '\0' {
            ascii.push(c);
        } else {
            for unit in c.encode_utf16(&mut [0; 2]) {
                ascii += &format!("\\u{unit:04x}");
            }
        }
    }
    ascii
}

/// The fraction nearest to a positive number, with as small terms as make it good to the last digits
/// of an f64 or to what 32 bits hold; `None` for a number that has none.
pub(crate) fn fraction(number: f64) -> Option<[u32; 2]> {
    if !(1e-9..=4e9).contains(&number) {
        return None;
    }
    // Convergents of its continued fraction.
    let (mut before, mut last) = ([0.0, 1.0], [1.0, 0.0]);
    let mut rest = number;
    for _ in 0..40 {
        let whole = rest.floor();
        let next: [f64; 2] = std::array::from_fn(|i| whole * last[i] + before[i]);
        if next.iter().any(|term| *term > f64::from(u32::MAX)) {
            break;
        }
        (before, last) = (last, next);
        let off = (last[0] / last[1] / number - 1.0).abs();
        if off < 1e-14 || rest == whole {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    // Whole numbers within 32 bits.
    (last[0] >= 1.0).then(|| last.map(|term| term as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_those_of_arithmetic() {
        for (number, known) in [
            (5.0, [5, 1]),
            (10.0 / 3.0, [10, 3]),
            (1.0 / 0.002, [500, 1]),
            (0.05, [1, 20]),
            (1.0 / 30.48, [25, 762]),
            (355.0 / 113.0, [355, 113]),
        ] {
            assert_eq!(fraction(number), Some(known), "{number}");
        }
        let [n, d] = fraction(std::f64::consts::PI).unwrap();
        assert!((f64::from(n) / f64::from(d) - std::f64::consts::PI).abs() < 1e-13);
        for nothing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(fraction(nothing), None);
        }
    }

    #[test]
    fn what_is_not_ascii_is_escaped_as_in_json() {
        let text = serde_json::to_string("µm é 岩 😀").unwrap();
        let escaped = ascii(&text);
        assert!(escaped.is_ascii());
        assert_eq!(
            serde_json::from_str::<String>(&escaped).unwrap(),
            "µm é 岩 😀"
        );
    }
}
