//! A photo with the outlines of its fragments.

use image::{Rgb, RgbImage};

use crate::delineation::{FINES, LabelImage, NOT_ROCK};
use crate::fault::Fault;
use crate::files::marked_png;
use crate::picture::{PhotoFormat, encode};

/// Outlines of fragments, and of those that an edge cuts and that are not measured.
const WHOLE: [u8; 3] = [255, 220, 0];
// Not orange: in the window that is an engine that is not sure.
const CUT: [u8; 3] = [225, 130, 255];

/// A PNG of the undistorted photo: yellow outlines, a pixel wide and wider on large photos, violet where an edge
/// cuts the fragment; what is no rock is darkened.
///
/// # Errors
/// Where the picture cannot be encoded.
pub(super) fn outlines_png(
    photo: &RgbImage,
    labels: &LabelImage,
    is_cut: &[bool],
) -> Result<Vec<u8>, Fault> {
    let mut picture = photo.clone();
    // Of a large photo seen on a screen a line of one pixel would not be seen.
    let line = 1 + labels.width.max(labels.height) / 2000;
    let at = |x: usize, y: usize| {
        labels
            .labels
            .get(y * labels.width + x)
            .copied()
            .unwrap_or(NOT_ROCK)
    };
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        let (x, y) = (x as usize, y as usize);
        let here = at(x, y);
        if here == NOT_ROCK {
            *pixel = Rgb(pixel.0.map(|part| part / 3));
            continue;
        }
        if here == FINES {
            continue;
        }
        let differs = (1..=line).any(|by| {
            let beside = [
                (x.wrapping_sub(by), y),
                (x + by, y),
                (x, y.wrapping_sub(by)),
                (x, y + by),
            ];
            beside
                .iter()
                .any(|(x, y)| *x >= labels.width || *y >= labels.height || at(*x, *y) != here)
        });
        if differs {
            let is_cut = is_cut.get(here as usize - 1).copied().unwrap_or(false);
            *pixel = Rgb(if is_cut { CUT } else { WHOLE });
        }
    }
    Ok(marked_png(encode(
        &picture,
        PhotoFormat::Png,
        100,
        None,
        None,
    )?))
}
