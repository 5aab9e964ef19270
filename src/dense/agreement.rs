//! Whether another photo's depth map has the same surface at a pixel.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};

use crate::depth_map::DepthMap;
use crate::patch_match::pair::exact;
use crate::view::View;

/// The most that two maps' inverse depths may differ to be of one surface, in pixels of matching.
const MOST_PIXELS: f64 = 1.0;
/// The most that two maps' planes may be inclined to each other: 60 degrees.
const LEAST_COSINE: f64 = 0.5;

/// From one map into another.
pub(crate) struct Agreement<'a> {
    pub(crate) other: usize,
    theirs: Arc<DepthMap>,
    view: &'a View,
    a: DMat3,
    b: DVec3,
    /// Their camera axes in ours.
    turn: DMat3,
}

/// What another map says of a place.
pub(crate) struct Seen {
    /// The pixel of theirs, row by row.
    pub(crate) at: usize,
    /// Their inverse depth on the ray through our place, and ours as they see it.
    pub(crate) theirs: f64,
    pub(crate) ours: f64,
    /// Their point on that ray, in the world.
    pub(crate) point: DVec3,
    pub(crate) is_same: bool,
}

/// The inverse depth of a pixel of matching noise in a map: its depths are known by so much.
pub(crate) fn per_pixel(map: &DepthMap) -> f64 {
    f64::from(map.per_pixel)
}

/// A plane's normal in camera axes, towards the camera, from inverse depth and slopes at a pixel:
/// q(u, v) = g (u, v, 1) is n X = 1 with n = K^T g.
pub(crate) fn normal(map: &DepthMap, at: usize) -> DVec3 {
    let camera = &map.camera;
    let pixel = center(map, at);
    let [x, y] = map.slopes[at].map(f64::from);
    let constant = f64::from(map.depths[at]).recip() - x * pixel.x - y * pixel.y;
    let normal = DVec3::new(
        camera.fx * x,
        camera.skew * x + camera.fy * y,
        camera.cx * x + camera.cy * y + constant,
    );
    -normal.normalize_or_zero()
}

/// The centre of a pixel, row by row.
pub(crate) fn center(map: &DepthMap, at: usize) -> DVec2 {
    let (x, y) = (at % map.width(), at / map.width());
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}

impl<'a> Agreement<'a> {
    /// From the map of `view` into the other map, of view number `other`.
    pub(crate) fn of(
        own: &DepthMap,
        view: &View,
        theirs: Arc<DepthMap>,
        (other, their_view): (usize, &'a View),
    ) -> Self {
        let (from, to) = (&view.pose, &their_view.pose);
        let (a, b) = exact((&own.camera, from), (&theirs.camera, to));
        Self {
            other,
            theirs,
            view: their_view,
            a,
            b,
            turn: from.rotation.transpose() * to.rotation,
        }
    }

    /// Of their map.
    pub(crate) fn per_pixel(&self) -> f64 {
        per_pixel(&self.theirs)
    }

    /// What the other map has where it sees our pixel; `None` outside it.
    pub(crate) fn look(&self, own: &DepthMap, at: usize) -> Option<Seen> {
        let depth = f64::from(own.depths[at]);
        let m = self.a * center(own, at).extend(1.0) + self.b / depth;
        if depth.is_nan() || depth <= 0.0 || m.z <= 0.0 {
            return None;
        }
        let pixel = m.truncate() / m.z;
        if !self.theirs.camera.contains(pixel) {
            return None;
        }
        let (width, height) = (self.theirs.width(), self.theirs.height());
        let column = (pixel.x as usize).min(width - 1);
        let row = (pixel.y as usize).min(height - 1);
        let found = row * width + column;
        let from_center = pixel - center(&self.theirs, found);
        let [x, y] = self.theirs.slopes[found].map(f64::from);
        let theirs =
            f64::from(self.theirs.depths[found]).recip() + x * from_center.x + y * from_center.y;
        let ours = (depth * m.z).recip();
        if theirs.is_nan() || theirs <= 0.0 {
            return None;
        }
        let far = MOST_PIXELS * per_pixel(&self.theirs).max(per_pixel(own) / m.z);
        let leaning = normal(own, at).dot(self.turn * normal(&self.theirs, found));
        let direction = self.theirs.camera.direction_undistorted(pixel);
        let is_at_edge = own.before_farther[at] || self.theirs.before_farther[found];
        Some(Seen {
            at: found,
            theirs,
            ours,
            point: self.view.pose.center + self.view.pose.rotation * direction / theirs,
            is_same: !is_at_edge && (theirs - ours).abs() < far && leaning > LEAST_COSINE,
        })
    }
}
