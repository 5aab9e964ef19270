//! The size of an image file in pixels, from its header alone.

use std::io::{BufRead, Seek};

use image::ImageReader;

use crate::fault::Fault;

/// Width and height of a JPEG, PNG or TIFF as its pixels are stored (an EXIF orientation turns
/// nothing: packages calibrate the stored pixels).
///
/// # Errors
/// Where it is no image of these formats.
pub(super) fn read(input: impl BufRead + Seek) -> Result<(u32, u32), Fault> {
    let unreadable = |e: &dyn std::fmt::Display| {
        Fault::new(
            format!("it cannot be read as an image ({e})"),
            "give a JPEG, PNG or TIFF",
        )
    };
    ImageReader::new(input)
        .with_guessed_format()
        .map_err(|e| unreadable(&e))?
        .into_dimensions()
        .map_err(|e| unreadable(&e))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::{ImageFormat, RgbImage};

    use super::*;

    #[test]
    fn jpeg_png_and_tiff() {
        for format in [ImageFormat::Jpeg, ImageFormat::Png, ImageFormat::Tiff] {
            let mut bytes = Cursor::new(Vec::new());
            RgbImage::new(17, 5).write_to(&mut bytes, format).unwrap();
            assert_eq!(
                read(Cursor::new(bytes.into_inner())),
                Ok((17, 5)),
                "{format:?}"
            );
        }
        assert!(read(Cursor::new(b"no image")).is_err());
        assert!(read(Cursor::new(b"")).is_err());
    }
}
