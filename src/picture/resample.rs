//! A photo between its pixels.

use image::RgbImage;

/// The colour at (u, v), continuous pixels with centres at +0.5: Catmull and Rom's cubic, which
/// passes through the pixels and keeps edges sharper than a linear mix. Beyond the edge the last
/// pixels repeat. `image` has at least one pixel.
pub(super) fn cubic(image: &RgbImage, u: f64, v: f64) -> [u8; 3] {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let (columns, across) = taps(u, width);
    let (rows, down) = taps(v, height);
    let source: &[u8] = image.as_raw();
    let mut sum = [0.0_f32; 3];
    for (row, down) in rows.into_iter().zip(down) {
        let line = &source[row * width * 3..][..width * 3];
        let mut mixed = [0.0_f32; 3];
        for (column, across) in columns.into_iter().zip(across) {
            let pixel = &line[column * 3..][..3];
            for (mixed, value) in mixed.iter_mut().zip(pixel) {
                *mixed += across * f32::from(*value);
            }
        }
        for (sum, mixed) in sum.iter_mut().zip(mixed) {
            *sum += down * mixed;
        }
    }
    // `as` truncates and saturates: the cubic may overshoot. In f64 half of one is added without rounding, and `round` would be
    // a call for each.
    sum.map(|value| (f64::from(value) + 0.5) as u8)
}

/// The four pixels around a place along one side of `length` pixels, and their weights.
fn taps(place: f64, length: usize) -> ([usize; 4], [f32; 4]) {
    let from_centre = place - 0.5;
    let below = from_centre.floor();
    let t = (from_centre - below) as f32;
    let last = length.saturating_sub(1);
    // `as` saturates at 0, where the first pixel repeats.
    let index = |step: f64| ((below + step) as usize).min(last);
    let weights = [
        ((2.0 - t) * t - 1.0) * t / 2.0,
        ((3.0 * t - 5.0) * t * t + 2.0) / 2.0,
        ((4.0 - 3.0 * t) * t + 1.0) * t / 2.0,
        (t - 1.0) * t * t / 2.0,
    ];
    ([index(-1.0), index(0.0), index(1.0), index(2.0)], weights)
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    /// Exact on pixels and on anything linear (and, away from the edge, on squares).
    #[test]
    fn pixels_and_ramps_are_kept() {
        let ramp = RgbImage::from_fn(50, 40, |x, y| Rgb([5 * x as u8, 6 * y as u8, 100]));
        for (x, y, pixel) in ramp.enumerate_pixels() {
            let found = cubic(&ramp, f64::from(x) + 0.5, f64::from(y) + 0.5);
            assert_eq!(found, pixel.0);
        }
        for (u, v) in [(10.2, 7.9), (25.0, 20.0), (33.3, 3.7)] {
            let [r, g, b] = cubic(&ramp, u, v).map(f64::from);
            assert!((r - 5.0 * (u - 0.5)).abs() <= 0.501, "{r} at {u}");
            assert!((g - 6.0 * (v - 0.5)).abs() <= 0.501, "{g} at {v}");
            assert_eq!(b, 100.0);
        }
        // Beyond the edge the last pixel.
        assert_eq!(cubic(&ramp, -9.0, 0.5), [0, 0, 100]);
        assert_eq!(cubic(&ramp, 99.0, 39.5), [245, 234, 100]);
    }
}
