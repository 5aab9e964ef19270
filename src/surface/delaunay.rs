//! The 2.5-D Delaunay triangulation of points, by spade: what rays walk on, and the whole
//! of small clouds.

use glam::DVec3;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::SurfaceError;

/// A vertex of a triangulation over (x, y).
#[derive(Debug, Clone, Copy)]
pub(super) struct Site {
    /// x and y.
    pub(super) position: Point2<f64>,
    /// The elevation.
    pub(super) z: f64,
    /// Its place in the caller's list, where the caller has one.
    pub(super) index: u32,
}

impl Site {
    pub(super) fn new(point: DVec3, index: u32) -> Self {
        Self {
            position: Point2::new(point.x, point.y),
            z: point.z,
            index,
        }
    }

    pub(super) fn point(&self) -> DVec3 {
        DVec3::new(self.position.x, self.position.y, self.z)
    }
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// The triangles (counter-clockwise seen from above, indices into `points`) of the Delaunay
/// triangulation of `points` over (x, y). Of points with the same (x, y) any one is used: drop the
/// lower ones first.
///
/// # Errors
/// Where a coordinate is beyond what exact predicates can handle (about 3e60).
pub(super) fn triangulate(points: &[DVec3]) -> Result<Vec<[u32; 3]>, SurfaceError> {
    let triangulation = load(points)?;
    Ok(triangulation
        .inner_faces()
        .map(|face| face.vertices().map(|vertex| vertex.data().index))
        .collect())
}

/// The triangulation of `points`; a site's index is its place among them.
pub(super) fn load(points: &[DVec3]) -> Result<DelaunayTriangulation<Site>, SurfaceError> {
    let sites = (0..)
        .zip(points)
        .map(|(index, &point)| Site::new(point, index));
    DelaunayTriangulation::bulk_load(sites.collect()).map_err(|_| SurfaceError::TooFarOut)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| points[i as usize].truncate());
                (b - a).perp_dot(c - a) / 2.0
            })
            .sum()
    }

    /// The triangles of a lattice cover its square once, whichever diagonal each cell got.
    #[test]
    fn a_lattice_is_covered_once() {
        let points: Vec<DVec3> = (0..200)
            .flat_map(|x| (0..200).map(move |y| DVec3::new(f64::from(x), f64::from(y), 0.0)))
            .collect();
        let triangles = triangulate(&points).unwrap();
        assert_eq!(triangles.len(), 199 * 199 * 2);
        assert!((area(&points, &triangles) - 199.0 * 199.0).abs() < 1e-9);
    }

    #[test]
    fn many_points_on_one_circle_end() {
        let count = 100_000;
        let points: Vec<DVec3> = (0..count)
            .map(|i| {
                let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            })
            .collect();
        let triangles = triangulate(&points).unwrap();
        assert!((area(&points, &triangles) - std::f64::consts::PI).abs() < 1e-8);
    }
}
