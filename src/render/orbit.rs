//! Turning around what one looks at: the mouse's view of the world, without a window.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::view::{Projection, View};
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

    /// Puts all of `bounds` into a square viewport, in the same direction; it is then in any wider
    /// one.
    pub fn fit(&mut self, bounds: &Bounds) {
        self.fit_into(bounds, DVec2::ONE);
    }

    /// Puts all of `bounds` into a viewport of this shape, in the same direction.
    pub fn fit_into(&mut self, bounds: &Bounds, size: DVec2) {
        // A single point has no size to fit.
        let radius = (bounds.size().length() * 0.5).max(1e-3);
        self.target = bounds.center();
        self.extent = radius;
        let axes = self.axes().transpose();
        let slope = (FOV_Y * 0.5).tan() * FILLED;
        let slopes = DVec2::new(slope * size.x / size.y, slope);
        self.distance = (0..8)
            .map(|i| {
                let pick = |bit: i32, low: f64, high: f64| if i & bit == 0 { low } else { high };
                let corner = DVec3::new(
                    pick(1, bounds.min.x, bounds.max.x),
                    pick(2, bounds.min.y, bounds.max.y),
                    pick(4, bounds.min.z, bounds.max.z),
                );
                // In view axes around the target: seen within the slopes from this far or farther.
                let p = axes * (corner - self.target);
                let across = (p.truncate().abs() / slopes).max_element();
                if self.orthographic {
                    across
                } else {
                    across - p.z
                }
            })
            .fold(radius * 1e-3, f64::max);
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
