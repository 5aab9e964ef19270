//! Outlines of a photo that viewers turn or mirror by its EXIF mark. Programs in which people outline heed that mark or do not; the
//! flight's photos are as their pixels are stored.

use crate::labels::LabelImage;

/// Whether viewers show a photo with that mark (EXIF's Orientation, 1 to 8) with its sides swapped.
pub(super) fn is_on_its_side(shown: u32) -> bool {
    (5..=8).contains(&shown)
}

/// What viewers do to such a photo, in words.
pub(super) fn in_words(shown: u32) -> &'static str {
    match shown {
        2 | 4 | 5 | 7 => "mirror",
        3 => "turn upside down",
        _ => "turn by 90 degrees",
    }
}

/// The labels of a photo as viewers show it, as its pixels are stored (TIFF 6.0, Orientation: which sides of the picture row 0 and
/// column 0 are).
pub(super) fn as_stored(labels: &LabelImage, shown: u32) -> LabelImage {
    let (across, down) = (labels.width, labels.height);
    let (width, height) = match is_on_its_side(shown) {
        true => (down, across),
        false => (across, down),
    };
    // Where a stored pixel is shown.
    let place = |x: usize, y: usize| match shown {
        2 => (width - 1 - x, y),
        3 => (width - 1 - x, height - 1 - y),
        4 => (x, height - 1 - y),
        5 => (y, x),
        6 => (height - 1 - y, x),
        7 => (height - 1 - y, width - 1 - x),
        8 => (y, width - 1 - x),
        _ => (x, y),
    };
    let mut stored = Vec::with_capacity(labels.labels.len());
    for y in 0..height {
        for x in 0..width {
            let (column, row) = place(x, y);
            stored.push(labels.labels[row * across + column]);
        }
    }
    LabelImage {
        width,
        height,
        labels: stored,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the `image` package's own turning of pictures.
    #[test]
    fn each_mark_is_taken_back() {
        let stored = image::RgbImage::from_fn(3, 2, |x, y| image::Rgb([(x + 3 * y) as u8, 0, 0]));
        for shown in 1..=8_u8 {
            let mut turned = image::DynamicImage::ImageRgb8(stored.clone());
            turned.apply_orientation(image::metadata::Orientation::from_exif(shown).unwrap());
            let turned = turned.into_rgb8();
            let labels = LabelImage {
                width: turned.width() as usize,
                height: turned.height() as usize,
                labels: turned.pixels().map(|pixel| u32::from(pixel.0[0])).collect(),
            };
            let found = as_stored(&labels, u32::from(shown));
            assert_eq!((found.width, found.height), (3, 2), "{shown}");
            assert_eq!(found.labels, [0, 1, 2, 3, 4, 5], "{shown}");
        }
    }
}
