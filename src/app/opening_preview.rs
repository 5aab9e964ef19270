//! What the window shows of a surface of millions of points while it is read: a sample of them, which can be
//! turned. It goes when the flight is there, or when opening it is cancelled.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::command::ViewChange;
use crate::geometry::{Bounds, LocalFrame};
use crate::opening::SurfaceSample;
use crate::render::{Gpu, Orbit, SurfaceBuffers};
use crate::surface::bulk_of;

/// A sample of the surface that is being read.
#[derive(Debug)]
pub struct OpeningPreview {
    /// On the graphics device, where there is one.
    pub points: Option<Arc<SurfaceBuffers>>,
    /// How many they are.
    pub count: usize,
    /// How many points there will be.
    pub of: u64,
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
            frame,
            orbit,
            bulk,
            turned: false,
            size: None,
        })
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
