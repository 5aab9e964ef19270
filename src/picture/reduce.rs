//! Reduced photos, for thumbnails and previews.

use image::RgbImage;
use rayon::prelude::*;

/// The size of an image of `width` x `height` so that no side is longer than `max_side`, in its
/// shape, rounded to whole pixels; its own size where it is small enough.
pub fn reduced_size(width: u32, height: u32, max_side: u32) -> (u32, u32) {
    let longest = width.max(height);
    if longest <= max_side {
        return (width, height);
    }
    let side = |length: u32| {
        let share = f64::from(length) * f64::from(max_side) / f64::from(longest);
        // At most `max_side`, so nothing is cut.
        (share.round() as u32).max(1)
    };
    (side(width), side(height))
}

/// The image with no side longer than `max_side`: each pixel is the mean over its area. Never
/// enlarges.
pub fn reduced(image: &RgbImage, max_side: u32) -> RgbImage {
    let (width, height) = reduced_size(image.width(), image.height(), max_side);
    reduced_to(image, width, height)
}

/// The image at a size that is no larger on either side: each pixel is the mean over its area.
pub(super) fn reduced_to(image: &RgbImage, width: u32, height: u32) -> RgbImage {
    if (width, height) == image.dimensions() || image.is_empty() || width == 0 || height == 0 {
        return image.clone();
    }
    let columns = shares(image.width(), width);
    let rows = shares(image.height(), height);
    let stride = image.width() as usize * 3;
    let source: &[u8] = image.as_raw();
    let mut out = RgbImage::new(width, height);
    out.par_chunks_exact_mut(width as usize * 3)
        .zip(&rows)
        .for_each(|(line, row)| {
            // The mean of the source rows first, then of its columns.
            let mut sums = vec![0.0_f32; stride];
            for (weight, source) in row
                .weights
                .iter()
                .zip(source[row.first * stride..].chunks(stride))
            {
                for (sum, value) in sums.iter_mut().zip(source) {
                    *sum += weight * f32::from(*value);
                }
            }
            for (pixel, column) in line.chunks_exact_mut(3).zip(&columns) {
                let mut mean = [0.0_f32; 3];
                for (weight, value) in column
                    .weights
                    .iter()
                    .zip(sums[column.first * 3..].chunks(3))
                {
                    for (mean, value) in mean.iter_mut().zip(value) {
                        *mean += weight * value;
                    }
                }
                for (pixel, mean) in pixel.iter_mut().zip(mean) {
                    // `as` saturates.
                    *pixel = mean.round() as u8;
                }
            }
        });
    out
}

/// The source pixels under one target pixel, and how much of it each covers.
struct Share {
    first: usize,
    weights: Vec<f32>,
}

fn shares(from: u32, to: u32) -> Vec<Share> {
    let step = f64::from(from) / f64::from(to);
    (0..to)
        .map(|target| {
            let (low, high) = (f64::from(target) * step, f64::from(target + 1) * step);
            let high = high.min(f64::from(from));
            let first = low.floor();
            let cover = |pixel: f64| (high.min(pixel + 1.0) - low.max(pixel)) / (high - low);
            let mut weights = Vec::new();
            let mut pixel = first;
            while pixel < high {
                weights.push(cover(pixel) as f32);
                pixel += 1.0;
            }
            Share {
                first: first as usize,
                weights,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    #[test]
    fn sizes_keep_the_shape() {
        assert_eq!(reduced_size(4000, 3000, 256), (256, 192));
        assert_eq!(reduced_size(3000, 4000, 2048), (1536, 2048));
        assert_eq!(reduced_size(100, 50, 256), (100, 50));
        assert_eq!(reduced_size(5000, 1, 256), (256, 1));
    }

    /// A ramp of 2 a pixel, centres at +0.5, stays the same ramp in space.
    #[test]
    fn a_ramp_stays_in_its_place() {
        let image = RgbImage::from_fn(100, 60, |x, y| Rgb([2 * x as u8 + 1, 4 * y as u8 + 2, 7]));
        for side in [50, 37, 20] {
            let small = reduced(&image, side);
            let scale = (
                100.0 / f64::from(small.width()),
                60.0 / f64::from(small.height()),
            );
            for (x, y, pixel) in small.enumerate_pixels() {
                let u = (f64::from(x) + 0.5) * scale.0;
                let v = (f64::from(y) + 0.5) * scale.1;
                // A share of a pixel is a step, not a ramp: up to an eighth of a step beside
                // rounding.
                assert!(
                    (f64::from(pixel[0]) - 2.0 * u).abs() <= 0.76,
                    "{side}: {x}, {pixel:?}"
                );
                assert!(
                    (f64::from(pixel[1]) - 4.0 * v).abs() <= 1.01,
                    "{side}: {y}, {pixel:?}"
                );
                assert_eq!(pixel[2], 7);
            }
        }
    }

    /// The mean of a checkerboard is its middle, at any odd ratio.
    #[test]
    fn fine_detail_becomes_its_mean() {
        let board = RgbImage::from_fn(300, 300, |x, y| {
            Rgb([if (x + y) % 2 == 0 { 200 } else { 100 }; 3])
        });
        let small = reduced(&board, 30);
        assert!(small.pixels().all(|p| p[0] == 150));
        let odd = reduced(&board, 43);
        assert!(odd.pixels().all(|p| (140..=160).contains(&p[0])));
    }

    #[test]
    fn small_images_are_left_alone() {
        let image = RgbImage::from_pixel(3, 2, Rgb([1, 2, 3]));
        assert_eq!(reduced(&image, 256), image);
        assert_eq!(reduced(&RgbImage::new(0, 0), 256).dimensions(), (0, 0));
    }
}
