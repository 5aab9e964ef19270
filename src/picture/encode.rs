//! Photos back to bytes, with the metadata that they came with.

use std::io::Cursor;

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::codecs::tiff::TiffEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbImage};

use super::decode::PhotoFormat;
use crate::fault::Fault;

/// The most that the one JPEG segment of EXIF holds, less its own header.
const MOST_EXIF: usize = 65_533 - 6;

/// The bytes of a file of `format`. `quality` is that of JPEG, 1 to 100; the others keep every pixel
/// value. EXIF goes into JPEG and PNG, not into TIFF.
///
/// # Errors
/// Where the format does not take such a size (JPEG ends at 65 535 a side) or such metadata.
pub fn encode(
    image: &RgbImage,
    format: PhotoFormat,
    quality: u8,
    exif: Option<&[u8]>,
    icc: Option<&[u8]>,
) -> Result<Vec<u8>, Fault> {
    let mut bytes = Cursor::new(Vec::new());
    let written = match format {
        PhotoFormat::Jpeg => {
            if exif.is_some_and(|exif| exif.len() > MOST_EXIF) {
                return Err(Fault::new(
                    "its EXIF is larger than a JPEG's 64 KiB",
                    "shorten it, maker notes first",
                ));
            }
            let encoder = JpegEncoder::new_with_quality(&mut bytes, quality.clamp(1, 100));
            write(encoder, image, exif, icc)
        }
        PhotoFormat::Png => write(PngEncoder::new(&mut bytes), image, exif, icc),
        PhotoFormat::Tiff => write(TiffEncoder::new(&mut bytes), image, None, icc),
    };
    written.map_err(|e| {
        Fault::new(
            format!("the picture cannot be encoded ({e})"),
            "make it smaller",
        )
    })?;
    Ok(bytes.into_inner())
}

fn write(
    mut encoder: impl ImageEncoder,
    image: &RgbImage,
    exif: Option<&[u8]>,
    icc: Option<&[u8]>,
) -> image::ImageResult<()> {
    if let Some(exif) = exif {
        encoder
            .set_exif_metadata(exif.to_vec())
            .map_err(image::ImageError::Unsupported)?;
    }
    if let Some(icc) = icc {
        encoder
            .set_icc_profile(icc.to_vec())
            .map_err(image::ImageError::Unsupported)?;
    }
    let (width, height) = image.dimensions();
    encoder.write_image(image, width, height, ExtendedColorType::Rgb8)
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;
    use crate::picture::decode_photo;

    fn photo() -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| Rgb([3 * x as u8, 4 * y as u8, 128]))
    }

    #[test]
    fn pixels_and_metadata_come_back() {
        // A little-endian TIFF header with no entry.
        let exif = b"II*\x00\x08\x00\x00\x00\x00\x00\x00\x00\x00\x00";
        // The encoders pass a profile on unread.
        let icc = vec![7_u8; 200];
        for format in [PhotoFormat::Jpeg, PhotoFormat::Png, PhotoFormat::Tiff] {
            let bytes = encode(&photo(), format, 97, Some(exif), Some(&icc)).unwrap();
            let back = decode_photo(&bytes).unwrap();
            assert_eq!(back.format, format);
            assert_eq!(back.icc.as_deref(), Some(&icc[..]), "{format:?}");
            let kept = back.exif.as_deref() == Some(exif);
            assert_eq!(kept, format != PhotoFormat::Tiff, "{format:?}");
            let off = back
                .image
                .iter()
                .zip(photo().iter())
                .map(|(a, b)| a.abs_diff(*b))
                .max();
            let most = if format == PhotoFormat::Jpeg { 6 } else { 0 };
            assert!(off.unwrap() <= most, "{format:?}: {off:?}");
        }
    }

    #[test]
    fn what_a_jpeg_cannot_hold_is_said() {
        let exif = vec![0; 70_000];
        let fault = encode(&photo(), PhotoFormat::Jpeg, 97, Some(&exif), None).unwrap_err();
        assert!(fault.what.contains("64 KiB"), "{fault}");
        let long = RgbImage::new(70_000, 1);
        assert!(encode(&long, PhotoFormat::Jpeg, 97, None, None).is_err());
    }
}
