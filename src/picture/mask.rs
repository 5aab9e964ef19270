//! Regions of a photo that are to be left out of an analysis: painted over, and as a mask.

use glam::DVec2;
use image::{Rgb, RgbImage};

use crate::labels::spans_within;

/// What left-out regions are painted with: pure blue. No rock and no shadow has it, so that everyone
/// sees what was done; and its grey value, by which programs find fragments, is that of a shadow.
pub const LEFT_OUT: [u8; 3] = [0, 0, 255];

/// Paints regions over. Their corners are in pixels of the image, (0, 0) at the outer corner of the
/// top left pixel; a pixel is in a region if its centre is.
pub fn paint_regions(image: &mut RgbImage, regions: &[Vec<DVec2>]) {
    fill(image, regions, Rgb(LEFT_OUT));
}

/// A mask of that size: white, and black in the regions.
pub fn mask_of_regions(width: u32, height: u32, regions: &[Vec<DVec2>]) -> RgbImage {
    let mut mask = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    fill(&mut mask, regions, Rgb([0; 3]));
    mask
}

fn fill(image: &mut RgbImage, regions: &[Vec<DVec2>], color: Rgb<u8>) {
    let (width, height) = image.dimensions();
    for region in regions {
        spans_within(region, width, height, |row, columns| {
            for column in columns {
                image.put_pixel(column, row, color);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn black(mask: &RgbImage) -> usize {
        mask.pixels().filter(|pixel| pixel.0 == [0; 3]).count()
    }

    #[test]
    fn a_rectangle_takes_the_pixels_whose_centres_it_holds() {
        let corners = [(1.4, 2.0), (5.5, 2.0), (5.5, 4.6), (1.4, 4.6)];
        let region = corners.map(DVec2::from).to_vec();
        let mask = mask_of_regions(8, 6, &[region]);
        for (x, y, pixel) in mask.enumerate_pixels() {
            let inside = (1..5).contains(&x) && (2..5).contains(&y);
            assert_eq!(pixel.0 == [0; 3], inside, "{x}, {y}");
        }
    }

    /// A disc of radius r has pi r² pixels, whichever way round it is drawn; cut off at the edges.
    #[test]
    fn a_disc_has_its_area() {
        let disc = |x: f64, y: f64, way: f64| -> Vec<DVec2> {
            let turn = |i: u32| way * f64::from(i) / 500.0 * std::f64::consts::TAU;
            let corner = |i: u32| DVec2::new(x, y) + DVec2::from_angle(turn(i)) * 40.0;
            (0..500).map(corner).collect()
        };
        let area = std::f64::consts::PI * 1600.0;
        for way in [1.0, -1.0] {
            let mask = mask_of_regions(200, 100, &[disc(77.3, 50.6, way)]);
            assert!((black(&mask) as f64 / area - 1.0).abs() < 0.005);
            let quarter = mask_of_regions(200, 100, &[disc(0.0, 0.0, way)]);
            assert!((black(&quarter) as f64 / area * 4.0 - 1.0).abs() < 0.02);
        }
    }

    #[test]
    fn painted_is_what_is_masked_and_nothing_else() {
        let photo = RgbImage::from_fn(60, 50, |x, y| Rgb([x as u8, y as u8, 9]));
        let triangle = [(10.0, 5.0), (55.0, 20.0), (20.0, 45.0)];
        let regions = [triangle.map(DVec2::from).to_vec()];
        let mut painted = photo.clone();
        paint_regions(&mut painted, &regions);
        let mask = mask_of_regions(60, 50, &regions);
        assert!(black(&mask) > 500);
        for (x, y, pixel) in painted.enumerate_pixels() {
            match mask.get_pixel(x, y).0 {
                [0, 0, 0] => assert_eq!(pixel.0, LEFT_OUT),
                _ => assert_eq!(pixel, photo.get_pixel(x, y)),
            }
        }
    }

    #[test]
    fn nonsense_masks_nothing() {
        let nowhere = vec![DVec2::NAN, DVec2::INFINITY, DVec2::NEG_INFINITY];
        let far = vec![
            DVec2::splat(1e300),
            DVec2::splat(2e300),
            DVec2::new(3e300, 1e300),
        ];
        let mask = mask_of_regions(9, 9, &[Vec::new(), vec![DVec2::ONE], nowhere, far]);
        assert_eq!(black(&mask), 0);
        paint_regions(&mut RgbImage::new(0, 0), &[vec![DVec2::ZERO; 4]]);
    }
}
