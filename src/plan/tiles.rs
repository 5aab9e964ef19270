//! Heights of a surface in square tiles of one grid of pixels: who looks at other ground of the same surface, or at more of
//! it, keeps the tiles that she has. A tile is the same whatever is looked at besides.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::surface::{MapRaster, Surface};

/// Pixels along a side of a tile.
const SIDE: i64 = 256;
/// So many tiles are kept at most: 128 MB.
const MOST: usize = 128;

/// A tile by its place on the grid: to the east and to the north.
type Place = [i64; 2];

/// Tiles of pixels of one size.
#[derive(Debug, Clone)]
pub(super) struct Tiles {
    pixel: f64,
    tiles: HashMap<Place, Tile>,
}

/// World z, row by row from the north; NaN where there is no surface.
#[derive(Debug, Clone)]
struct Tile {
    /// At the pixels' middles.
    heights: Arc<[f64]>,
    /// The highest anywhere in a pixel: points of no triangle are among it.
    tops: Arc<[f64]>,
}

impl Tile {
    fn of(surface: &Surface, raster: &MapRaster, progress: &Progress) -> Result<Self, Fault> {
        let heights = surface.heights_from_above(raster, progress)?;
        let mut tops = surface.tops_from_above(raster, progress)?;
        let [min, max] = raster.bounds();
        let misses = |bounds: &Bounds| {
            let [from, to] = [bounds.min, bounds.max].map(DVec3::truncate);
            from.cmpgt(max).any() || to.cmplt(min).any()
        };
        for point in surface.vertices_seen(misses) {
            let at = raster.pixel_from_world(point.truncate()).floor();
            // `as` is exact: it lies inside.
            if at.min_element() >= 0.0 && at.x < SIDE as f64 && at.y < SIDE as f64 {
                let top = &mut tops[(at.y as i64 * SIDE + at.x as i64) as usize];
                // NaN gives way.
                *top = top.max(point.z);
            }
        }
        Ok(Self {
            heights: heights.into(),
            tops: tops.into(),
        })
    }
}

impl Tiles {
    /// The tiles of a raster, and those that are known, as far as they are of its grid.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub(super) fn over(
        raster: &MapRaster,
        surface: &Surface,
        known: Option<&Self>,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let mut tiles = HashMap::new();
        let known = known.filter(|known| known.pixel == raster.pixel);
        for place in places(raster) {
            let known = known.and_then(|known| known.tiles.get(&place)).cloned();
            let made = || Tile::of(surface, &tile(place, raster.pixel), progress);
            tiles.insert(place, known.map_or_else(made, Ok)?);
        }
        for (place, known) in known.iter().flat_map(|known| &known.tiles) {
            if tiles.len() < MOST {
                tiles.entry(*place).or_insert_with(|| known.clone());
            }
        }
        Ok(Self {
            pixel: raster.pixel,
            tiles,
        })
    }

    /// The heights at the middles of a raster's pixels, whose tiles are there.
    pub(super) fn heights(&self, raster: &MapRaster) -> Vec<f64> {
        self.cut(raster, |tile| &tile.heights)
    }

    /// The highest in each of a raster's pixels, whose tiles are there.
    pub(super) fn tops(&self, raster: &MapRaster) -> Vec<f64> {
        self.cut(raster, |tile| &tile.tops)
    }

    fn cut(&self, raster: &MapRaster, of: impl Fn(&Tile) -> &[f64]) -> Vec<f64> {
        let [west, north] = first_pixel(raster);
        let columns = usize::try_from(raster.columns).unwrap_or_default();
        let mut heights = vec![f64::NAN; columns * raster.rows as usize];
        for (row, heights) in (1..).zip(heights.chunks_mut(columns.max(1))) {
            // The southern edge of its pixels, counted on the grid.
            let south = north - row;
            let [y, in_tile] = [south.div_euclid(SIDE), SIDE - 1 - south.rem_euclid(SIDE)];
            let mut from = 0;
            while from < columns {
                let at = west.saturating_add(i64::try_from(from).unwrap_or(i64::MAX));
                let [x, first] = [at.div_euclid(SIDE), at.rem_euclid(SIDE)];
                let count = (columns - from).min((SIDE - first) as usize);
                if let Some(tile) = self.tiles.get(&[x, y]).map(&of) {
                    let begin = (in_tile * SIDE + first) as usize;
                    heights[from..from + count].copy_from_slice(&tile[begin..begin + count]);
                }
                from += count;
            }
        }
        heights
    }
}

