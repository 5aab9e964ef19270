//! A photo with its halvings, in tiles: what a view of a large photo is put together from.
//!
//! Memory: three bytes a pixel for the photo and one for all its halvings, so 400 MB for 100 megapixels;
//! tiles are cut, and freed from the lens, one by one when somebody looks at them.

pub(super) mod part;

use glam::DVec2;
use image::RgbImage;

use self::part::Part;
use super::reduce::reduced_to;
use super::undistort::undistorted_part;
use crate::camera::Camera;

/// The side of a tile in pixels of its level, without its margin.
pub const TILE: u32 = 510;

/// What a tile has of its neighbours at each side, pixels: so that nothing is seen of the seam between two
/// that are drawn enlarged.
const MARGIN: u32 = 1;

/// One tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TileKey {
    /// How often the photo was halved.
    pub level: u32,
    /// From the left.
    pub column: u32,
    /// From above.
    pub row: u32,
}

/// A photo and its halvings, each as large as half of the one before, halves rounded up. The last one is a
/// single tile.
#[derive(Debug)]
pub struct PhotoPyramid {
    levels: Vec<RgbImage>,
}

impl PhotoPyramid {
    /// Halves a photo until it is a tile. On all cores; a second for 100 megapixels.
    pub fn new(photo: RgbImage) -> Self {
        let mut levels = vec![photo];
        while let Some(last) = levels.last()
            && last.width().max(last.height()) > TILE
        {
            let half = reduced_to(last, last.width().div_ceil(2), last.height().div_ceil(2));
            levels.push(half);
        }
        Self { levels }
    }

