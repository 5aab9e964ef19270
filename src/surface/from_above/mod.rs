//! The surface from straight above, north up: heights on a raster of the map, and how the sun would light
//! them.
//!
//! ```text
//! map_raster  square pixels of the map
//! hillshade   the light on it
//! colours     those of its points
//! ```

mod colours;
mod hillshade;
mod map_raster;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

pub use hillshade::{Light, hillshade};
pub use map_raster::MapRaster;

use super::Surface;
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::jobs::Progress;

/// Rows that one thread works on at a time.
const BAND: u32 = 64;

impl Surface {
    /// The highest of the surface at each pixel's middle, world z, row by row; NaN where there is none.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn heights_from_above(
        &self,
        raster: &MapRaster,
        progress: &Progress,
    ) -> Result<Vec<f64>, Fault> {
        let frame = self.frame();
        let origin = frame.local_from_world(raster.corner.extend(0.0));
        // A place of the raster, of a point of the surface's frame.
        let place =
            |point: DVec3| DVec2::new(point.x - origin.x, origin.y - point.y) / raster.pixel;
        let columns = raster.columns;
        let end = DVec2::new(f64::from(columns), f64::from(raster.rows));
        let misses = |bounds: &Bounds| {
            let (a, b) = (place(bounds.min), place(bounds.max));
            b.y > end.y || a.y < 0.0 || b.x < 0.0 || a.x > end.x
        };
        let patches = self.patches().seen(misses);
        let patches =
            patches.map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
        let bands: Vec<u32> = (0..raster.rows).step_by(BAND as usize).collect();
        let bands = bands.into_par_iter().map(|first| {
            let rows = first..(first + BAND).min(raster.rows);
            let mut highest = vec![f64::NAN; columns as usize * rows.len()];
            let (top, bottom) = (f64::from(rows.start), f64::from(rows.end));
            let beside = |bounds: &Bounds| {
                let (a, b) = (place(bounds.min), place(bounds.max));
                b.y > bottom || a.y < top || b.x < 0.0 || a.x > end.x
            };
            for patch in &patches {
                if beside(&patch.bounds) {
                    continue;
                }
                if progress.is_cancelled() {
                    return Err(Fault::new("cancelled", "start it again when you want it"));
                }
                for corners in patch.triangles_seen(beside) {
                    let on_picture = corners.map(place);
                    let [p, q, r] = on_picture;
                    let (min, max) = (p.min(q).min(r), p.max(q).max(r));
                    // Middles at + 0.5; `as` saturates.
                    let range = |min: f64, max: f64, from: u32, to: u32| {
                        let first = ((min - 0.5).ceil() as u32).max(from);
                        first..(((max - 0.5).floor() + 1.0) as u32).min(to)
                    };
                    for row in range(min.y, max.y, rows.start, rows.end) {
                        for column in range(min.x, max.x, 0, columns) {
                            let middle = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                            let Some(shares) = shares(&on_picture, middle) else {
                                continue;
                            };
                            let z: f64 = (0..3).map(|i| corners[i].z * shares[i]).sum();
                            let z = z + frame.origin().z;
                            let index =
                                (row - rows.start) as usize * columns as usize + column as usize;
                            // NaN gives way.
                            highest[index] = highest[index].max(z);
                        }
                    }
                }
            }
            Ok(highest)
        });
        let bands: Result<Vec<Vec<f64>>, Fault> = bands.collect();
        Ok(bands?.concat())
    }
}

/// How much of each corner is in a place inside a triangle, edges included; `None` outside.
fn shares([a, b, c]: &[DVec2; 3], place: DVec2) -> Option<[f64; 3]> {
    let whole = (*b - *a).perp_dot(*c - *a);
    let share = |from: DVec2, to: DVec2| (to - from).perp_dot(place - from) / whole;
    let shares = [share(*b, *c), share(*c, *a), share(*a, *b)];
    // Edges belong to both sides; NaN, of a triangle that is seen edge-on, to none.
    shares.iter().all(|share| *share >= -1e-9).then_some(shares)
}
