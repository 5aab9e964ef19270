//! Label images: PNG (ISO/IEC 15948) with one channel of 16 bits, pixel (0, 0) at the top left.

use std::io::Cursor;

use image::{ImageBuffer, ImageFormat, Luma};

use crate::delineation::LabelImage;
use crate::fault::Fault;
use crate::files::marked_png;

/// A gray PNG of 16 bits a pixel; the labels row by row from the top left.
///
/// # Errors
/// Where the labels are not width * height, or there are none.
pub fn label_png(width: u32, height: u32, labels: &[u16]) -> Result<Vec<u8>, String> {
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 || labels.len() as u64 != pixels {
        let count = labels.len();
        return Err(format!("{count} labels for an image of {width} x {height}"));
    }
    let failed = || "the label image cannot be written".to_owned();
    let image: ImageBuffer<Luma<u16>, _> =
        ImageBuffer::from_raw(width, height, labels.to_vec()).ok_or_else(failed)?;
    let mut bytes = Cursor::new(Vec::new());
    image
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|error| format!("{} ({error})", failed()))?;
    Ok(bytes.into_inner())
}

/// A label image as a file: 0 is fines, 65 535 what is no rock, else the fragment's number.
///
/// # Errors
/// More than 65 534 fragments.
pub fn labels_png(labels: &LabelImage) -> Result<Vec<u8>, Fault> {
    let fragments = labels.fragments();
    if fragments >= usize::from(u16::MAX) {
        let what = format!("{fragments} fragments, and a label image holds 65534");
        return Err(Fault::new(what, "take a part of the photo"));
    }
    // Those that are no fragments' are beyond them.
    let numbers = labels.labels.iter();
    let numbers: Vec<u16> = numbers
        .map(|label| u16::try_from(*label).unwrap_or(u16::MAX))
        .collect();
    let (width, height) = (labels.width as u32, labels.height as u32);
    let bytes = label_png(width, height, &numbers);
    let bytes = bytes.map_err(|error| Fault::new(error, "report this"))?;
    Ok(marked_png(bytes))
}

#[cfg(test)]
mod tests {
    use image::DynamicImage;

    use super::*;

    #[test]
    fn decodes_to_the_same_labels() {
        let labels: Vec<u16> = (0..77 * 3).map(|i| (i * 1021 % 65_536) as u16).collect();
        let bytes = label_png(77, 3, &labels).unwrap();
        assert_eq!(label_png(77, 3, &labels).unwrap(), bytes);
        // ISO/IEC 15948, 11.2.2: width, height, 16 bits, colour type 0 (gray).
        assert_eq!(bytes[16..26], [0, 0, 0, 77, 0, 0, 0, 3, 16, 0]);
        let DynamicImage::ImageLuma16(image) = image::load_from_memory(&bytes).unwrap() else {
            panic!("16-bit gray");
        };
        assert_eq!(image.into_raw(), labels);
    }

    #[test]
    fn other_counts_are_refused() {
        assert!(label_png(2, 2, &[1; 3]).is_err());
        assert!(label_png(2, 2, &[1; 5]).is_err());
        assert!(label_png(0, 0, &[]).is_err());
        assert!(label_png(u32::MAX, u32::MAX, &[1]).is_err());
    }
}
