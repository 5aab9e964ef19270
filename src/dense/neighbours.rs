//! Which photos to compare a photo with: those that look at the same places from another direction, far
//! enough apart for depth and near enough to look alike.

use glam::DVec3;

use crate::camera::Camera;
use crate::camera::Pose;
use crate::view::View;

/// Angles between rays that serve, degrees; in between the best.
const ANGLES: [f64; 3] = [3.0, 12.0, 30.0];
/// Places that are looked at, along each side of the image and in depth.
const LATTICE: u32 = 5;

/// For each view the others to compare it with, best first, at most `most`.
///
/// Places over the image, at three depths of its range, are looked up in the other views: each that is
/// seen counts by how its angle serves (a bell about 12 degrees, nothing under 3 or over 30) and by how alike the
/// distances are.
#[must_use]
pub fn choose_neighbours(views: &[View], most: usize) -> Vec<Vec<usize>> {
    let of = |(which, view): (usize, &View)| {
        let places = places(view);
        let mut scores: Vec<(f64, usize)> = views
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != which)
            .map(|(other, theirs)| (score(view, theirs, &places), other))
            // A twentieth of the photo in common, well placed.
            .filter(|(score, _)| *score > 0.05 * places.len() as f64)
            .collect();
        scores.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        scores.truncate(most);
        scores.into_iter().map(|(_, other)| other).collect()
    };
    views.iter().enumerate().map(of).collect()
}

fn places(view: &View) -> Vec<DVec3> {
    let [near, far] = view.depths;
    let mut places = Vec::new();
    for share in [0.25, 0.5, 0.75] {
        let depth = (near.recip() + share * (far.recip() - near.recip())).recip();
        for y in 0..LATTICE {
            for x in 0..LATTICE {
                let part =
                    |i: u32, size: u32| f64::from(size) * (f64::from(i) + 0.5) / f64::from(LATTICE);
                let pixel =
                    glam::DVec2::new(part(x, view.camera.width), part(y, view.camera.height));
                let direction = view.camera.direction_undistorted(pixel);
                places.push(view.pose.center + view.pose.rotation * direction * depth);
            }
        }
    }
    places
}

fn score(own: &View, theirs: &View, places: &[DVec3]) -> f64 {
    places
        .iter()
        .filter(|place| sees(&theirs.camera, &theirs.pose, **place))
        .map(|place| {
            let (a, b) = (own.pose.center - *place, theirs.pose.center - *place);
            let angle = a.angle_between(b).to_degrees();
            let [least, best, most] = ANGLES;
            if !(least..=most).contains(&angle) {
                return 0.0;
            }
            let spread = if angle < best { 6.0 } else { 10.0 };
            let distance = (a.length() / b.length()).ln();
            (-0.5 * ((angle - best) / spread).powi(2) - 2.0 * distance * distance).exp()
        })
        .sum()
}

fn sees(camera: &Camera, pose: &Pose, place: DVec3) -> bool {
    let seen = camera.pixel_undistorted(pose.rotation.transpose() * (place - pose.center));
    seen.is_some_and(|pixel| camera.contains(pixel))
}
