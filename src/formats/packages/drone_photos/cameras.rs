//! The cameras of photos without a reconstruction: one a maker, model, serial number, image size and
//! source of the focal length.

use crate::camera::Camera;
use crate::photos::photo_metadata::{FocalCandidate, FocalSource, PhotoMetadata};

/// How far, as a part, focal lengths of one camera may differ before they are a zoom's.
const SAME_FOCAL_LENGTH: f64 = 1e-3;

/// The cameras found so far.
#[derive(Debug, Default)]
pub struct Cameras {
    cameras: Vec<(Key, Camera, FocalCandidate)>,
}

#[derive(Debug, PartialEq, Eq)]
struct Key {
    device: [Option<String>; 4],
    size: (u32, u32),
    source: FocalSource,
}

impl Cameras {
    /// The number of the photo's camera; `None` where its metadata hold no focal length.
    pub fn of(&mut self, photo: &PhotoMetadata) -> Option<usize> {
        let focal = *photo.focal.first()?;
        let key = Key {
            device: [&photo.make, &photo.model, &photo.serial, &photo.lens].map(Clone::clone),
            size: photo.size,
            source: focal.source,
        };
        let same = |(other, _, known): &(Key, Camera, FocalCandidate)| {
            let is_close = |a: f64, b: f64| (a / b - 1.0).abs() < SAME_FOCAL_LENGTH;
            *other == key && is_close(known.fx, focal.fx) && is_close(known.fy, focal.fy)
        };
        if let Some(index) = self.cameras.iter().position(same) {
            return Some(index);
        }
        let index = self.cameras.len();
        let camera = Camera {
            name: self.name(photo),
            width: photo.size.0,
            height: photo.size.1,
            fx: focal.fx,
            fy: focal.fy,
            cx: focal.cx,
            cy: focal.cy,
            skew: 0.0,
            distortion: focal.distortion,
        };
        camera.validate().ok()?;
        self.cameras.push((key, camera, focal));
        Some(index)
    }

    /// The camera of a number that [`Self::of`] gave, and what states it.
    pub fn at(&self, number: usize) -> Option<(&Camera, &FocalCandidate)> {
        let (_, camera, focal) = self.cameras.get(number)?;
        Some((camera, focal))
    }

    /// "DJI FC6310R", and a number where that name is taken.
    fn name(&self, photo: &PhotoMetadata) -> String {
        let name = photo.camera_name();
        let is_free = |name: &String| self.cameras.iter().all(|(_, c, _)| c.name != *name);
        let numbered = (2..).map(|number| format!("{name} {number}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        names.find(is_free).unwrap_or(name)
    }

    /// Where each focal length comes from and how far off it may be.
    pub(super) fn warnings(&self, photos: &[&PhotoMetadata]) -> Vec<String> {
        let sentence = |(_, camera, focal): &(Key, Camera, FocalCandidate)| {
            let without = match focal.distortion.coefficients().is_empty() {
                true => ", and the lens's distortion is not known",
                false => "",
            };
            format!(
                "camera '{}': the focal length {:.1} px is from {}; expect {:.1} % of error in it and in every scale{without}",
                camera.name,
                focal.fx,
                focal.source.in_words(),
                focal.relative_error * 100.0
            )
        };
        let mut warnings: Vec<String> = self.cameras.iter().map(sentence).collect();
        // Two sources that contradict each other beyond their errors: one of them is wrong.
        for (key, camera, focal) in &self.cameras {
            let others = photos.iter().filter(|photo| {
                let device = [&photo.make, &photo.model, &photo.serial, &photo.lens];
                device.map(Clone::clone) == key.device && photo.size == key.size
            });
            let other = others.flat_map(|photo| &photo.focal).find(|other| {
                let apart = (other.fx / focal.fx - 1.0).abs();
                apart > other.relative_error + focal.relative_error
            });
            if let Some(other) = other {
                warnings.push(format!(
                    "camera '{}': {} would give {:.1} px",
                    camera.name,
                    other.source.in_words(),
                    other.fx
                ));
            }
        }
        warnings
    }

    /// How far the focal length of the worst camera is expected to be off, a part of it.
    pub(super) fn largest_error(&self) -> Option<f64> {
        let errors = self
            .cameras
            .iter()
            .map(|(_, _, focal)| focal.relative_error);
        errors.reduce(f64::max)
    }

    pub(super) fn into_cameras(self) -> Vec<Camera> {
        self.cameras
            .into_iter()
            .map(|(_, camera, _)| camera)
            .collect()
    }
}
