//! The strips that photos lie in: their direction, where an area lies in one, and places along the ground.

use glam::{DMat2, DVec2};

use super::{Ground, MOST};
use crate::geometry::{extent, surrounds};

/// How many steps an edge of a footprint is walked in, along the ground.
const STEPS: f64 = 8.0;

/// A frame of the map: its origin, and the directions along and across the strips.
pub(super) struct Strips {
    pub(super) origin: DVec2,
    pub(super) along: DVec2,
}

impl Strips {
    pub(super) fn place(&self, along: f64, across: f64) -> DVec2 {
        self.origin + self.along * along - self.along.perp() * across
    }

    pub(super) fn strips_from_world(&self, place: DVec2) -> DVec2 {
        let off = place - self.origin;
        DVec2::new(off.dot(self.along), -off.dot(self.along.perp()))
    }
}

impl Ground<'_> {
    /// The direction in which the ground rises most in the mean; of level ground that of the longest side.
    pub(super) fn strips(&self) -> Strips {
        let side = self.footprint().max_element();
        let [min, max] = extent(self.area.corners());
        let mut sum = DMat2::ZERO;
        let mut count = 0_u32;
        let step = ((max - min) / (side / 2.0))
            .ceil()
            .clamp(DVec2::splat(4.0), DVec2::splat(100.0));
        for i in 0..step.x as u32 {
            for j in 0..step.y as u32 {
                let share = (DVec2::new(f64::from(i), f64::from(j)) + 0.5) / step;
                let place = min + (max - min) * share;
                if !surrounds(self.area.corners(), place) {
                    continue;
                }
                if let Some(plane) = self.terrain.plane(place, side) {
                    let slope = -plane.normal.truncate() / plane.normal.z;
                    sum += DMat2::from_cols(slope * slope.x, slope * slope.y);
                    count += 1;
                }
            }
        }
        let longest = self.longest_side();
        let [xx, xy, yy] = [sum.x_axis.x, sum.x_axis.y, sum.y_axis.y];
        // A slope of a few degrees in the mean is level ground.
        if (xx + yy) / f64::from(count.max(1)) < 0.05_f64.powi(2) {
            return longest;
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        Strips {
            along: DVec2::from_angle(angle),
            ..longest
        }
    }

    /// Along the longest side of the area, from its middle.
    pub(super) fn longest_side(&self) -> Strips {
        let corners = self.area.corners();
        let ends = corners.iter().zip(corners.iter().cycle().skip(1));
        let longest = ends
            .map(|(a, b)| *b - *a)
            .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let sum: DVec2 = corners.iter().map(|c| *c - corners[0]).sum();
        Strips {
            origin: corners[0] + sum / corners.len() as f64,
            along: longest.unwrap_or(DVec2::X).normalize_or(DVec2::X),
        }
    }

    /// From where to where the area lies in a strip of this width; `None` where it does not.
    pub(super) fn in_strip(&self, strips: &Strips, across: f64, width: f64) -> Option<(f64, f64)> {
        let corners: Vec<DVec2> = (self.area.corners().iter())
            .map(|&c| strips.strips_from_world(c))
            .collect();
        let (low, high) = (across - width / 2.0, across + width / 2.0);
        let mut range: Option<(f64, f64)> = None;
        let mut add = |along: f64| {
            range = Some(range.map_or((along, along), |(from, to)| {
                (from.min(along), to.max(along))
            }));
        };
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            if (low..=high).contains(&a.y) {
                add(a.x);
            }
            for edge in [low, high] {
                if (a.y > edge) != (b.y > edge) {
                    add(a.x + (edge - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
        }
        range
    }

    /// Places along a line of the map that are `step` apart along the ground, smoothed over a footprint; the first
    /// and the last reach beyond the range by the same.
    pub(super) fn walk(
        &self,
        range: (f64, f64),
        step: f64,
        line: impl Fn(f64) -> DVec2,
    ) -> Vec<f64> {
        let side = self.footprint().max_element();
        // Metres along the ground of a metre of the map.
        let stretch = |at: f64| {
            let direction = (line(at + 1.0) - line(at)).normalize();
            let Some(plane) = self.terrain.plane(line(at), side) else {
                return 1.0;
            };
            let slope = -plane.normal.truncate() / plane.normal.z;
            1.0_f64.hypot(slope.dot(direction))
        };
        // Lengths along the ground from the beginning, at steps of the map.
        let small = step / STEPS;
        let mut lengths = vec![0.0];
        let count = ((range.1 - range.0) / small).ceil().clamp(1.0, 1e6);
        let at = |index: f64| range.0 + (range.1 - range.0) * index / count;
        for index in 0..count as u32 {
            let length = (at(1.0) - at(0.0)) * stretch(at(f64::from(index) + 0.5));
            lengths.push(lengths.last().copied().unwrap_or_default() + length);
        }
        let whole = lengths.last().copied().unwrap_or_default();
        let on_map = |length: f64| {
            let next = lengths.partition_point(|known| *known <= length);
            let next = next.clamp(1, lengths.len() - 1);
            let (a, b) = (lengths[next - 1], lengths[next]);
            at((next - 1) as f64 + (length - a) / (b - a))
        };
        evenly((0.0, whole), step).into_iter().map(on_map).collect()
    }
}

/// The middles of so few pieces of this length that they cover a range, and reach beyond both its ends by the same.
pub(super) fn evenly((from, to): (f64, f64), step: f64) -> Vec<f64> {
    // A range that is a whole number of steps to rounding is that.
    let count = ((to - from) / step - 1e-9).ceil().clamp(1.0, MOST as f64);
    let begin = (from + to) / 2.0 - step * (count - 1.0) / 2.0;
    (0..count as u32)
        .map(|index| begin + step * f64::from(index))
        .collect()
}

pub(super) fn range_of(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}