/// Where a raster begins on the grid: pixels to the east of its western edge, and to the north of its northern edge.
fn first_pixel(raster: &MapRaster) -> [i64; 2] {
    // A whole number but for rounding; `as` saturates, and nobody surveys so many pixels off the origin.
    let DVec2 { x, y } = (raster.corner / raster.pixel).round();
    [x as i64, y as i64]
}

/// The tiles that a raster lies in.
fn places(raster: &MapRaster) -> impl Iterator<Item = Place> {
    let [west, north] = first_pixel(raster);
    let [east, south] = [
        west + i64::from(raster.columns) - 1,
        north - i64::from(raster.rows),
    ];
    let xs = west.div_euclid(SIDE)..=east.div_euclid(SIDE);
    let ys = south.div_euclid(SIDE)..=(north - 1).div_euclid(SIDE);
    ys.flat_map(move |y| xs.clone().map(move |x| [x, y]))
}

/// The raster of a tile.
fn tile([x, y]: Place, pixel: f64) -> MapRaster {
    // Exact: so far off the origin no surface lies.
    let corner = DVec2::new((x * SIDE) as f64, ((y + 1) * SIDE) as f64) * pixel;
    MapRaster {
        corner,
        pixel,
        columns: SIDE as u32,
        rows: SIDE as u32,
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::surface::Cloud;

    /// A raster out of tiles is the one that is looked at in one piece: to rounding, for that counts from another corner. Out
    /// of tiles that were known it is the same to the last digit, and none is looked at again.
    #[test]
    fn tiles_make_the_raster() {
        let points = (0..71 * 71).map(|i| {
            let place = DVec2::new(f64::from(i % 71), f64::from(i / 71));
            let z = (place.x * 0.3).sin() * (place.y * 0.2).cos();
            (place + DVec2::new(500_000.0, -40.0)).extend(z)
        });
        let cloud = Cloud {
            points: points.collect::<Vec<DVec3>>(),
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let progress = Progress::default();
        let over = |min: [f64; 2], max: [f64; 2]| {
            let corner = |place: [f64; 2]| DVec2::from(place) + DVec2::new(500_000.0, -40.0);
            MapRaster::over([corner(min), corner(max)], 0.11, 8_000_000).unwrap()
        };
        let small = over([20.0, 15.0], [45.0, 50.0]);
        let tiles = Tiles::over(&small, &surface, None, &progress).unwrap();
        let found = tiles.heights(&small);
        let whole = surface.heights_from_above(&small, &progress).unwrap();
        assert_eq!(found.len(), whole.len());
        for (a, b) in found.iter().zip(&whole) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        // Beyond the surface, too.
        let large = over([-5.0, 3.0], [80.0, 60.0]);
        let fresh = Tiles::over(&large, &surface, None, &progress).unwrap();
        let behind = Tiles::over(&large, &surface, Some(&tiles), &progress).unwrap();
        let bits = |tiles: &Tiles| -> Vec<u64> {
            tiles.heights(&large).iter().map(|z| z.to_bits()).collect()
        };
        assert_eq!(bits(&fresh), bits(&behind));
        let shared = tiles.tiles.iter().all(|(place, heights)| {
            behind
                .tiles
                .get(place)
                .is_some_and(|own| Arc::ptr_eq(&own.heights, &heights.heights))
        });
        assert!(shared && tiles.tiles.len() < behind.tiles.len());
        // The small one again is in the large one, and nothing new is looked at.
        let again = Tiles::over(&small, &surface, Some(&behind), &progress).unwrap();
        assert_eq!(again.tiles.len(), behind.tiles.len());
        assert!(
            again
                .heights(&small)
                .iter()
                .zip(&found)
                .all(|(a, b)| a.to_bits() == b.to_bits())
        );
    }
}
