//! Where a photo sees a point of the surface, if it does.

use glam::{DVec2, DVec3};

use super::ImageKind;
use super::field::scale_at_point;
use crate::camera::{Camera, Pose};
use crate::geometry::Ray;
use crate::surface::{Caster, Surface};

/// How far before a point the surface may be met, as a share of the distance, when it is the point's own
/// place that was met.
const SAME_PLACE: f64 = 1e-7;

/// Where and how large a photo shows a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// In the image.
    pub pixel: DVec2,
    /// Pixels per world unit there (contract, section 7).
    pub scale: f64,
}

impl Sighting {
    /// Where a photo would show a point of the world if nothing stood in between; `None` beside the image.
    /// Needs no ray: a test of the frustum.
    pub fn in_frame(camera: &Camera, pose: &Pose, image: ImageKind, point: DVec3) -> Option<Self> {
        let in_camera = pose.camera_from_world(point);
        let pixel = image.pixel(camera, in_camera)?;
        if !camera.contains(pixel) {
            return None;
        }
        let scale = scale_at_point(camera, image, in_camera)?;
        Some(Self { pixel, scale })
    }
}

/// Where a photo shows a point of the surface; `None` beside the image, and where the surface itself stands
/// before it. One ray from the camera.
pub fn sighting(
    camera: &Camera,
    pose: &Pose,
    image: ImageKind,
    point: DVec3,
    surface: &Surface,
    caster: &mut Caster<'_>,
) -> Option<Sighting> {
    let seen = Sighting::in_frame(camera, pose, image, point)?;
    let way = point - pose.center;
    let distance = way.length();
    let direction = way.try_normalize()?;
    let ray = Ray {
        origin: pose.center,
        direction,
    };
    let room = distance * SAME_PLACE + 16.0 * surface.slack(pose.center);
    let is_hidden = caster.cast(&ray).is_some_and(|hit| hit.t < distance - room);
    (!is_hidden).then_some(seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Brown, Distortion};
    use crate::surface::Cloud;

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width: 2000,
            height: 1000,
            fx: 1000.0,
            fy: 1000.0,
            cx: 1000.0,
            cy: 500.0,
            skew: 0.0,
            distortion,
        }
    }

    /// A level square with a wall along y = 0, 2 high.
    fn wall() -> Surface {
        let points = [
            (-9.0, -9.0, 0.0),
            (9.0, -9.0, 0.0),
            (9.0, 9.0, 0.0),
            (-9.0, 9.0, 0.0),
            (-9.0, 0.0, 0.0),
            (9.0, 0.0, 0.0),
            (9.0, 0.0, 2.0),
            (-9.0, 0.0, 2.0),
        ];
        Surface::new(Cloud {
            points: points.map(|(x, y, z)| DVec3::new(x, y, z)).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            ..Cloud::default()
        })
        .unwrap()
    }

    /// From 10 above (0, -3): 100 px a unit, x to the right, y up in the image. What lies behind the wall
    /// up to where the ray over its crest comes down, at y = 0.75, is hidden.
    #[test]
    fn what_stands_before_hides() {
        let surface = wall();
        let mut caster = surface.caster().unwrap();
        let camera = camera(Distortion::None);
        let center = DVec3::new(0.0, -3.0, 10.0);
        let pose = Pose::from_yaw_pitch_roll(center, [0.0, -90.0, 0.0]);
        let kind = ImageKind::Undistorted;
        let mut at = |x, y, z| {
            let point = DVec3::new(x, y, z);
            sighting(&camera, &pose, kind, point, &surface, &mut caster)
        };
        let seen = at(1.0, -1.0, 0.0).unwrap();
        assert!(seen.pixel.distance(DVec2::new(1100.0, 300.0)) < 1e-9);
        assert!((seen.scale - 100.0).abs() < 1e-9);
        assert_eq!(at(0.0, 0.5, 0.0), None);
        assert!(at(0.0, 0.76, 0.0).is_some());
        assert_eq!(at(0.0, 0.74, 0.0), None);
        // On the crest: 8 below the camera.
        assert!((at(0.0, 0.0, 2.0).unwrap().scale - 125.0).abs() < 1e-9);
        // Beside the image, whatever stands there.
        assert_eq!(at(0.0, 2.5, 0.0), None);
        let point = DVec3::new(0.0, 0.5, 0.0);
        assert!(Sighting::in_frame(&camera, &pose, kind, point).is_some());
    }

    /// A lens that pushes outwards by 1 + r^2 / 10: at r = 0.5 the image as shot has 0.5125, and the scale
    /// is larger by the root of (1 + r^2 / 10)(1 + 3 r^2 / 10).
    #[test]
    fn as_shot_the_lens_counts() {
        let lens = Brown::new([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let camera = camera(Distortion::Brown(lens));
        let pose = Pose::from_yaw_pitch_roll(DVec3::new(0.0, 0.0, 10.0), [0.0, -90.0, 0.0]);
        let point = DVec3::new(5.0, 0.0, 0.0);
        let seen = Sighting::in_frame(&camera, &pose, ImageKind::AsShot, point).unwrap();
        assert!(seen.pixel.distance(DVec2::new(1512.5, 500.0)) < 1e-9);
        let stretch = (1.025_f64 * 1.075).sqrt();
        assert!((seen.scale - 100.0 * stretch).abs() < 1e-6);
        let undistorted = DVec2::new(1500.0, 500.0);
        let other = ImageKind::AsShot.pixel_from(ImageKind::Undistorted, &camera, undistorted);
        assert!(other.unwrap().distance(seen.pixel) < 1e-9);
        let back = ImageKind::Undistorted.pixel_from(ImageKind::AsShot, &camera, seen.pixel);
        assert!(back.unwrap().distance(undistorted) < 1e-6);
    }
}
