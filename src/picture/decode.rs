//! Photos from the bytes of their files.

use std::io::Cursor;

use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits, RgbImage};

use super::image_size::check_size;
use super::jpeg::{self, Jpeg};
use super::tiff_photo;
use crate::fault::Fault;

/// What a decoder may allocate, the picture included: 16-bit RGBA at the most pixels is not meant.
const MOST_BYTES: u64 = 2 << 30;

/// The file formats of photos.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhotoFormat {
    /// JPEG.
    Jpeg,
    /// PNG.
    Png,
    /// TIFF.
    Tiff,
}

/// A photo with what its file says beside the pixels.
#[derive(Debug, Clone)]
pub struct DecodedPhoto {
    /// 8-bit RGB, in the stored pixel order. Grey becomes RGB, 16 bits become 8, transparency is
    /// dropped.
    pub image: RgbImage,
    /// Of the file.
    pub format: PhotoFormat,
    /// The EXIF block as the file holds it (it begins with a TIFF header). Of TIFF files, whose EXIF
    /// is spread over the file, there is none.
    pub exif: Option<Vec<u8>>,
    /// The ICC colour profile, where it is one for RGB.
    pub icc: Option<Vec<u8>>,
}

/// The pixels of a JPEG, PNG or TIFF.
///
/// # Errors
/// As [`decode_photo`].
pub fn decode(bytes: &[u8]) -> Result<RgbImage, Fault> {
    decode_photo(bytes).map(|photo| photo.image)
}

/// A JPEG, PNG or TIFF with its metadata. The pixels stay as they are stored: the EXIF orientation
/// is NOT applied, because poses and calibrations are for the stored pixels.
///
/// # Errors
/// Where it is none of these, damaged or cut off, or claims to be larger than photos are. A JPEG whose
/// data are damaged in the middle is refused whole, because no one knows which of its pixels are right.
pub fn decode_photo(bytes: &[u8]) -> Result<DecodedPhoto, Fault> {
    let format = match image::guess_format(bytes) {
        Ok(ImageFormat::Jpeg) => PhotoFormat::Jpeg,
        Ok(ImageFormat::Png) => PhotoFormat::Png,
        Ok(ImageFormat::Tiff) => PhotoFormat::Tiff,
        _ if bytes.starts_with(b"II+\0") || bytes.starts_with(b"MM\0+") => PhotoFormat::Tiff,
        _ => return Err(unreadable(&"no JPEG, PNG or TIFF")),
    };
    match format {
        PhotoFormat::Jpeg => {
            let Jpeg { image, exif, icc } = jpeg::decode(bytes)?;
            return Ok(DecodedPhoto {
                image,
                format,
                exif,
                icc,
            });
        }
        PhotoFormat::Tiff => {
            if let Some((image, icc)) = tiff_photo::decode(bytes)? {
                return Ok(DecodedPhoto {
                    image,
                    format,
                    exif: None,
                    icc,
                });
            }
        }
        PhotoFormat::Png => {}
    }
    decode_by_image(bytes, format)
}

/// PNG, and the rarer kinds of TIFF. (PNG's checksums are judged; TIFF has none.)
fn decode_by_image(bytes: &[u8], format: PhotoFormat) -> Result<DecodedPhoto, Fault> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| unreadable(&e))?;
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(|e| unreadable(&e))?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, bytes.len() as u64)?;
    // Metadata that cannot be read is no reason to refuse the pixels.
    let exif = decoder.exif_metadata().ok().flatten();
    let is_rgb = matches!(
        decoder.color_type(),
        ColorType::Rgb8 | ColorType::Rgba8 | ColorType::Rgb16 | ColorType::Rgba16
    );
    let icc = decoder.icc_profile().ok().flatten().filter(|_| is_rgb);
    let image = DynamicImage::from_decoder(decoder).map_err(|e| unreadable(&e))?;
    Ok(DecodedPhoto {
        image: image.into_rgb8(),
        format,
        exif,
        icc,
    })
}

fn unreadable(error: &dyn std::fmt::Display) -> Fault {
    Fault::new(
        format!("it cannot be read as an image ({error})"),
        "give a whole JPEG, PNG or TIFF",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PNG header of 19 999 x 19 999 pixels in front of nothing: refused by what it claims.
    #[test]
    fn a_lying_header_takes_no_memory() {
        let mut png = bytes(&DynamicImage::new_rgb8(1, 1), ImageFormat::Png);
        png[16..20].copy_from_slice(&19_999_u32.to_be_bytes());
        png[20..24].copy_from_slice(&19_999_u32.to_be_bytes());
        // The header's checksum is then wrong, too; mend it so that the size is what is judged.
        let checksum = crc32(&png[12..29]);
        png[29..33].copy_from_slice(&checksum.to_be_bytes());
        let fault = decode(&png).unwrap_err();
        assert!(
            fault.what.contains("19999 x 19999, far too much"),
            "{fault}"
        );
    }

    fn bytes(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn the_three_formats() {
        let image = RgbImage::from_fn(16, 9, |x, y| image::Rgb([x as u8 * 8, y as u8 * 20, 90]));
        let image = DynamicImage::from(image);
        for format in [ImageFormat::Png, ImageFormat::Tiff] {
            assert_eq!(decode(&bytes(&image, format)).unwrap(), image.to_rgb8());
        }
        let jpeg = decode_photo(&bytes(&image, ImageFormat::Jpeg)).unwrap();
        assert_eq!(jpeg.format, PhotoFormat::Jpeg);
        assert_eq!(jpeg.image.dimensions(), (16, 9));
        let grey = decode(&bytes(&image.grayscale(), ImageFormat::Png)).unwrap();
        assert_eq!(grey.get_pixel(3, 3)[0], grey.get_pixel(3, 3)[2]);
    }

    #[test]
    fn what_is_no_photo_is_said() {
        for junk in [
            &b""[..],
            b"no image",
            b"GIF89a\x01\x00\x01\x00",
            b"\xff\xd8\xff",
        ] {
            let fault = decode(junk).unwrap_err();
            assert!(fault.remedy.contains("JPEG"), "{fault}");
        }
    }

    #[test]
    fn a_cut_photo_is_refused() {
        let image = RgbImage::from_fn(64, 64, |x, y| image::Rgb([(x * y) as u8, x as u8, y as u8]));
        for format in [ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::Tiff] {
            let whole = bytes(&DynamicImage::from(image.clone()), format);
            assert!(decode(&whole).is_ok());
            assert!(decode(&whole[..whole.len() / 2]).is_err(), "{format:?}");
        }
    }

    /// PNG specification, annex D.
    fn crc32(bytes: &[u8]) -> u32 {
        let mut crc = u32::MAX;
        for byte in bytes {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = if crc & 1 == 1 {
                    (crc >> 1) ^ 0xedb8_8320
                } else {
                    crc >> 1
                };
            }
        }
        !crc
    }
}
