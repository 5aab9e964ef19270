//! Turning around what one looks at: the mouse's view of the world, without a window.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::{Projection, View};
use crate::geometry::Bounds;

/// Radians of turn a pixel of mouse movement.
const RADIANS_PER_PIXEL: f64 = 0.005;
/// Angle between top and bottom edge in perspective.
const FOV_Y: f64 = 45.0 * TAU / 360.0;
/// Share of the viewport that what is fitted fills.
const FILLED: f64 = 0.92;

/// An eye that turns around a target, with the world's z up in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// The point in the middle of the viewport, in the world.
    pub target: DVec3,
    /// From the eye to the target, world units, > 0.
    pub distance: f64,
    /// Which way the eye looks, radians clockwise from world +y seen from above.
    pub yaw: f64,
    /// How far the eye looks down, radians: pi/2 is straight down.
    pub pitch: f64,
    /// Parallel lines of sight instead of perspective.
    pub orthographic: bool,
    /// The radius of what there is to see, world units: how far it can be zoomed in and out.
    pub extent: f64,
}

impl Orbit {
    /// Looks at all of `bounds` from the south and above.
    pub fn new(bounds: &Bounds) -> Self {
        let mut orbit = Self {
            target: bounds.center(),
            distance: 1.0,
            yaw: 0.0,
            pitch: 0.6,
            orthographic: false,
            extent: 1.0,
        };
        orbit.fit(bounds);
        orbit
    }

