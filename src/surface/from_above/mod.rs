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

/// A triangle under a pixel's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// World z there.
    pub height: f64,
    /// Whether its corners stand counter-clockwise, seen from above.
    pub looks_up: bool,
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
        let base = self.frame().origin().z;
        self.seen_from_above(
            raster,
            Look::Middle,
            f64::NAN,
            progress,
            |highest, corners, first| {
                if let Some(height) = height_at(corners, first + 0.5) {
                    // NaN gives way.
                    *highest = highest.max(height + base);
                }
            },
        )
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
        let base = self.frame().origin().z;
        self.seen_from_above(
            raster,
            Look::Whole,
            f64::NAN,
            progress,
            |highest, corners, first| {
                if let Some(height) = highest_in(corners, first) {
                    *highest = highest.max(height + base);
                }
            },
        )
    }

    /// All triangles under each pixel's middle, row by row, in no order.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn faces_from_above(
        &self,
        raster: &MapRaster,
        progress: &Progress,
    ) -> Result<Vec<Vec<Face>>, Fault> {
        let base = self.frame().origin().z;
        let none = Vec::new();
        self.seen_from_above(
            raster,
            Look::Middle,
            none,
            progress,
            |faces, corners, first| {
                if let Some(height) = height_at(corners, first + 0.5) {
                    let [a, b, c] = corners.map(DVec3::truncate);
                    faces.push(Face {
                        height: height + base,
                        // Rows count downwards.
                        looks_up: (b - a).perp_dot(c - a) < 0.0,
                    });
                }
            },
        )
    }

    /// What `add` makes of the triangles over each pixel, row by row. It takes what was made so far, a triangle's corners,
    /// x and y in pixels, z in the surface's frame, and where the pixel begins.
    fn seen_from_above<T: Clone + Send + Sync>(
        &self,
        raster: &MapRaster,
        look: Look,
        none: T,
        progress: &Progress,
        add: impl Fn(&mut T, &[DVec3; 3], DVec2) + Sync,
    ) -> Result<Vec<T>, Fault> {
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
            let mut found = vec![none.clone(); columns as usize * rows.len()];
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
                    let corners = corners.map(|corner| place(corner).extend(corner.z));
                    let [p, q, r] = corners;
                    let (min, max) = (p.min(q).min(r), p.max(q).max(r));
                    // Middles at + 0.5; `as` saturates.
                    let range = |min: f64, max: f64, from: u32, to: u32| {
                        let [first, last] = match look {
                            Look::Middle => [(min - 0.5).ceil(), (max - 0.5).floor()],
                            Look::Whole => [min.ceil() - 1.0, max.floor()],
                        };
                        (first as u32).max(from)..((last + 1.0) as u32).min(to)
                    };
                    for row in range(min.y, max.y, rows.start, rows.end) {
                        for column in range(min.x, max.x, 0, columns) {
                            let index =
                                (row - rows.start) as usize * columns as usize + column as usize;
                            let first = DVec2::new(f64::from(column), f64::from(row));
                            add(&mut found[index], &corners, first);
                        }
                    }
                }
            }
            Ok(found)
        });
        let bands: Result<Vec<Vec<T>>, Fault> = bands.collect();
        Ok(bands?.into_iter().flatten().collect())
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
