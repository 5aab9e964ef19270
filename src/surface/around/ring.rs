//! A ring on the surface: where it is at one straight distance from a point.
//!
//! The sphere around the point meets each triangle in arcs of a circle, which lie on the triangle to the
//! last bits: the ring is draped without any height being looked up. On rough rock it can be in several
//! pieces.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::geometry::Bounds;
use crate::surface::{Surface, SurfaceError};

/// Chords of a whole circle.
const CHORDS: f64 = 64.0;

impl Surface {
    /// The chords of the ring with this radius around a point, both of them in the world. Triangulates what
    /// of a cloud is not triangulated there.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn ring(&self, center: DVec3, radius: f64) -> Result<Vec<[DVec3; 2]>, SurfaceError> {
        let frame = self.frame();
        let middle = frame.local_from_world(center);
        let mut chords = Vec::new();
        if !(radius > 0.0 && radius.is_finite()) {
            return Ok(chords);
        }
        let around = Bounds {
            min: middle - radius,
            max: middle + radius,
        };
        let apart = |bounds: &Bounds| {
            bounds.min.cmpgt(around.max).any() || bounds.max.cmplt(around.min).any()
        };
        for patch in self.patches().seen(apart)? {
            for corners in patch.triangles_seen(apart) {
                let [a, b, c] = corners;
                let low = a.min(b).min(c);
                let high = a.max(b).max(c);
                if low.cmpgt(around.max).any() || high.cmplt(around.min).any() {
                    continue;
                }
                arcs(corners, middle, radius, &mut chords);
            }
        }
        for chord in &mut chords {
            *chord = chord.map(|end| frame.world_from_local(end));
        }
        Ok(chords)
    }
}

/// The arcs in which a sphere meets a triangle, as chords.
fn arcs(corners: [DVec3; 3], middle: DVec3, radius: f64, chords: &mut Vec<[DVec3; 2]>) {
    let [a, b, c] = corners;
    // All of it within the sphere: no arc.
    if corners
        .iter()
        .all(|corner| corner.distance_squared(middle) < radius * radius)
    {
        return;
    }
    let Some(normal) = (b - a).cross(c - a).try_normalize() else {
        return;
    };
    let off = (a - middle).dot(normal);
    let squared = radius * radius - off * off;
    if squared <= 0.0 {
        return;
    }
    let (round, r) = (middle + normal * off, squared.sqrt());
    let x = (b - a).normalize_or_zero();
    let y = normal.cross(x);
    let flat = corners.map(|corner| {
        let way = corner - round;
        DVec2::new(way.dot(x), way.dot(y))
    });
    // Where the circle passes the lines of the edges.
    let mut angles = vec![0.0, TAU];
    for edge in 0..3 {
        let (from, to) = (flat[edge], flat[(edge + 1) % 3]);
        let way = to - from;
        let (p, q) = (from.dot(way), from.length_squared() - r * r);
        let root = p * p - way.length_squared() * q;
        if root <= 0.0 {
            continue;
        }
        for sign in [-1.0, 1.0] {
            let share = (-p + sign * root.sqrt()) / way.length_squared();
            if (0.0..=1.0).contains(&share) {
                let at = from + way * share;
                angles.push(at.y.atan2(at.x).rem_euclid(TAU));
            }
        }
    }
    angles.sort_unstable_by(f64::total_cmp);
    let at = |angle: f64| DVec2::new(angle.cos(), angle.sin()) * r;
    // The corners go counter-clockwise seen from the normal.
    let is_inside = |place: DVec2| {
        (0..3).all(|edge| {
            let (from, to) = (flat[edge], flat[(edge + 1) % 3]);
            (to - from).perp_dot(place - from) >= 0.0
        })
    };
    for pair in angles.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        if to - from <= 0.0 || !is_inside(at((from + to) / 2.0)) {
            continue;
        }
        // At most CHORDS and three.
        let steps = ((to - from) / TAU * CHORDS).ceil().max(1.0);
        let place = |step: f64| {
            let place = at(from + (to - from) * step / steps);
            round + x * place.x + y * place.y
        };
        let mut step = 0.0;
        while step < steps {
            chords.push([place(step), place(step + 1.0)]);
            step += 1.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Cloud;

    /// A slope of 3 in 4 far from the origin, of `n` x `n` points.
    fn slope(n: u32) -> Surface {
        let origin = DVec3::new(500_000.0, 5_000_000.0, 100.0);
        let points = (0..n * n).map(|i| {
            let [x, y] = [i % n, i / n].map(|i| f64::from(i) * 4.0 / f64::from(n - 1) - 2.0);
            origin + DVec3::new(x, y, 0.75 * x)
        });
        Surface::new(Cloud {
            points: points.collect(),
            ..Cloud::default()
        })
        .unwrap()
    }

    /// On a plane the ring is a circle, whether a triangle is larger or smaller than it: 2 pi r long, all of
    /// it on the plane.
    #[test]
    fn on_a_plane_it_is_a_circle() {
        let center = DVec3::new(500_000.3, 5_000_000.1, 100.0 + 0.75 * 0.3);
        for (n, radius) in [(2, 1.0), (9, 1.0), (41, 0.55)] {
            let chords = slope(n).ring(center, radius).unwrap();
            let length: f64 = chords.iter().map(|[a, b]| a.distance(*b)).sum();
            let around = TAU * radius;
            // 64 chords are short by (pi / 64)^2 / 6, more are nearer.
            assert!(
                length < around && length > around * 0.9995,
                "{n}: {length} of {around}"
            );
            for end in chords.iter().flatten() {
                assert!((end.distance(center) - radius).abs() < 1e-8);
                let on = 100.0 + 0.75 * (end.x - 500_000.0);
                assert!((end.z - on).abs() < 1e-8);
            }
        }
    }

    /// Half of it where the surface ends at the point.
    #[test]
    fn it_ends_with_the_surface() {
        let edge = DVec3::new(499_998.0, 5_000_000.0, 98.5);
        let chords = slope(9).ring(edge, 0.5).unwrap();
        let length: f64 = chords.iter().map(|[a, b]| a.distance(*b)).sum();
        assert!((length - TAU * 0.25).abs() < 0.002, "{length}");
        assert!(
            slope(9)
                .ring(edge + DVec3::X * -3.0, 0.5)
                .unwrap()
                .is_empty()
        );
        assert!(slope(9).ring(edge, f64::NAN).unwrap().is_empty());
    }
}