    /// The mouse moved by `delta` pixels: the scene turns with it.
    pub fn orbit(&mut self, delta: DVec2) {
        self.yaw = (self.yaw + delta.x * RADIANS_PER_PIXEL).rem_euclid(TAU);
        self.pitch = (self.pitch + delta.y * RADIANS_PER_PIXEL).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// The mouse moved by `delta` pixels in a viewport of `size`: the target's plane moves with it.
    pub fn pan(&mut self, delta: DVec2, size: DVec2) {
        let unit = self.distance / self.view().pixels_per_unit(size, 1.0);
        let unit = if self.orthographic {
            1.0 / self.view().pixels_per_unit(size, 1.0)
        } else {
            unit
        };
        let axes = self.axes();
        self.target -= (axes.x_axis * delta.x + axes.y_axis * delta.y) * unit;
    }

    /// Comes closer (`factor` < 1) or goes away (> 1), keeping what is under the cursor under it:
    /// `point` in the world, or where there is none the point of the target's plane.
    pub fn zoom_to(&mut self, cursor: DVec2, size: DVec2, factor: f64, point: Option<DVec3>) {
        let nearest = self.extent * 1e-5;
        let distance = (self.distance * factor).clamp(nearest, self.extent * 100.0);
        let factor = distance / self.distance;
        if !factor.is_finite() {
            return;
        }
        let view = self.view();
        let forward = view.world_from_view.z_axis;
        let fixed = point.or_else(|| {
            let ray = view.ray(cursor, size);
            let t = (self.target - ray.origin).dot(forward) / ray.direction.dot(forward);
            t.is_finite().then(|| ray.at(t))
        });
        let fixed = fixed.unwrap_or(self.target);
        // Everything shrinks around the fixed point: the target, and the eye with it.
        self.target = fixed + (self.target - fixed) * factor;
        self.distance = distance;
    }

    /// Turns around `point` from now on, at the same distance and in the same direction.
    pub fn center_on(&mut self, point: DVec3) {
        self.target = point;
    }

    /// Puts all of `bounds` into any viewport that is not higher than wide, in the same direction,
    /// and turns around its middle from now on.
    pub fn fit(&mut self, bounds: &Bounds) {
        // A single point has no size to fit.
        let radius = (bounds.size().length() * 0.5).max(1e-3);
        self.target = bounds.center();
        self.extent = radius;
        self.distance = radius / (FOV_Y * 0.5).sin();
    }

    /// Puts all of `points` into the middle of a viewport of this shape, as large as they fit, in the
    /// same direction. Nothing happens without points.
    pub fn fit_into(&mut self, points: &[DVec3], size: DVec2) {
        let Some(bounds) = Bounds::of(points) else {
            return;
        };
        self.fit(&bounds);
        let slope = (FOV_Y * 0.5).tan() * FILLED;
        let slopes = DVec2::new(slope * size.x / size.y, slope);
        let axes = self.axes();
        let view_from_world = axes.transpose();
        // Near points reach farther out of the picture than far ones: the middle of what is seen is
        // not that of the box. A few steps find it.
        for _ in 0..6 {
            let target = self.target;
            let seen = || points.iter().map(|&p| view_from_world * (p - target));
            let nearest = self.extent * 1e-3;
            self.distance = seen()
                .map(|p| {
                    let across = (p.truncate().abs() / slopes).max_element();
                    if self.orthographic {
                        across
                    } else {
                        across - p.z
                    }
                })
                .fold(nearest, f64::max);
            let (distance, parallel) = (self.distance, self.orthographic);
            let places =
                || seen().map(|p| p.truncate() / if parallel { distance } else { distance + p.z });
            let min = places().fold(DVec2::INFINITY, DVec2::min);
            let max = places().fold(DVec2::NEG_INFINITY, DVec2::max);
            let off = (min + max) * 0.5 * distance;
            self.target += axes.x_axis * off.x + axes.y_axis * off.y;
        }
    }

    /// Looks straight down, world +y up in the picture.
    pub fn top(&mut self) {
        (self.yaw, self.pitch) = (0.0, FRAC_PI_2);
    }

    /// Looks north, level.
    pub fn front(&mut self) {
        (self.yaw, self.pitch) = (0.0, 0.0);
    }

    /// Looks west, level.
    pub fn side(&mut self) {
        (self.yaw, self.pitch) = (TAU * 0.75, 0.0);
    }

    /// Looks from the opposite side: from below where it was from above, from the north where it was from
    /// the south.
    pub fn opposite(&mut self) {
        self.yaw = (self.yaw + TAU * 0.5).rem_euclid(TAU);
        self.pitch = -self.pitch;
    }

    /// The eye goes so far around the target to the left and up, radians; not beyond straight above.
    pub fn turn(&mut self, left: f64, up: f64) {
        self.yaw = (self.yaw + left).rem_euclid(TAU);
        self.pitch = (self.pitch + up).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// The view from here.
    pub fn view(&self) -> View {
        let axes = self.axes();
        let (distance, projection) = if self.orthographic {
            // As large as perspective shows the target; from outside of everything, so that rays
            // from the eye miss nothing.
            let height = 2.0 * self.distance * (FOV_Y * 0.5).tan();
            let away = self.distance + 4.0 * self.extent;
            (away, Projection::Orthographic { height })
        } else {
            (self.distance, Projection::Perspective { fov_y: FOV_Y })
        };
        View {
            eye: self.target - axes.z_axis * distance,
            world_from_view: axes,
            projection,
            focus: distance,
        }
    }

    /// View axes in the world: x right, y down, z forward.
    fn axes(&self) -> DMat3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        let level = DVec3::new(sin_yaw, cos_yaw, 0.0);
        let forward = level * cos_pitch - DVec3::Z * sin_pitch;
        let right = DVec3::new(cos_yaw, -sin_yaw, 0.0);
        DMat3::from_cols(right, forward.cross(right), forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: DVec2 = DVec2::new(1280.0, 720.0);

    fn box_of_30() -> Bounds {
        let origin = DVec3::new(500_000.0, 5_000_000.0, 160.0);
        Bounds {
            min: origin,
            max: origin + DVec3::new(30.0, 20.0, 5.0),
        }
    }

    fn both_kinds() -> [Orbit; 2] {
        let perspective = Orbit::new(&box_of_30());
        let orthographic = true;
        [
            perspective,
            Orbit {
                orthographic,
                ..perspective
            },
        ]
    }

    /// What is under the cursor stays under it, however often one zooms; with a point of the surface,
    /// and with none.
    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let cursor = DVec2::new(900.0, 250.0);
        for mut orbit in both_kinds() {
            let point = orbit.view().ray(cursor, SIZE).at(orbit.view().focus * 1.2);
            for factor in [0.8, 0.8, 0.5, 1.7] {
                orbit.zoom_to(cursor, SIZE, factor, Some(point));
                let seen = orbit.view().project(point, SIZE).unwrap();
                assert!(seen.distance(cursor) < 1e-6, "{seen}");
            }
            let distance = orbit.distance;
            orbit.zoom_to(cursor, SIZE, 0.5, None);
            assert!((orbit.distance / distance - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn zooming_has_its_limits() {
        for mut orbit in both_kinds() {
            for factor in [1e-9, 1e-9, 0.0] {
                orbit.zoom_to(SIZE * 0.5, SIZE, factor, None);
            }
            assert!(orbit.distance > 0.0 && orbit.view().eye.is_finite());
            orbit.zoom_to(SIZE * 0.5, SIZE, f64::INFINITY, None);
            assert!(orbit.distance.is_finite() && orbit.target.is_finite());
        }
    }

    /// The target was in the middle; panned by some pixels, it is seen that far from it.
    #[test]
    fn panning_moves_the_target_with_the_mouse() {
        for mut orbit in both_kinds() {
            let (before, delta) = (orbit.target, DVec2::new(120.0, -45.0));
            orbit.pan(delta, SIZE);
            let seen = orbit.view().project(before, SIZE).unwrap();
            assert!((seen - SIZE * 0.5).distance(delta) < 1e-6, "{seen}");
        }
    }

    #[test]
    fn directions_are_those_of_a_map() {
        for mut orbit in both_kinds() {
            let seen = |orbit: &Orbit, direction: DVec3| {
                let at = orbit.target + direction;
                orbit.view().project(at, SIZE).unwrap() - SIZE * 0.5
            };
            let right = |v: DVec2| v.x > 1.0 && v.y.abs() < 1e-6;
            let up = |v: DVec2| v.y < -1.0 && v.x.abs() < 1e-6;
            orbit.top();
            assert!(right(seen(&orbit, DVec3::X)) && up(seen(&orbit, DVec3::Y)));
            orbit.front();
            assert!(right(seen(&orbit, DVec3::X)) && up(seen(&orbit, DVec3::Z)));
            orbit.side();
            assert!(right(seen(&orbit, DVec3::Y)) && up(seen(&orbit, DVec3::Z)));
            // From the west, the north, and from below with north up.
            orbit.opposite();
            assert!(right(seen(&orbit, DVec3::NEG_Y)) && up(seen(&orbit, DVec3::Z)));
            orbit.front();
            orbit.opposite();
            assert!(right(seen(&orbit, DVec3::NEG_X)) && up(seen(&orbit, DVec3::Z)));
            orbit.top();
            orbit.opposite();
            assert!(right(seen(&orbit, DVec3::NEG_X)) && up(seen(&orbit, DVec3::Y)));
            // A quarter to the left of the south is the west.
            orbit.front();
            orbit.turn(TAU / 4.0, 0.1);
            assert!(orbit.view().eye.x < orbit.target.x && orbit.view().eye.z > orbit.target.z);
            assert!(seen(&orbit, DVec3::NEG_Y).x > 1.0);
            // Beyond straight down the world does not turn over.
            orbit.orbit(DVec2::new(10.0, 1e6));
            assert_eq!(orbit.pitch, FRAC_PI_2);
            assert!(orbit.view().eye.z > orbit.target.z);
        }
    }

    /// All points are inside, two opposite edges are reached, and the picture is in the middle.
    #[test]
    fn what_is_fitted_fills_the_viewport() {
        let bounds = box_of_30();
        let points: Vec<DVec3> = (0..27)
            .map(|i| {
                let share = DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9));
                bounds.min + bounds.size() * share * 0.5
            })
            .collect();
        for mut orbit in both_kinds() {
            orbit.yaw = 0.4;
            orbit.fit_into(&points, SIZE);
            let seen: Vec<DVec2> = points
                .iter()
                .map(|&p| orbit.view().project(p, SIZE).unwrap())
                .collect();
            let min = seen.iter().copied().reduce(DVec2::min).unwrap();
            let max = seen.iter().copied().reduce(DVec2::max).unwrap();
            assert!(
                ((min + max) * 0.5).distance(SIZE * 0.5) < 2.0,
                "{min} {max}"
            );
            let filled = ((max - min) / SIZE).max_element();
            assert!((filled - FILLED).abs() < 0.01, "{filled}");
        }
    }
}
