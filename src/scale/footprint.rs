//! The footprint: the image outline on the surface, and a grid inside it.
//!
//! Corners are what scales are made of; the footprint is what people look at, what maps show, and
//! what tells whether the surface between the corners is as flat as four corners pretend.

use glam::{DVec2, DVec3};

use super::{CornerOutcome, GroundFinder, ImageKind, PhotoScale};
use crate::camera::{Camera, Pose};
use crate::geometry::Ray;
use crate::surface::{Caster, SurfaceError};

/// How closely a footprint is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FootprintDetail {
    /// Points along each image edge, at least 1 (the corner alone).
    pub per_edge: u32,
    /// Cells along the image's width in the grid inside, at least 1.
    pub columns: u32,
    /// Cells along the image's height in the grid inside, at least 1.
    pub rows: u32,
}

impl Default for FootprintDetail {
    /// Fine enough that the outline follows the rocks that a photo of a pile shows.
    fn default() -> Self {
        Self {
            per_edge: 32,
            columns: 16,
            rows: 12,
        }
    }
}

/// A pixel of an image and what its ray met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootprintPoint {
    /// In the image.
    pub pixel: DVec2,
    /// What its ray met.
    pub outcome: CornerOutcome,
}

impl FootprintPoint {
    /// Its place in the world, where there is one.
    pub fn point(&self) -> Option<DVec3> {
        self.outcome.point()
    }
}

/// Where a photo's image lies in the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Footprint {
    /// Around the image, clockwise from the top left corner: the corners, and between them points
    /// at equal distances in the image. Closed: the last is followed by the first.
    pub outline: Vec<FootprintPoint>,
    /// `(columns + 1) * (rows + 1)` points, row by row from the top left corner, at equal distances
    /// in the image.
    pub grid: Vec<FootprintPoint>,
    /// Cells along the image's width.
    pub columns: u32,
    /// Cells along the image's height.
    pub rows: u32,
}

impl Footprint {
    /// Casts the rays of a footprint. Rays that miss the surface are met with the ground, as those
    /// of the corners are.
    ///
    /// # Errors
    /// Where no ground can be found although it is needed.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        detail: FootprintDetail,
        ground: &mut GroundFinder<'_>,
        caster: &mut Caster<'_>,
    ) -> Result<Self, SurfaceError> {
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let mut meet = |pixel: DVec2| -> Result<FootprintPoint, SurfaceError> {
            let outcome = match super::world_direction(camera, pose, image, pixel) {
                Err(not_invertible) => CornerOutcome::NoRay(not_invertible),
                Ok(direction) => {
                    let ray = Ray {
                        origin: pose.center,
                        direction,
                    };
                    match caster.cast(&ray) {
                        Some(hit) => CornerOutcome::OnSurface {
                            distance: hit.t,
                            point: hit.point,
                        },
                        None => super::meet_ground(&ray, ground.under(camera, pose)?),
                    }
                }
            };
            Ok(FootprintPoint { pixel, outcome })
        };
        let corners = [
            DVec2::ZERO,
            DVec2::new(size.x, 0.0),
            size,
            DVec2::new(0.0, size.y),
        ];
        let per_edge = detail.per_edge.max(1);
        let mut outline = Vec::with_capacity(4 * per_edge as usize);
        for edge in 0..4 {
            let (from, to) = (corners[edge], corners[(edge + 1) % 4]);
            for step in 0..per_edge {
                outline.push(meet(from.lerp(to, f64::from(step) / f64::from(per_edge)))?);
            }
        }
        let (columns, rows) = (detail.columns.max(1), detail.rows.max(1));
        let mut grid = Vec::with_capacity((columns as usize + 1) * (rows as usize + 1));
        for row in 0..=rows {
            for column in 0..=columns {
                let share = DVec2::new(
                    f64::from(column) / f64::from(columns),
                    f64::from(row) / f64::from(rows),
                );
                grid.push(meet(size * share)?);
            }
        }
        Ok(Self {
            outline,
            grid,
            columns,
            rows,
        })
    }

    /// How far the surface within the footprint is from the plane of the corner points: the root mean
    /// square over the grid's points on the surface, in world units, measured across the plane.
    ///
    /// The grid is even in the image, so that each part counts as much as it is seen. The plane goes
    /// through the mean of the corner points, along both diagonals (of three points: through them).
    /// `None` with fewer than three corner points, where they lie on one line, or without a grid point
    /// on the surface.
    pub fn distance_from_corner_plane(&self, scale: &PhotoScale) -> Option<f64> {
        let corners: Vec<DVec3> = scale
            .corners
            .iter()
            .filter_map(super::Corner::point)
            .collect();
        let (middle, normal) = plane_through(&corners)?;
        let mut sum = 0.0;
        let mut count = 0_u32;
        for sample in &self.grid {
            if let CornerOutcome::OnSurface { point, .. } = sample.outcome {
                sum += (point - middle).dot(normal).powi(2);
                count += 1;
            }
        }
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    }
}

/// The plane through three or four corner points, as a point and a unit normal: through their mean,
/// with the normal of the quadrilateral (the cross product of its diagonals), which for four points
/// leaves equal distances on alternating sides. `None` where they span no area.
pub(super) fn plane_through(corners: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let normal = match corners {
        [a, b, c, d] => (*c - *a).cross(*d - *b),
        [a, b, c] => (*b - *a).cross(*c - *a),
        _ => return None,
    };
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    Some((middle, normal.try_normalize()?))
}
