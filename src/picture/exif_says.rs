//! What a photo's EXIF says of its pixels: how they are to be turned (Exif 2.32: Orientation), and the size that it says they
//! have, against the size that they have (PixelXDimension and PixelYDimension; `ImageWidth` and `ImageLength`, which phones write
//! in their place).
//!
//! Cameras write the size of the pixels. Where the two differ the photo was saved again by a program
//! that left the EXIF as it was: made smaller, turned, or cropped. Then the camera's numbers may be for
//! another picture, and no file can tell: the caller says so.

use std::io::Cursor;

use exif::{Exif, In, Reader, Tag};

/// What the EXIF says, where the pixels are of another size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeInExif {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Whether the picture is the same, made larger or smaller: of the same shape within a pixel.
    pub same_shape: bool,
    /// Whether it is the same turned by a quarter.
    pub turned: bool,
}

/// Compares the EXIF of a photo's file with the size of its pixels. `None` where both are the same or
/// the file does not say.
pub fn size_in_exif(file: &[u8], (width, height): (u32, u32)) -> Option<SizeInExif> {
    let exif = exif_of(file)?;
    let number = |tag| exif.get_field(tag, In::PRIMARY)?.value.get_uint(0);
    let pair = |across, down| Some((number(across)?, number(down)?));
    let said = pair(Tag::PixelXDimension, Tag::PixelYDimension)
        .or_else(|| pair(Tag::ImageWidth, Tag::ImageLength))
        .filter(|&(across, down)| across > 0 && down > 0)?;
    (said != (width, height)).then(|| SizeInExif {
        width: said.0,
        height: said.1,
        same_shape: is_same_shape(said, (width, height)),
        turned: is_same_shape((said.1, said.0), (width, height)),
    })
}

/// The mark of how a photo is to be turned or mirrored to be looked at (EXIF's Orientation, 2 to 8); `None` where it is to be shown
/// as its pixels lie.
pub fn turned_in_exif(file: &[u8]) -> Option<u32> {
    let orientation = exif_of(file)?
        .get_field(Tag::Orientation, In::PRIMARY)?
        .value
        .get_uint(0)?;
    (2..=8).contains(&orientation).then_some(orientation)
}

fn exif_of(file: &[u8]) -> Option<Exif> {
    let read = Reader::new()
        .continue_on_error(true)
        .read_from_container(&mut Cursor::new(file));
    read.or_else(|error| error.distill_partial_result(|_| {}))
        .ok()
}

/// Whether one is the other made larger, within a pixel of the smaller.
fn is_same_shape(one: (u32, u32), other: (u32, u32)) -> bool {
    let (small, large) = if one.0 < other.0 {
        (one, other)
    } else {
        (other, one)
    };
    let down = f64::from(large.1) * f64::from(small.0) / f64::from(large.0);
    let across = f64::from(large.0) * f64::from(small.1) / f64::from(large.1);
    (down - f64::from(small.1)).abs() <= 1.0 || (across - f64::from(small.0)).abs() <= 1.0
}

#[cfg(test)]
mod tests {
    use exif::experimental::Writer;
    use exif::{Field, Value};
    use image::RgbImage;

    use super::*;
    use crate::picture::{PhotoFormat, encode};

    /// A photo of 64 x 48 whose EXIF says another size.
    fn photo(said: (u32, u32), tags: (Tag, Tag)) -> Vec<u8> {
        let field = |tag, value| Field {
            tag,
            ifd_num: In::PRIMARY,
            value: Value::Long(vec![value]),
        };
        let fields = [field(tags.0, said.0), field(tags.1, said.1)];
        let mut writer = Writer::new();
        fields.iter().for_each(|field| writer.push_field(field));
        let mut exif = Cursor::new(Vec::new());
        writer.write(&mut exif, false).unwrap();
        let exif = exif.into_inner();
        encode(
            &RgbImage::new(64, 48),
            PhotoFormat::Jpeg,
            90,
            Some(&exif),
            None,
        )
        .unwrap()
    }

    #[test]
    fn what_exif_says_of_the_size() {
        let of_pixels = (Tag::PixelXDimension, Tag::PixelYDimension);
        let said = |size, tags| size_in_exif(&photo(size, tags), (64, 48));
        assert_eq!(said((64, 48), of_pixels), None);
        assert_eq!(said((0, 0), of_pixels), None);
        let smaller = said((4000, 3000), of_pixels).unwrap();
        assert!(smaller.same_shape && !smaller.turned);
        let cut = said((64, 96), of_pixels).unwrap();
        assert_eq!((cut.width, cut.height), (64, 96));
        assert!(!cut.same_shape && !cut.turned);
        assert!(said((48, 64), of_pixels).unwrap().turned);
        let phone = said((3072, 1728), (Tag::ImageWidth, Tag::ImageLength));
        assert!(!phone.unwrap().same_shape);
        assert_eq!(size_in_exif(b"no photo", (64, 48)), None);
    }

    #[test]
    fn what_exif_says_of_turning() {
        let of = |orientation| {
            let tags = (Tag::Orientation, Tag::PixelYDimension);
            turned_in_exif(&photo((orientation, 48), tags))
        };
        assert_eq!(
            [0, 1, 3, 6, 8, 9].map(of),
            [None, None, Some(3), Some(6), Some(8), None]
        );
        assert_eq!(turned_in_exif(b"no photo"), None);
    }

    #[test]
    fn shapes_are_equal_within_a_pixel() {
        assert!(is_same_shape((4000, 3000), (1333, 1000)));
        assert!(is_same_shape((4032, 3024), (1280, 960)));
        assert!(!is_same_shape((4000, 3000), (4000, 2250)));
        assert!(!is_same_shape((4000, 3000), (4000, 2990)));
    }
}
