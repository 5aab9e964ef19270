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

/// What of a pixel is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Look {
    /// Its middle.
    Middle,
    /// All of it.
    Whole,
}

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
        self.from_above(raster, Look::Middle, progress)
    }

    /// The highest of the surface anywhere in each pixel, its edges included: nothing is too thin. World z, row by row; NaN
    /// where there is none.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn tops_from_above(
        &self,
        raster: &MapRaster,
        progress: &Progress,
    ) -> Result<Vec<f64>, Fault> {
        self.from_above(raster, Look::Whole, progress)
    }

    fn from_above(
        &self,
        raster: &MapRaster,
        look: Look,
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
                        let [first, last] = match look {
                            Look::Middle => [(min - 0.5).ceil(), (max - 0.5).floor()],
                            Look::Whole => [min.ceil() - 1.0, max.floor()],
                        };
                        (first as u32).max(from)..((last + 1.0) as u32).min(to)
                    };
                    let solid: [DVec3; 3] =
                        std::array::from_fn(|i| on_picture[i].extend(corners[i].z));
                    for row in range(min.y, max.y, rows.start, rows.end) {
                        for column in range(min.x, max.x, 0, columns) {
                            let first = DVec2::new(f64::from(column), f64::from(row));
                            let found = match look {
                                Look::Middle => height_at(&solid, first + 0.5),
                                Look::Whole => highest_in(&solid, first),
                            };
                            let Some(z) = found else {
                                continue;
                            };
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

/// The height of a triangle at a place inside, edges included; `None` outside. x and y are pixels.
fn height_at(corners: &[DVec3; 3], place: DVec2) -> Option<f64> {
    let [a, b, c] = corners.map(DVec3::truncate);
    let whole = (b - a).perp_dot(c - a);
    let share = |from: DVec2, to: DVec2| (to - from).perp_dot(place - from) / whole;
    let shares = [share(b, c), share(c, a), share(a, b)];
    // Edges belong to both sides; NaN, of a triangle that is seen edge-on, to none.
    let is_inside = shares.iter().all(|share| *share >= -1e-9);
    is_inside.then(|| (0..3).map(|i| corners[i].z * shares[i]).sum())
}

/// The highest of a triangle in the pixel that begins there, its edges included: what four cuts leave of it has its
/// highest place at a corner (Sutherland and Hodgman 1974). `None` where it lies beside. x and y are pixels.
fn highest_in(corners: &[DVec3; 3], first: DVec2) -> Option<f64> {
    let mut left = corners.to_vec();
    for (axis, limit, sign) in [
        (0, first.x, 1.0),
        (0, first.x + 1.0, -1.0),
        (1, first.y, 1.0),
        (1, first.y + 1.0, -1.0),
    ] {
        let inside = |point: DVec3| (point[axis] - limit) * sign;
        // Most triangles are smaller than a pixel.
        if left.iter().all(|point| inside(*point) >= 0.0) {
            continue;
        }
        let next = left.iter().cycle().skip(1);
        let pairs = left.iter().zip(next);
        let cut = pairs.flat_map(|(&from, &to)| {
            let (a, b) = (inside(from), inside(to));
            let crossing = (a < 0.0) != (b < 0.0);
            let on_edge = crossing.then(|| from.lerp(to, a / (a - b)));
            [(a >= 0.0).then_some(from), on_edge]
        });
        left = cut.flatten().collect();
    }
    left.iter().map(|point| point.z).reduce(f64::max)
}
