//! What the window shows of a surface of millions of points while it is read: a sample of them, which can be
//! turned. It goes when the flight is there, or when opening it is cancelled. And of a model while it is
//! reconstructed: its points and the cameras found so far.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec2, DVec3};

use crate::camera::Pose;
use crate::command::view_change::ViewChange;
use crate::geometry::{Bounds, LocalFrame};
use crate::opening::SurfaceSample;
use crate::reconstruct::Growth;
use crate::render::{Gpu, Orbit, SurfaceBuffers};
use crate::surface::{Cloud, bulk_of};

/// How long a camera's pyramid is, as a share of the model.
const CAMERA: f64 = 0.025;

/// A sample of the surface that is being read.
#[derive(Debug)]
pub struct OpeningPreview {
    /// On the graphics device, where there is one.
    pub points: Option<Arc<SurfaceBuffers>>,
    /// How many they are.
    pub count: usize,
    /// How many points there will be, or are in the model.
    pub of: u64,
    /// Of a model that grows, each camera's centre with the corners of what it looks at; else empty.
    pub cameras: Vec<[DVec3; 5]>,
    /// Of a model that grows, how many photos are to be placed.
    photos: Option<usize>,
    /// Where coordinates are small.
    pub frame: LocalFrame,
    /// How it is looked at.
    pub orbit: Orbit,
    /// Around it, without outliers.
    bulk: Bounds,
    /// Whether the engineer has turned it.
    turned: bool,
    /// The viewport's size that it was fitted into.
    size: Option<DVec2>,
}

impl OpeningPreview {
    /// Makes a sample ready and uploads it: work for a job. `None` without a point.
    pub fn new(gpu: Option<&Gpu>, sample: SurfaceSample) -> Option<Self> {
        let SurfaceSample { cloud, of } = sample;
        let bounds = Bounds::of(&cloud.points)?;
        let bulk = bulk_of(&cloud.points)?;
        let frame = LocalFrame::near(&bounds);
        let upload = |gpu| SurfaceBuffers::of_points(gpu, &frame, &cloud.points, &cloud.colors);
        let mut orbit = Orbit::new(&bulk);
        // As a flight is looked at first.
        orbit.pitch = 0.9;
        Some(Self {
            points: gpu.map(|gpu| Arc::new(upload(gpu))),
            count: cloud.points.len(),
            of,
            cameras: Vec::new(),
            photos: None,
            frame,
            orbit,
            bulk,
            turned: false,
            size: None,
        })
    }

    /// A model while it grows, turned so that its cameras look down on the whole. Who has turned the one
    /// `before` goes on looking from there. `None` without a point.
    pub fn growing(gpu: Option<&Gpu>, growth: Growth, before: Option<&Self>) -> Option<Self> {
        let Growth {
            mut points,
            colors,
            of,
            mut cameras,
            photos,
        } = growth;
        let ahead: DVec3 = cameras.iter().map(|camera| camera.rotation.z_axis).sum();
        let ahead = ahead.try_normalize().unwrap_or(DVec3::NEG_Z);
        let down = DMat3::from_quat(DQuat::from_rotation_arc(ahead, DVec3::NEG_Z));
        for point in &mut points {
            *point = down * *point;
        }
        for camera in &mut cameras {
            camera.center = down * camera.center;
            camera.rotation = down * camera.rotation;
        }
        let cloud = Cloud {
            points,
            colors,
            ..Cloud::default()
        };
        let mut next = Self::new(
            gpu,
            SurfaceSample {
                cloud,
                of: of as u64,
            },
        )?;
        for camera in &cameras {
            next.bulk.min = next.bulk.min.min(camera.center);
            next.bulk.max = next.bulk.max.max(camera.center);
        }
        let size = next.bulk.size().length() * CAMERA;
        let corners = [(-0.7, -0.5), (0.7, -0.5), (0.7, 0.5), (-0.7, 0.5)];
        let pyramid = |camera: &Pose| {
            let corner = |(x, y)| camera.center + camera.rotation * DVec3::new(x, y, 1.0) * size;
            let [a, b, c, d] = corners.map(corner);
            [camera.center, a, b, c, d]
        };
        next.cameras = cameras.iter().map(pyramid).collect();
        next.photos = Some(photos);
        if let Some(before) = before.filter(|before| before.turned) {
            (next.orbit, next.turned) = (before.orbit, true);
        }
        Some(next)
    }

    /// Turns it.
    pub fn change_view(&mut self, change: ViewChange) {
        let orbit = &mut self.orbit;
        match change {
            ViewChange::Orbit(delta) => orbit.orbit(delta),
            ViewChange::Pan(delta, size) => orbit.pan(delta, size),
            ViewChange::Zoom {
                cursor,
                size,
                factor,
            } => orbit.zoom_to(cursor, size, factor, None),
            ViewChange::Resized(size) => self.fit(size),
            _ => {}
        }
        self.turned |= !matches!(change, ViewChange::Resized(_));
    }

    /// All of it in sight, as long as nobody has turned it.
    fn fit(&mut self, size: DVec2) {
        self.size = Some(size);
        if !self.turned {
            let (low, high) = (self.bulk.min, self.bulk.max);
            let ends = [low, high];
            let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| {
                let end = |bit: usize| ends[corner >> bit & 1];
                DVec3::new(end(0).x, end(1).y, end(2).z)
            });
            self.orbit.fit_into(&corners, size);
        }
    }

    /// Whether it was fitted into a viewport of this size.
    pub fn is_seen_in(&self, size: DVec2) -> bool {
        self.size == Some(size)
    }

    /// In a sentence.
    pub fn in_words(&self) -> String {
        if let Some(photos) = self.photos {
            return format!(
                "The model grows: {} of {photos} photos placed, {} points",
                self.cameras.len(),
                thousands(self.of)
            );
        }
        format!(
            "A first look: {} of {} points, while all are read",
            thousands(self.count as u64),
            thousands(self.of)
        )
    }
}

/// A number with a space after each three digits.
fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        let numbers = [0, 999, 1000, 12_345, 100_000_000];
        let texts = ["0", "999", "1 000", "12 345", "100 000 000"];
        assert_eq!(numbers.map(thousands), texts);
    }
}
