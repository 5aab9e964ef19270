//! The corner loupe: what each corner of the selected photo lies on.

mod applying;

use glam::DVec3;

use crate::scale::{Corner, CornerOutcome};
use crate::surface::{Surface, SurfaceError};

/// The side of a crop as a share of the image's longer side.
pub const CROP: f64 = 0.08;

/// How near the triangle of a corner point is, as a share of its distance from the camera: rounding.
const ON_TRIANGLE: f64 = 1e-6;

/// The triangle next to a corner point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerTriangle {
    /// Its corners, in the world.
    pub corners: [DVec3; 3],
    /// How far the corner point is from it, world units: nothing on the surface; beyond the rim of the
    /// surface the distance to that.
    pub off: f64,
}

impl CornerTriangle {
    /// Its longest edge, world units.
    pub fn longest_edge(&self) -> f64 {
        let [a, b, c] = self.corners;
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    }

    /// The one next to a corner point; `None` where the corner has no point.
    fn of(corner: &Corner, surface: &Surface) -> Result<Option<Self>, SurfaceError> {
        let (point, distance) = match corner.outcome {
            CornerOutcome::OnSurface {
                point, distance, ..
            }
            | CornerOutcome::OnGround { point, distance } => (point, distance),
            CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => return Ok(None),
        };
        // Off the surface farther and farther around, as far as there can be any surface.
        let mut reach = distance * ON_TRIANGLE;
        let bounds = surface.bounds();
        let most = bounds.size().length() + bounds.center().distance(point);
        loop {
            if let Some((corners, off)) = surface.triangle_at(point, reach)? {
                return Ok(Some(Self { corners, off }));
            }
            if reach > most {
                return Ok(None);
            }
            reach = (reach * 4.0).max(distance * 0.01);
        }
    }
}

/// What the corners of a photo lie on.
#[derive(Debug, Clone, PartialEq)]
pub struct CornerFacts {
    /// Which photo.
    pub photo: usize,
    /// In the contract's order.
    pub triangles: [Option<CornerTriangle>; 4],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::CornerName;
    use crate::surface::Cloud;
    use glam::DVec2;

    /// Two triangles over a square of 4 at z = 2. On it the corner's own triangle, 4 and the diagonal long;
    /// beside it, on the ground, 3 aside and 2 down, the rim's.
    #[test]
    fn the_triangle_or_the_rim() {
        let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let surface = Surface::new(Cloud {
            points: points.map(|(x, y)| DVec3::new(x, y, 2.0)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Cloud::default()
        })
        .unwrap();
        let corner = |outcome| Corner {
            name: CornerName::TopLeft,
            pixel: DVec2::ZERO,
            direction: None,
            outcome,
        };
        let on = corner(CornerOutcome::OnSurface {
            distance: 10.0,
            point: DVec3::new(3.0, 1.0, 2.0),
            longest_edge: 5.0,
        });
        let found = CornerTriangle::of(&on, &surface).unwrap().unwrap();
        assert!(found.off < 1e-9 && (found.longest_edge() - 32_f64.sqrt()).abs() < 1e-12);
        let beside = corner(CornerOutcome::OnGround {
            distance: 10.0,
            point: DVec3::new(7.0, 1.0, 0.0),
        });
        let found = CornerTriangle::of(&beside, &surface).unwrap().unwrap();
        assert!((found.off - 13_f64.sqrt()).abs() < 1e-9, "{}", found.off);
        let none = corner(CornerOutcome::Nowhere);
        assert_eq!(CornerTriangle::of(&none, &surface).unwrap(), None);
    }
}
