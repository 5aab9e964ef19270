//! What photos may see of the world, about: where a cloud that is larger than the memory is read first. What else
//! turns out to be needed is asked for (`surface::part`).

use glam::{DVec2, DVec3};

use super::ImageKind;
use super::pyramid::Pyramid;
use crate::camera::{Camera, Pose};
use crate::geometry::Bounds;

/// Places along each side of an image whose rays are looked at.
const ALONG_A_SIDE: u32 = 33;

/// What photos may see.
#[derive(Default)]
pub struct Sights {
    pyramids: Vec<Pyramid>,
    /// Where the cameras are: what lies plumb below them is asked for, too.
    centers: Vec<DVec3>,
}

impl Sights {
    /// Adds a photo.
    pub fn add(&mut self, camera: &Camera, pose: &Pose, image: ImageKind) {
        self.centers.push(pose.center);
        self.pyramids
            .push(Pyramid::of_image(camera, pose.center, pose.rotation));
        if image == ImageKind::Undistorted {
            return;
        }
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for step in 0..ALONG_A_SIDE {
            let share = f64::from(step) / f64::from(ALONG_A_SIDE - 1);
            let [x, y] = [share * width, share * height];
            for pixel in [(x, 0.0), (x, height), (0.0, y), (width, y)] {
                if let Ok(direction) = image.direction(camera, pixel.into())
                    && direction.z > 0.0
                {
                    let place = direction.truncate() / direction.z;
                    (min, max) = (min.min(place), max.max(place));
                }
            }
        }
        if min.cmple(max).all() {
            let pyramid = Pyramid::of_directions(min, max, pose.center, pose.rotation);
            self.pyramids.push(pyramid);
        }
    }

    /// Whether no photo sees anything of a box (world), and none stands over it.
    pub fn misses(&self, bounds: &Bounds) -> bool {
        let is_below = |center: &DVec3| {
            let place = center.truncate();
            place.cmpge(bounds.min.truncate()).all() && place.cmple(bounds.max.truncate()).all()
        };
        self.pyramids.iter().all(|pyramid| pyramid.misses(bounds))
            && !self.centers.iter().any(is_below)
    }
}
