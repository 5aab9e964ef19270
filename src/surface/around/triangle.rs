//! The triangle that a point of the surface lies on.

use glam::DVec3;

use crate::geometry::Bounds;
use crate::surface::{Surface, SurfaceError};

impl Surface {
    /// The corners, in the world, of the triangle that a point of the surface lies on, and how far off it
    /// the point is: of several the nearest. `None` where no triangle is within `reach` of it, world units.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn triangle_at(
        &self,
        point: DVec3,
        reach: f64,
    ) -> Result<Option<([DVec3; 3], f64)>, SurfaceError> {
        let frame = self.frame();
        let local = frame.local_from_world(point);
        let around = Bounds {
            min: local - reach,
            max: local + reach,
        };
        let apart =
            |low: DVec3, high: DVec3| low.cmpgt(around.max).any() || high.cmplt(around.min).any();
        let mut nearest: Option<([DVec3; 3], f64)> = None;
        for patch in self
            .patches()
            .seen(|bounds| apart(bounds.min, bounds.max))?
        {
            for corners in patch.triangles_seen(|b| apart(b.min, b.max)) {
                let [a, b, c] = corners;
                if apart(a.min(b).min(c), a.max(b).max(c)) {
                    continue;
                }
                let off = local.distance(nearest_on(corners, local));
                if off <= reach && nearest.is_none_or(|(_, least)| off < least) {
                    nearest = Some((corners, off));
                }
            }
        }
        Ok(nearest.map(|(corners, off)| (corners.map(|at| frame.world_from_local(at)), off)))
    }
}

/// The place of a triangle that is nearest to a point.
fn nearest_on([a, b, c]: [DVec3; 3], point: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    if let Some(unit) = normal.try_normalize() {
        let foot = point - unit * (point - a).dot(unit);
        let inside = [(a, b), (b, c), (c, a)]
            .iter()
            .all(|(from, to)| (*to - *from).cross(foot - *from).dot(normal) >= 0.0);
        if inside {
            return foot;
        }
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let way = to - from;
        let share = (point - from).dot(way) / way.length_squared();
        from + way
            * if share.is_finite() {
                share.clamp(0.0, 1.0)
            } else {
                0.0
            }
    };
    let places = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    let [first, second, third] = places;
    let nearer = |p: DVec3, q: DVec3| match p.distance(point) <= q.distance(point) {
        true => p,
        false => q,
    };
    nearer(nearer(first, second), third)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Cloud;

    /// Two triangles over a square of 4: the one left of the diagonal, the one right of it, none beside.
    #[test]
    fn it_is_the_one_under_the_point() {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let surface = Surface::new(Cloud {
            points: points.map(|(x, y)| DVec3::new(x, y, 2.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Cloud::default()
        })
        .unwrap();
        let at = |x, y, z| surface.triangle_at(DVec3::new(x, y, z), 0.5).unwrap();
        let (corners, off) = at(3.0, 1.0, 2.0).unwrap();
        assert!(corners.contains(&DVec3::new(4.0, 0.0, 2.0)) && off < 1e-12);
        let (corners, off) = at(1.0, 3.0, 2.25).unwrap();
        assert!(corners.contains(&DVec3::new(0.0, 4.0, 2.0)) && (off - 0.25).abs() < 1e-12);
        // 3-4-5 beside the corner.
        let (_, off) = at(4.3, 4.0, 2.4).unwrap();
        assert!((off - 0.5).abs() < 1e-12);
        assert_eq!(at(5.0, 5.0, 2.0), None);
    }
}