    /// Width and height of the photo in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.levels[0].dimensions()
    }

    /// How many levels there are, the photo itself among them.
    pub fn levels(&self) -> u32 {
        // A halving at a time, there are at most 32.
        self.levels.len() as u32
    }

    /// What it takes of the memory, bytes.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| level.as_raw().len()).sum()
    }

    /// The coarsest level that still has a pixel for each of the screen, where `zoom` of the screen's pixels
    /// are one of the photo.
    pub fn level_for(&self, zoom: f64) -> u32 {
        let halvings = (1.0 / zoom).log2().floor();
        // `as` saturates.
        (halvings.max(0.0) as u32).min(self.levels() - 1)
    }

    /// The tiles of a level that lie in a part of the photo, which is given by shares of its width and
    /// height, 0 to 1.
    pub fn tiles_in(&self, level: u32, from: DVec2, to: DVec2) -> Vec<TileKey> {
        let Some(picture) = self.levels.get(level as usize) else {
            return Vec::new();
        };
        let size = [picture.width(), picture.height()];
        let [columns, rows] = [0, 1].map(|axis| {
            let length = f64::from(size[axis]);
            let last = size[axis].div_ceil(TILE).max(1) - 1;
            // `as` saturates at 0.
            let tile = |share: f64| ((share * length / f64::from(TILE)).floor() as u32).min(last);
            tile(from[axis])..=tile(to[axis])
        });
        rows.flat_map(|row| {
            columns
                .clone()
                .map(move |column| TileKey { level, column, row })
        })
        .collect()
    }

    /// Where a tile lies in the photo, its top left and bottom right corner as shares of width and height;
    /// and the same of it in its own pixels, where it has a margin around it. `None` where there is no such
    /// tile.
    pub fn place(&self, key: TileKey) -> Option<[[DVec2; 2]; 2]> {
        let (inner, outer) = self.parts(key)?;
        let level = self.levels.get(key.level as usize)?;
        let pair = |x: u32, y: u32| DVec2::new(f64::from(x), f64::from(y));
        let size = pair(level.width(), level.height());
        let (from, to) = (
            pair(inner.x, inner.y),
            pair(inner.x + inner.width, inner.y + inner.height),
        );
        let (start, extent) = (pair(outer.x, outer.y), pair(outer.width, outer.height));
        Some([
            [from / size, to / size],
            [(from - start) / extent, (to - start) / extent],
        ])
    }

    /// A tile with its margin, of the photo as shot, or of the undistorted one where its camera is given.
    /// `None` where there is no such tile.
    pub fn tile(&self, key: TileKey, lens: Option<&Camera>) -> Option<RgbImage> {
        let (_, part) = self.parts(key)?;
        let level = self.levels.get(key.level as usize)?;
        Some(match lens {
            None => part.of(level),
            Some(camera) => undistorted_part(level, camera, part),
        })
    }

    /// A tile without and with its margin, in pixels of its level.
    fn parts(&self, key: TileKey) -> Option<(Part, Part)> {
        let size = self.levels.get(key.level as usize)?.dimensions();
        let (x, y) = (
            key.column.checked_mul(TILE)?.min(size.0),
            key.row.checked_mul(TILE)?.min(size.1),
        );
        let inner = Part {
            x,
            y,
            width: TILE,
            height: TILE,
        }
        .within(size);
        if inner.width == 0 || inner.height == 0 {
            return None;
        }
        let (left, above) = (x.saturating_sub(MARGIN), y.saturating_sub(MARGIN));
        let outer = Part {
            x: left,
            y: above,
            width: x + inner.width + MARGIN - left,
            height: y + inner.height + MARGIN - above,
        };
        Some((inner, outer.within(size)))
    }
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    /// Each pixel says where it is, modulo 256.
    fn photo(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            Rgb([x as u8, y as u8, (x / 256) as u8])
        })
    }

    /// 1300 x 700 is halved twice, to 325 x 175: 4 bytes a pixel and a little.
    #[test]
    fn halvings_end_at_a_tile() {
        let pyramid = PhotoPyramid::new(photo(1300, 701));
        assert_eq!(pyramid.levels(), 3);
        assert_eq!(pyramid.size(), (1300, 701));
        let pixels = 1300 * 701 + 650 * 351 + 325 * 176;
        assert_eq!(pyramid.bytes(), 3 * pixels);
        for (zoom, level) in [
            (4.0, 0),
            (1.0, 0),
            (0.51, 0),
            (0.5, 1),
            (0.25, 2),
            (0.001, 2),
        ] {
            assert_eq!(pyramid.level_for(zoom), level, "{zoom}");
        }
    }

    /// The tiles of the first level, without their margins, are the photo, each pixel once.
    #[test]
    fn tiles_make_the_photo() {
        let whole = photo(1300, 701);
        let pyramid = PhotoPyramid::new(whole.clone());
        let mut seen = 0;
        let tiles = pyramid.tiles_in(0, DVec2::ZERO, DVec2::ONE);
        assert_eq!(tiles.len(), 6);
        for key in tiles {
            let tile = pyramid.tile(key, None).unwrap();
            let [[from, to], [inner_from, inner_to]] = pyramid.place(key).unwrap();
            let size = DVec2::new(1300.0, 701.0);
            let own = DVec2::new(f64::from(tile.width()), f64::from(tile.height()));
            let (from, to) = ((from * size).round(), (to * size).round());
            let (start, end) = ((inner_from * own).round(), (inner_to * own).round());
            assert_eq!(end - start, to - from);
            for y in 0..(to.y - from.y) as u32 {
                for x in 0..(to.x - from.x) as u32 {
                    let there = whole.get_pixel(from.x as u32 + x, from.y as u32 + y);
                    let here = tile.get_pixel(start.x as u32 + x, start.y as u32 + y);
                    assert_eq!(here, there);
                    seen += 1;
                }
            }
        }
        assert_eq!(seen, 1300 * 701);
        // Only what is in sight: the right lower corner is one tile.
        let corner = pyramid.tiles_in(0, DVec2::splat(0.95), DVec2::splat(2.0));
        let last = TileKey {
            level: 0,
            column: 2,
            row: 1,
        };
        assert_eq!(corner, [last]);
        assert!(pyramid.tile(TileKey { column: 3, ..last }, None).is_none());
    }
}
