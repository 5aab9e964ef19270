//! A photo made ready to be drawn: its camera, corner rays and footprint in the local frame.

use glam::{DMat3, DMat4, DVec2, DVec3};

use crate::camera::{Camera, Pose};
use crate::flight::{PhotoReview, Review};
use crate::geometry::{Bounds, LocalFrame};
use crate::scale::{CornerOutcome, FootprintPoint, PhotoScale, ViewFacts};

/// A corner ray's end, or a stretch of the outline: where, and whether it fell back to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Met {
    /// In the local frame.
    pub(crate) point: DVec3,
    pub(crate) on_ground: bool,
}

/// A photo made ready: camera, corner rays and footprint. In f64, because its lines are put
/// together anew for every change of looks.
#[derive(Debug, Clone)]
pub struct PhotoGeometry {
    /// The camera centre in the local frame.
    pub(crate) center: DVec3,
    /// Camera axes in the world, as columns.
    pub(crate) rotation: DMat3,
    pub(crate) camera: Camera,
    /// Where the corner rays end, in the contract's order.
    pub(crate) corners: [Option<Met>; 4],
    /// Around the footprint; closed.
    pub(crate) outline: Vec<Option<Met>>,
    /// Two triangles for each cell of the footprint that lies on the ground, where no surface is
    /// that the fill could lie on; in the local frame.
    pub(crate) ground_cells: Vec<[DVec3; 3]>,
    /// The image corners as shares of the undistorted image, where all four have rays.
    pub(crate) image_corners: Option<[DVec2; 4]>,
    /// Depths along the axis of the footprint's points, sorted, world units.
    pub(crate) depths: Vec<f64>,
}

impl PhotoGeometry {
    /// From the camera and pose of a photo, its corner points where it has a scale, and its
    /// footprint where it is known.
    pub fn new(
        frame: &LocalFrame,
        camera: &Camera,
        pose: &Pose,
        scale: Option<&PhotoScale>,
        view: Option<&ViewFacts>,
    ) -> Self {
        let met = |outcome: &CornerOutcome| {
            outcome.point().map(|point| Met {
                point: frame.local_from_world(point),
                on_ground: !outcome.is_on_surface(),
            })
        };
        let corners = scale.map_or([None; 4], |scale| {
            std::array::from_fn(|i| met(&scale.corners[i].outcome))
        });
        let footprint = view.map(|view| &view.footprint);
        let sampled = |points: &[FootprintPoint]| -> Vec<Option<Met>> {
            points.iter().map(|sample| met(&sample.outcome)).collect()
        };
        let grid = footprint.map(|footprint| sampled(&footprint.grid));
        let columns = footprint.map_or(0, |footprint| footprint.columns as usize);
        let center = frame.local_from_world(pose.center);
        let axis = pose.rotation.z_axis;
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let mut image_corners = Some([DVec2::ZERO; 4]);
        for i in 0..4 {
            let share = scale
                .and_then(|scale| scale.corners[i].direction)
                .and_then(|direction| {
                    camera.pixel_undistorted(pose.rotation.transpose() * direction)
                })
                .map(|pixel| pixel / size);
            image_corners = image_corners.zip(share).map(|(mut corners, share)| {
                corners[i] = share;
                corners
            });
        }
        let seen = grid.iter().flatten().chain(&corners).flatten();
        let mut depths: Vec<f64> = seen.map(|met| (met.point - center).dot(axis)).collect();
        depths.sort_unstable_by(f64::total_cmp);
        Self {
            center,
            rotation: pose.rotation,
            camera: camera.clone(),
            corners,
            outline: footprint.map_or_else(Vec::new, |footprint| sampled(&footprint.outline)),
            ground_cells: grid.map_or_else(Vec::new, |grid| ground_cells(&grid, columns)),
            image_corners,
            depths,
        }
    }

    /// Of all photos of a review, in the flight's order.
    pub fn of_review(frame: &LocalFrame, review: &Review) -> Vec<Self> {
        let of = |photo: PhotoReview<'_>| {
            let pose = &photo.photo.pose;
            Self::new(frame, photo.camera, pose, photo.scale(), photo.view)
        };
        review.photos().map(of).collect()
    }

    /// Local coordinates to shares of the undistorted image: (u w, v w, w, 1) with w the depth along
    /// the axis in world units; (u, v) is (0, 0) at the top left corner and (1, 1) at the opposite
    /// one.
    pub(crate) fn image_from_local(&self) -> DMat4 {
        let camera = &self.camera;
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let shares = DMat3::from_cols(
            DVec3::new(camera.fx / w, 0.0, 0.0),
            DVec3::new(camera.skew / w, camera.fy / h, 0.0),
            DVec3::new(camera.cx / w, camera.cy / h, 1.0),
        );
        let linear = shares * self.rotation.transpose();
        DMat4::from_cols(
            linear.x_axis.extend(0.0),
            linear.y_axis.extend(0.0),
            linear.z_axis.extend(0.0),
            (-(linear * self.center)).extend(1.0),
        )
    }

    /// The point of the image, given as a share of the undistorted one, at a depth along the axis;
    /// in the local frame.
    pub(crate) fn point_at(&self, share: DVec2, depth: f64) -> DVec3 {
        let size = DVec2::new(f64::from(self.camera.width), f64::from(self.camera.height));
        let direction = self.camera.direction_undistorted(share * size);
        self.center + self.rotation * direction * depth
    }

    /// The corners of the image plane at a depth along the axis, in the contract's order.
    pub(crate) fn image_plane(&self, depth: f64) -> [DVec3; 4] {
        [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|share| self.point_at(share, depth))
    }

    /// The depth along the axis that this share of the footprint, 0 to 1, is nearer than.
    pub(crate) fn depth_of_share(&self, share: f64) -> Option<f64> {
        let last = self.depths.len().checked_sub(1)?;
        // `as` saturates.
        self.depths
            .get((last as f64 * share).round() as usize)
            .copied()
    }

    /// Pixels per world unit of the photo all over its footprint.
    pub fn scales(&self) -> impl Iterator<Item = f64> {
        self.depths.iter().map(|&depth| self.scale_at(depth))
    }

    /// Pixels per world unit of the photo at a depth along its axis.
    pub(crate) fn scale_at(&self, depth: f64) -> f64 {
        (self.camera.fx * self.camera.fy).sqrt() / depth
    }

    /// Its extent in the world.
    pub fn bounds(&self, frame: &LocalFrame) -> Bounds {
        let corners = self.corners.iter().flatten().map(|met| met.point);
        let (mut min, mut max) = (self.center, self.center);
        for point in corners {
            (min, max) = (min.min(point), max.max(point));
        }
        Bounds {
            min: frame.world_from_local(min),
            max: frame.world_from_local(max),
        }
    }
}

fn ground_cells(grid: &[Option<Met>], columns: usize) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    let width = columns + 1;
    for (above, below) in grid.chunks(width).zip(grid.chunks(width).skip(1)) {
        for (above, below) in above.windows(2).zip(below.windows(2)) {
            let cell = [above[0], above[1], below[1], below[0]];
            if let [Some(a), Some(b), Some(c), Some(d)] = cell
                && [a, b, c, d].iter().all(|met| met.on_ground)
            {
                triangles.push([a.point, b.point, c.point]);
                triangles.push([a.point, c.point, d.point]);
            }
        }
    }
    triangles
}
