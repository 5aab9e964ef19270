//! Polygons that are spread by known bells.

use super::*;
use crate::split_mix::SplitMix;

const SIDE: usize = 400;

/// Squares with sharp edges, seen at four times the resolution, spread by a bell and brought to pixels; noise of two
/// gray values.
fn polygons(deviation: f64) -> RgbImage {
    let mut random = SplitMix(5);
    let mut unit = || random.unit();
    let fine = 4;
    let size = SIDE * fine;
    let mut values = vec![90.0; size * size];
    for _ in 0..160 {
        // A square, turned.
        let middle = [unit() * size as f64, unit() * size as f64];
        let half = 30.0 + 80.0 * unit();
        let (sin, cos) = (unit() * 6.0).sin_cos();
        let gray = 30.0 + 200.0 * unit();
        let reach = half * 1.5;
        let range = |at: f64| {
            let first = (at - reach).max(0.0) as usize;
            first..((at + reach).max(0.0) as usize).min(size)
        };
        for y in range(middle[1]) {
            for x in range(middle[0]) {
                let (dx, dy) = (x as f64 - middle[0], y as f64 - middle[1]);
                let inside =
                    (dx * cos + dy * sin).abs() < half && (dy * cos - dx * sin).abs() < half;
                if inside {
                    values[y * size + x] = gray;
                }
            }
        }
    }
    let large = Gray {
        values,
        width: size,
        height: size,
    };
    let large = match deviation > 0.0 {
        true => large.smooth_rows(0, size, deviation * fine as f64),
        false => large.values,
    };
    RgbImage::from_fn(SIDE as u32, SIDE as u32, |x, y| {
        let mut sum = 0.0;
        for row in 0..fine {
            for column in 0..fine {
                sum += large[(y as usize * fine + row) * size + x as usize * fine + column];
            }
        }
        let noise = 2.0 * (unit() + unit() + unit() + unit() - 2.0) * 3f64.sqrt();
        image::Rgb([(sum / (fine * fine) as f64 + noise).round() as u8; 3])
    })
}

#[test]
fn known_bells_are_found() {
    for deviation in [0.0, 0.5, 0.8, 1.2, 2.0, 3.0, 5.0] {
        let found = edge_spread(&polygons(deviation)).unwrap();
        let wanted = (deviation * deviation + 1.0 / 12.0f64).sqrt();
        let off = (found - wanted).abs();
        let least = if deviation < 0.5 { 0.12 } else { 0.08 };
        // So wide ones are seen in a photo of a quarter of the size, where few edges are left.
        let share = if deviation > 4.0 { 0.12 } else { 0.06 };
        assert!(
            off < f64::max(least, share * wanted),
            "{deviation}: {found}, not {wanted}"
        );
    }
}

#[test]
fn nothing_is_said_without_edges() {
    for (width, height) in [(1, 1), (10, 500), (200, 200)] {
        assert_eq!(edge_spread(&RgbImage::new(width, height)), None);
    }
    let noise = |x: u32, y: u32| ((x * 7919 + y * 104_729) % 5) as u8;
    let even = RgbImage::from_fn(200, 200, |x, y| image::Rgb([100 + noise(x, y); 3]));
    assert_eq!(edge_spread(&even), None);
}

#[test]
fn half_of_the_maximum() {
    let half = full_width(1.0) / 2.0;
    assert!(((-0.5 * half * half).exp() - 0.5).abs() < 1e-12);
}
