//! Depths of pixels: for each the nearest triangle that its ray meets.
//!
//! Triangles come to the pixels, not rays to the triangles: a photo's grid has thousands of rays that
//! start at one place, and each triangle knows which few of them can meet it. That costs a look at each
//! block of triangles under the footprint and no hierarchy (measured beside walking the rays; see
//! `benches/`).
//!
//! The test is exact in the camera's frame, without a division: a ray d meets the triangle a, b, c where
//! d·(a×b), d·(b×c) and d·(c×a) have the sign of a·(b×c). Depth along the optical axis follows from the
//! triangle's plane, whose normal is taken from differences of its corners so that small triangles far
//! away lose nothing. Edges belong to the surface: a ray that passes one by no more than `slack` meets.

use glam::{DMat3, DVec2, DVec3};

use super::FieldError;
use super::samples::{Samples, ray};
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::scale::pyramid::{Pyramid, inward};
use crate::surface::{Patches, longest_edge};

/// Where a camera stands, in the frame of the patches.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stand {
    pub(super) center: DVec3,
    /// Camera axes as columns.
    pub(super) rotation: DMat3,
    /// See `Surface::slack`.
    pub(super) slack: f64,
}

/// So many rays are met as fast as the box around them is looked at.
const FEW: usize = 4;

/// What the samples of a band meet.
pub(super) struct Met {
    /// The depth of each sample, infinite where its ray meets nothing.
    pub(super) depths: Vec<f64>,
    /// The longest edge of the triangle that each sample met, world units; empty where nobody asks.
    pub(super) edges: Vec<f64>,
}

impl Met {
    fn nothing(samples: &Samples, with_edges: bool) -> Self {
        Self {
            depths: vec![f64::INFINITY; samples.len()],
            edges: vec![f64::INFINITY; if with_edges { samples.len() } else { 0 }],
        }
    }
}

/// What each sample meets.
///
/// # Errors
/// Where the surface cannot be triangulated, or the work was cancelled.
pub(super) fn depths(
    samples: &Samples,
    stand: &Stand,
    patches: Patches<'_>,
    with_edges: bool,
    progress: &Progress,
) -> Result<Met, FieldError> {
    let Some([min, max]) = samples.extent else {
        return Ok(Met::nothing(samples, with_edges));
    };
    let mut nearest = Nearest {
        samples,
        slack: stand.slack,
        longest_ray: ray(min.abs().max(max.abs())).length(),
        met: Met::nothing(samples, with_edges),
    };
    let seen = Pyramid::of_directions(min, max, stand.center, stand.rotation);
    let sides = inward(min, max);
    let camera_from_local = stand.rotation.transpose();
    for patch in patches.seen(|bounds| seen.misses(bounds))? {
        if progress.is_cancelled() {
            return Err(FieldError::Cancelled);
        }
        let in_camera = |point: DVec3| camera_from_local * (point - stand.center);
        let misses = |bounds: &Bounds| no_samples_in(bounds, in_camera, samples, stand.slack);
        for triangle in patch.triangles_seen(misses) {
            nearest.meet(triangle.map(in_camera), &sides);
        }
    }
    Ok(nearest.met)
}

/// Whether no sample's ray can meet what lies in a box. Of what the grid is fine for, that is none.
fn no_samples_in(
    bounds: &Bounds,
    in_camera: impl Fn(DVec3) -> DVec3,
    samples: &Samples,
    slack: f64,
) -> bool {
    let corners = bounds.corners().map(in_camera);
    // Behind the camera or beside it, it is clipped triangle by triangle.
    if !corners.iter().all(|corner| corner.z > slack) {
        return false;
    }
    !samples.any_near(&corners.map(|corner| corner.truncate() / corner.z))
}

struct Nearest<'a> {
    samples: &'a Samples,
    slack: f64,
    /// No ray (x, y, 1) is longer.
    longest_ray: f64,
    met: Met,
}

impl Nearest<'_> {
    /// Meets a triangle (camera axes) with the rays that may meet it.
    fn meet(&mut self, corners: [DVec3; 3], sides: &[DVec3; 5]) {
        let (columns, rows) = if corners.iter().all(|corner| corner.z > self.slack) {
            let plane = corners.map(|corner| corner.truncate() / corner.z);
            self.samples.near(&plane)
        } else {
            let inside = clipped(corners, sides);
            if inside.is_empty() {
                return;
            }
            let plane: Vec<DVec2> = inside.iter().map(|c| c.truncate() / c.z).collect();
            // At the very centre of the camera it can be anywhere.
            match plane.iter().all(|point| point.is_finite()) {
                true => self.samples.near(&plane),
                false => self.samples.all(),
            }
        };
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let volume = normal.dot(a);
        let side = volume.signum();
        let ways = [(a, b - a), (b, c - b), (c, a - c)];
        // A ray (x, y, 1) times this: how far it lies inside of each edge.
        let [along, next, last] = ways.map(|(from, way)| from.cross(way) * side);
        let inside = DMat3::from_cols(along, next, last).transpose();
        let [along, next, last] = ways.map(|(_, way)| -self.slack * way.length());
        let slacks = DVec3::new(along, next, last);
        let least = slacks * self.longest_ray;
        let (near, far) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
        // Whether all rays of a box of points do, twice the slack left for rounding.
        let passes_by = |[min, max]: [DVec2; 2]| {
            let half = (max - min) / 2.0;
            let most = inside.x_axis.abs() * half.x
                + inside.y_axis.abs() * half.y
                + inside * ray((min + max) / 2.0);
            // (Of no rays that is NaN.)
            !most.cmpge(2.0 * least).all()
        };
        for row in rows {
            for (run, around) in self.samples.runs(columns.clone(), row) {
                if run.len() > FEW && passes_by(around) {
                    continue;
                }
                for column in run {
                    let d = ray(self.samples.point(column, row));
                    // The distance between the ray and an edge's line is the product over the length of
                    // d × way, which is at most that of both. (Roots are slow, and hardly ever needed.)
                    let products = inside * d;
                    if !products.cmpge(least).all() {
                        continue;
                    }
                    if products.min_element() < 0.0 && !products.cmpge(slacks * d.length()).all() {
                        continue;
                    }
                    // Within the slack of a sliver the plane can run away. NaN, of a triangle that is seen
                    // edge-on: its neighbours have its edges.
                    let depth = (volume / normal.dot(d)).clamp(near, far);
                    let place = self.samples.place(column, row);
                    if depth > 0.0 && depth < self.met.depths[place] {
                        self.met.depths[place] = depth;
                        if let Some(edge) = self.met.edges.get_mut(place) {
                            *edge = longest_edge(corners);
                        }
                    }
                }
            }
        }
    }
}

/// What of a triangle (camera axes) lies on the inner side of all planes through the camera.
pub(in crate::scale) fn clipped(corners: [DVec3; 3], sides: &[DVec3; 5]) -> Vec<DVec3> {
    let mut polygon = corners.to_vec();
    for side in sides {
        let mut inside = Vec::with_capacity(polygon.len() + 1);
        for (index, &from) in polygon.iter().enumerate() {
            let to = polygon[(index + 1) % polygon.len()];
            let (before, after) = (side.dot(from), side.dot(to));
            if before >= 0.0 {
                inside.push(from);
            }
            if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
                inside.push(from + (to - from) * (before / (before - after)));
            }
        }
        polygon = inside;
    }
    polygon
}
