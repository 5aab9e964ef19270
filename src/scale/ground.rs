//! The ground: the plane z = ground that a ray falls back to where it misses the surface.

use super::pyramid::Pyramid;
use crate::camera::{Camera, Pose};
use crate::geometry::median;
use crate::surface::{Surface, SurfaceError};

/// How the elevation of the ground is found.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Ground {
    /// For each photo the median elevation of the surface's vertices that project inside its
    /// undistorted image in front of the camera, or of all vertices where none does. A fixed 0, the
    /// paper's, makes the scale of a flight at 160 m five times too small.
    #[default]
    Auto,
    /// An elevation in the world's unit.
    At(f64),
}

/// Finds the ground under photos.
#[derive(Debug)]
pub struct GroundFinder<'a> {
    ground: Ground,
    surface: &'a Surface,
    /// The median of all vertices, once somebody needed it.
    of_all: Option<f64>,
    /// The last answer: the corners of a photo ask one after the other.
    last: Option<(Camera, Pose, f64)>,
}

impl<'a> GroundFinder<'a> {
    /// Finds the ground by this rule on this surface.
    pub fn new(ground: Ground, surface: &'a Surface) -> Self {
        Self {
            ground,
            surface,
            of_all: None,
            last: None,
        }
    }

    /// The elevation of the ground for a photo, in the world's unit.
    ///
    /// # Errors
    /// Where the surface has no vertex.
    pub fn under(&mut self, camera: &Camera, pose: &Pose) -> Result<f64, SurfaceError> {
        if let Ground::At(z) = self.ground {
            return Ok(z);
        }
        if let Some((last_camera, last_pose, z)) = &self.last
            && (last_camera, last_pose) == (camera, pose)
        {
            return Ok(*z);
        }
        let z = match self.median_seen(camera, pose) {
            Some(z) => z,
            None => self.median_of_all()?,
        };
        self.last = Some((camera.clone(), *pose, z));
        Ok(z)
    }

    /// The median elevation of the vertices that the photo shows.
    fn median_seen(&self, camera: &Camera, pose: &Pose) -> Option<f64> {
        let view = Pyramid::of_image(camera, pose.center, pose.rotation);
        let vertices = self.surface.vertices_seen(|bounds| view.misses(bounds));
        let inside = vertices.filter(|&vertex| {
            camera
                .pixel_undistorted(pose.camera_from_world(vertex))
                .is_some_and(|pixel| camera.contains(pixel))
        });
        let mut seen: Vec<f64> = inside.map(|vertex| vertex.z).collect();
        median(&mut seen)
    }

    fn median_of_all(&mut self) -> Result<f64, SurfaceError> {
        if self.of_all.is_none() {
            // Of a part that lacks what the photo may show nobody knows whether it shows none of the cloud.
            if !self.surface.wanted().blocks.is_empty() {
                return Err(SurfaceError::OnlyAPart);
            }
            let mut all: Vec<f64> = self.surface.vertices().map(|vertex| vertex.z).collect();
            self.of_all = median(&mut all);
        }
        self.of_all.ok_or(SurfaceError::TooFewPoints(0))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::camera::Distortion;
    use crate::geometry::Bounds;
    use crate::surface::Cloud;

    /// The definition, vertex by vertex.
    fn brute_force(surface: &Surface, camera: &Camera, pose: &Pose) -> Option<f64> {
        let mut all: Vec<f64> = surface.vertices().map(|vertex| vertex.z).collect();
        let mut seen: Vec<f64> = surface
            .vertices()
            .filter(|&vertex| {
                let pixel = camera.pixel_undistorted(pose.camera_from_world(vertex));
                pixel.is_some_and(|pixel| camera.contains(pixel))
            })
            .map(|vertex| vertex.z)
            .collect();
        median(&mut seen).or_else(|| median(&mut all))
    }

    /// 20 000 points on 200 by 200 in UTM coordinates, as a cloud, or with faces in their order.
    fn surface(as_mesh: bool) -> Surface {
        let points: Vec<DVec3> = (0..20_000_u32)
            .map(|i| {
                let (x, y) = (f64::from(i % 200), f64::from(i / 200) * 2.0);
                DVec3::new(
                    500_000.25 + x,
                    5_000_000.5 + y,
                    100.0 + (x * 0.1).sin() * 9.0 + y * 0.1,
                )
            })
            .collect();
        let triangles = match as_mesh {
            true => (0..19_998).map(|i| [i, i + 1, i + 2]).collect(),
            false => Vec::new(),
        };
        Surface::new(Cloud {
            points,
            triangles,
            ..Cloud::default()
        })
        .unwrap()
    }

    proptest! {
        #[test]
        fn blocks_hide_no_vertex(
            as_mesh in any::<bool>(),
            places in prop::collection::vec(
                (-50.0..250.0_f64, -50.0..250.0_f64, 90.0..260.0_f64, -90.0..90.0_f64, 0.0..360.0_f64),
                1..8,
            ),
            (cx, cy, skew) in (-100.0..900.0_f64, -100.0..700.0_f64, -30.0..30.0_f64),
        ) {
            let surface = surface(as_mesh);
            let camera = Camera {
                name: String::new(), width: 800, height: 600, fx: 700.0, fy: 710.0, cx, cy, skew,
                distortion: Distortion::None,
            };
            let mut finder = GroundFinder::new(Ground::Auto, &surface);
            for (x, y, z, tilt, pan) in places {
                let center = DVec3::new(500_000.0 + x, 5_000_000.0 + y, z);
                let pose = Pose::from_tilt_pan(center, [tilt, pan]);
                let expected = brute_force(&surface, &camera, &pose);
                prop_assert_eq!(finder.under(&camera, &pose).ok(), expected);
                // And from memory.
                prop_assert_eq!(finder.under(&camera, &pose).ok(), expected);
            }
        }

        /// A point on the very edge of the image is inside; its block of one vertex is not culled.
        #[test]
        fn a_block_on_the_edge_is_not_missed(
            u in prop::sample::select(vec![0.0, 400.0, 800.0]),
            v in prop::sample::select(vec![0.0, 300.0, 600.0]),
            depth in 1e-3..1e4_f64,
            tilt in -90.0..90.0_f64,
        ) {
            let camera = Camera {
                name: String::new(), width: 800, height: 600, fx: 700.0, fy: 710.0, cx: 410.0, cy: 290.0,
                skew: 1.5, distortion: Distortion::None,
            };
            let center = DVec3::new(500_000.0, 5_000_000.0, 160.0);
            let pose = Pose::from_tilt_pan(center, [tilt, 33.0]);
            let ray = camera.direction_undistorted(glam::DVec2::new(u, v));
            let point = center + pose.rotation * ray * depth;
            let bounds = Bounds { min: point, max: point };
            prop_assert!(!Pyramid::of_image(&camera, pose.center, pose.rotation).misses(&bounds));
        }
    }
}
