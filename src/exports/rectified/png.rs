//! PNG with what the encoder has no words for: the size of a pixel and a description.

use std::io::Cursor;

use flate2::Crc;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbaImage};

use crate::fault::Fault;
use crate::files::marked_png;
use crate::tiff_pages::ascii;

/// Where the first chunk of a PNG ends: the signature, and IHDR, which always comes first.
const HEAD: usize = 8 + 25;

/// The file of a picture; `resolution` is a fraction of pixels per centimetre.
pub(super) fn bytes(
    picture: &RgbaImage,
    description: &str,
    resolution: Option<[u32; 2]>,
) -> Result<Vec<u8>, Fault> {
    let mut bytes = Cursor::new(Vec::new());
    let (width, height) = picture.dimensions();
    let mut encoder = PngEncoder::new(&mut bytes);
    let not_encoded = |error: &dyn std::fmt::Display| {
        let what = format!("the picture cannot be encoded ({error})");
        Fault::new(what, "make it smaller")
    };
    if let Some(resolution) = resolution {
        let exif = encoder.set_exif_metadata(exif(resolution));
        exif.map_err(|error| not_encoded(&error))?;
    }
    let written = encoder.write_image(picture, width, height, ExtendedColorType::Rgba8);
    written.map_err(|error| not_encoded(&error))?;
    let mut bytes = bytes.into_inner();
    let mut chunks = chunk(
        b"tEXt",
        format!("Description\0{}", ascii(description)).as_bytes(),
    );
    if let Some([n, d]) = resolution {
        // Whole pixels per metre; what is finer is in the EXIF. `as` saturates.
        let per_metre = (f64::from(n) / f64::from(d) * 100.0).round() as u32;
        let mut data = [per_metre.to_be_bytes(), per_metre.to_be_bytes()].concat();
        // 1: the unit is the metre.
        data.push(1);
        chunks.extend(chunk(b"pHYs", &data));
    }
    let head = HEAD.min(bytes.len());
    bytes.splice(head..head, chunks);
    Ok(marked_png(bytes))
}

/// Length, type, data, CRC (PNG specification, section 5.3).
fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [&kind[..], data].concat();
    let mut crc = Crc::new();
    crc.update(&body);
    // Descriptions are short.
    let length = u32::try_from(data.len()).unwrap_or(0);
    [&length.to_be_bytes()[..], &body, &crc.sum().to_be_bytes()].concat()
}

/// An EXIF block (a little-endian TIFF header with one directory) of XResolution, YResolution and
/// ResolutionUnit: 3 is the centimetre.
fn exif([n, d]: [u32; 2]) -> Vec<u8> {
    const RATIONAL: u16 = 5;
    const SHORT: u16 = 3;
    // Behind the header, the count, three entries and the offset of no other directory.
    let value = 8 + 2 + 3 * 12 + 4_u32;
    let mut bytes = b"II*\0\x08\0\0\0\x03\0".to_vec();
    for (tag, kind, content) in [
        (0x11a_u16, RATIONAL, value),
        (0x11b, RATIONAL, value),
        (0x128, SHORT, 3),
    ] {
        bytes.extend(tag.to_le_bytes());
        bytes.extend(kind.to_le_bytes());
        bytes.extend(1_u32.to_le_bytes());
        bytes.extend(content.to_le_bytes());
    }
    bytes.extend(0_u32.to_le_bytes());
    bytes.extend(n.to_le_bytes());
    bytes.extend(d.to_le_bytes());
    bytes
}
