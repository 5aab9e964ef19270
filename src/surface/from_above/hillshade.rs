//! How much light falls on a surface from one direction, as maps show relief.

use glam::DVec2;
use rayon::prelude::*;

use super::MapRaster;

/// Where the light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Degrees clockwise from the north (from y, in a frame of its own).
    pub azimuth: f64,
    /// Degrees above the horizon.
    pub altitude: f64,
}

impl Default for Light {
    /// From the north-west, half-way up: the habit of maps, by which hills are not seen as holes.
    fn default() -> Self {
        Self {
            azimuth: 315.0,
            altitude: 45.0,
        }
    }
}

/// The cosine of the angle between the light and each cell's normal, 0 where it is turned away; NaN where
/// there is no height. Slopes are Horn's: weighted differences over the eight cells around (B. K. P. Horn,
/// "Hill shading and the reflectance map", Proceedings of the IEEE 69 (1981), 14-47); of a plane they are
/// exact. Where a neighbour has no height, the one opposite is continued straight on; without that one too it
/// lies where its two neighbours beside the cell have it on a plane, and these as high as the cell.
pub fn hillshade(raster: &MapRaster, heights: &[f64], light: Light) -> Vec<f64> {
    let (columns, rows) = (raster.columns as usize, raster.rows as usize);
    let (azimuth, altitude) = (light.azimuth.to_radians(), light.altitude.to_radians());
    // Towards the light, east and north.
    let to_light = DVec2::new(azimuth.sin(), azimuth.cos()) * altitude.cos();
    let up = altitude.sin();
    let shade = |index: usize| {
        let (column, row) = (index % columns, index / columns);
        let at = |east: isize, south: isize| {
            let column = column.checked_add_signed(east).filter(|c| *c < columns)?;
            let row = row.checked_add_signed(south).filter(|r| *r < rows)?;
            let height = heights.get(row * columns + column).copied();
            height.filter(|height| !height.is_nan())
        };
        let own = at(0, 0)?;
        let known = |east: isize, south: isize| {
            let opposite = || Some(2.0 * own - at(-east, -south)?);
            at(east, south).or_else(opposite)
        };
        let beside = |east, south| known(east, south).unwrap_or(own);
        let near = |east, south| {
            let by_sides = || beside(east, 0) + beside(0, south) - own;
            known(east, south).unwrap_or_else(by_sides)
        };
        let column_of = |east: isize| near(east, -1) + 2.0 * near(east, 0) + near(east, 1);
        let row_of = |south: isize| near(-1, south) + 2.0 * near(0, south) + near(1, south);
        let run = 8.0 * raster.pixel;
        let slope = DVec2::new(
            (column_of(1) - column_of(-1)) / run,
            (row_of(-1) - row_of(1)) / run,
        );
        let cosine = (up - slope.dot(to_light)) / (1.0 + slope.length_squared()).sqrt();
        Some(cosine.max(0.0))
    };
    (0..columns * rows)
        .into_par_iter()
        .map(|index| shade(index).unwrap_or(f64::NAN))
        .collect()
}
