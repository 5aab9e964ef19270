//! The size of an image file in pixels, from its header alone.

use std::io::{BufRead, Seek, SeekFrom};

use image::{ImageFormat, ImageReader};

use crate::fault::Fault;
use crate::raster::TiffFile;

/// Width and height of a JPEG, PNG or TIFF as its pixels are stored (an EXIF orientation turns
/// nothing: packages calibrate the stored pixels).
///
/// # Errors
/// Where it is no image of these formats.
pub(crate) fn read(input: impl BufRead + Seek) -> Result<(u32, u32), Fault> {
    let unreadable = |e: &dyn std::fmt::Display| {
        Fault::new(
            format!("it cannot be read as an image ({e})"),
            "give a JPEG, PNG or TIFF",
        )
    };
    let mut input = input;
    if input.fill_buf().is_ok_and(<[u8]>::is_empty) {
        return Err(Fault::new("it is empty", "copy it from the drone again"));
    }
    let reader = ImageReader::new(input)
        .with_guessed_format()
        .map_err(|e| unreadable(&e))?;
    if reader.format() == Some(ImageFormat::Tiff) {
        // The same image of the file as is decoded later.
        let mut input = reader.into_inner();
        let size = input.seek(SeekFrom::End(0)).map_err(|e| unreadable(&e))?;
        input.rewind().map_err(|e| unreadable(&e))?;
        return TiffFile::open(input, size)?.size();
    }
    reader.into_dimensions().map_err(|e| unreadable(&e))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use image::RgbImage;

    use super::*;
    use fragscale_test_data::shared_data;

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

    #[test]
    fn colours_that_cannot_be_shown_have_a_size() {
        let Some(path) = shared_data("orthority-ngi-opk/3324c_2015_1004_05_0182_RGB.tif") else {
            return;
        };
        let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
        assert_eq!(read(file), Ok((640, 1152)));
    }
}
