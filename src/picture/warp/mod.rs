//! A photo brought into another shape, place by place.

mod bar;
mod cell;

use glam::DVec2;
use image::{RgbImage, RgbaImage};
use rayon::prelude::*;

pub use bar::bar_below;

pub(super) use cell::{CELL, Cell, bilinear};

use super::resample::cubic;

/// Pixels of the photo across one of the picture that are looked at one by one; of more, so many.
const MOST_LOOKS: f64 = 16.0;

/// Where a picture shows nothing: white to programs that know no opacity.
const NOTHING: [u8; 4] = [255, 255, 255, 0];

/// A picture of `columns` x `rows` pixels whose every place comes from the place of the photo that
/// `source` names, both with (0, 0) at the outer corner of the first pixel. What covers several pixels of
/// the photo is their mean. Where `source` names none, or one outside, the picture is transparent.
///
/// With `smooth`, where `source` is, it is asked at the corners of small cells only, and trusted between
/// them to 0.02 pixels.
pub fn warped(
    photo: &RgbImage,
    [columns, rows]: [u32; 2],
    smooth: bool,
    source: impl Fn(DVec2) -> Option<DVec2> + Sync,
) -> RgbaImage {
    let mut out = RgbaImage::new(columns, rows);
    if photo.is_empty() || out.is_empty() {
        return out;
    }
    let size = DVec2::new(f64::from(photo.width()), f64::from(photo.height()));
    let shows = |place: &DVec2| place.cmpge(DVec2::ZERO).all() && place.cmple(size).all();
    let bytes_a_band = columns as usize * CELL as usize * 4;
    out.par_chunks_mut(bytes_a_band)
        .enumerate()
        .for_each(|(band, pixels)| {
            let row = band as u32 * CELL;
            for column in (0..columns).step_by(CELL as usize) {
                let origin = DVec2::new(f64::from(column), f64::from(row));
                let cell = match smooth {
                    true => Cell::at(origin, &source),
                    false => Cell::Exact(origin),
                };
                // Of a place within the cell.
                let from = |inside: DVec2| {
                    let found = match &cell {
                        Cell::Smooth(corners) => Some(bilinear(corners, inside / f64::from(CELL))),
                        Cell::Exact(origin) => source(*origin + inside),
                    };
                    found.filter(shows)
                };
                let wide = CELL.min(columns - column) as usize;
                for (y, line) in pixels.chunks_mut(columns as usize * 4).enumerate() {
                    let line = &mut line[column as usize * 4..][..wide * 4];
                    for (x, pixel) in line.chunks_exact_mut(4).enumerate() {
                        let corner = DVec2::new(x as f64, y as f64);
                        pixel.copy_from_slice(&color(photo, corner, from));
                    }
                }
            }
        });
    out
}

/// The colour of the pixel with this corner.
fn color(photo: &RgbImage, corner: DVec2, from: impl Fn(DVec2) -> Option<DVec2>) -> [u8; 4] {
    let Some(middle) = from(corner + 0.5) else {
        return NOTHING;
    };
    // How many pixels of the photo it covers each way.
    let across = |axis: DVec2| {
        let end = |sign: f64| from(corner + 0.5 + axis * (0.499 * sign));
        let long = match (end(-1.0), end(1.0)) {
            (Some(a), Some(b)) => (b - a).length(),
            (Some(a), None) | (None, Some(a)) => (middle - a).length() * 2.0,
            (None, None) => 1.0,
        };
        // From 1 to MOST_LOOKS. A little more than a pixel is one.
        (long - 0.2).ceil().clamp(1.0, MOST_LOOKS) as u32
    };
    let looks = [across(DVec2::X), across(DVec2::Y)];
    if looks == [1, 1] {
        let [r, g, b] = cubic(photo, middle.x, middle.y);
        return [r, g, b, u8::MAX];
    }
    let (mut sum, mut count) = ([0_u32; 3], 0);
    for y in 0..looks[1] {
        for x in 0..looks[0] {
            let share = |place: u32, of: u32| (f64::from(place) + 0.5) / f64::from(of);
            let place = corner + DVec2::new(share(x, looks[0]), share(y, looks[1]));
            if let Some(source) = from(place) {
                let seen = cubic(photo, source.x, source.y);
                for (sum, seen) in sum.iter_mut().zip(seen) {
                    *sum += u32::from(seen);
                }
                count += 1;
            }
        }
    }
    if count == 0 {
        let [r, g, b] = cubic(photo, middle.x, middle.y);
        return [r, g, b, u8::MAX];
    }
    // A mean of bytes is a byte.
    let [r, g, b] = sum.map(|sum| ((sum + count / 2) / count) as u8);
    [r, g, b, u8::MAX]
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    fn coordinates() -> RgbImage {
        RgbImage::from_fn(240, 160, |x, y| Rgb([x as u8, y as u8, 255]))
    }

    /// Each pixel tells where it comes from: as `source` says, in cells and one by one; what lies outside
    /// is transparent.
    #[test]
    fn places_come_from_where_they_are_said_to() {
        let photo = coordinates();
        // Bent and turned, with a corner outside.
        let source = |place: DVec2| {
            let bent = place + 0.0004 * DVec2::new(place.y * place.y, place.x * place.x);
            Some(DVec2::from_angle(0.2).rotate(bent) - DVec2::new(10.0, 20.0))
        };
        for smooth in [true, false] {
            let picture = warped(&photo, [170, 130], smooth, source);
            let (mut seen, mut outside) = (0, 0);
            for (x, y, pixel) in picture.enumerate_pixels() {
                let at = source(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).unwrap();
                let inside = |room: f64| {
                    (room..240.0 - room).contains(&at.x) && (room..160.0 - room).contains(&at.y)
                };
                if inside(2.0) {
                    let told = DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + 0.5;
                    assert!(
                        (told - at).abs().max_element() <= 0.53,
                        "{x}, {y}: {told}, {at}"
                    );
                    assert_eq!(pixel[3], 255);
                    seen += 1;
                } else if !inside(-0.1) {
                    assert_eq!(pixel.0, NOTHING);
                    outside += 1;
                }
            }
            assert!(seen > 10_000 && outside > 1000, "{seen} {outside}");
        }
    }

    /// A fine board seen through pixels of four by four is grey, not a pattern.
    #[test]
    fn what_covers_many_pixels_is_their_mean() {
        let board = RgbImage::from_fn(400, 400, |x, y| {
            Rgb([if (x + y) % 2 == 0 { 200 } else { 100 }; 3])
        });
        for smooth in [true, false] {
            let picture = warped(&board, [90, 90], smooth, |place| Some(place * 4.0 + 3.3));
            for (x, y, pixel) in picture.enumerate_pixels() {
                assert!(pixel[0].abs_diff(150) <= 4, "{x}, {y}: {pixel:?}");
            }
        }
        assert_eq!(warped(&board, [0, 5], true, Some).dimensions(), (0, 5));
    }
}
