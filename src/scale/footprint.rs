//! The footprint: the image outline on the surface, and a grid inside it.
//!
//! Corners are what scales are made of; the footprint is what people look at, what maps show, and
//! what tells whether the surface between the corners is as flat as four corners pretend.

use glam::{DVec2, DVec3};

use super::field::meet_rays;
use super::{CornerOutcome, FieldError, GroundFinder, ImageKind, PhotoScale};
use crate::camera::{Camera, Pose};
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::surface::Caster;

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
    /// Meets the rays of a footprint with the surface of a caster. Rays that miss the surface are met with the ground, as those
    /// of the corners are.
    ///
    /// # Errors
    /// Where no ground can be found although it is needed, or the work was cancelled.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        detail: FootprintDetail,
        ground: &mut GroundFinder<'_>,
        caster: &mut Caster<'_>,
        progress: &Progress,
    ) -> Result<Self, FieldError> {
        let pixels = pixels(camera, detail);
        let directions: Vec<_> = (pixels.iter())
            .map(|&pixel| image.direction(camera, pixel))
            .collect();
        let rays: Vec<Option<DVec3>> = directions
            .iter()
            .map(|direction| Some(direction.as_ref().ok()?.normalize()))
            .collect();
        let hits = meet_rays(&rays, pose, caster, progress)?;
        let mut points = Vec::with_capacity(pixels.len());
        for ((&pixel, hit), direction) in pixels.iter().zip(&hits).zip(directions) {
            let outcome = match (direction, hit) {
                (Err(not_invertible), _) => CornerOutcome::NoRay(not_invertible),
                (Ok(_), Some(hit)) => CornerOutcome::OnSurface {
                    distance: hit.distance,
                    point: hit.point,
                    longest_edge: hit.longest_edge,
                },
                (Ok(direction), None) => {
                    let ray = Ray {
                        origin: pose.center,
                        direction: (pose.rotation * direction).normalize(),
                    };
                    super::meet_ground(&ray, ground.under(camera, pose)?)
                }
            };
            points.push(FootprintPoint { pixel, outcome });
        }
        let per_edge = detail.per_edge.max(1) as usize;
        let grid = points.split_off((4 * per_edge).min(points.len()));
        Ok(Self {
            outline: points,
            grid,
            columns: detail.columns.max(1),
            rows: detail.rows.max(1),
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

/// The pixels of a footprint: its outline, and its grid.
fn pixels(camera: &Camera, detail: FootprintDetail) -> Vec<DVec2> {
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let corners = [
        DVec2::ZERO,
        DVec2::new(size.x, 0.0),
        size,
        DVec2::new(0.0, size.y),
    ];
    let per_edge = detail.per_edge.max(1);
    let outline = (0..4).flat_map(|edge| {
        let (from, to) = (corners[edge], corners[(edge + 1) % 4]);
        (0..per_edge).map(move |step| from.lerp(to, f64::from(step) / f64::from(per_edge)))
    });
    let (columns, rows) = (detail.columns.max(1), detail.rows.max(1));
    let grid = (0..=rows).flat_map(|row| {
        (0..=columns).map(move |column| {
            let share = DVec2::new(
                f64::from(column) / f64::from(columns),
                f64::from(row) / f64::from(rows),
            );
            size * share
        })
    });
    outline.chain(grid).collect()
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
