//! The engineer's limits.

use serde::{Deserialize, Serialize};

/// When to doubt. A value at its limit is still good.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// The larger of top/bottom and bottom/top above which a linear change between the two is too
    /// coarse.
    pub top_bottom_ratio: f64,
    /// The larger of left/right and right/left above which a scale that changes only from top to
    /// bottom misleads at the sides.
    pub left_right_ratio: f64,
    /// The longest edge of a corner's triangle, as a share of the footprint's mean edge, above which
    /// the corner lies over a hole of the cloud.
    pub triangle_share: f64,
    /// The angle between a corner's ray and the plane of the corner points, degrees, below which the
    /// view is too flat.
    pub flattest_angle: f64,
    /// The surface's root mean square distance from that plane, as a share of the footprint's mean
    /// edge, above which four corners say too little.
    pub plane_share: f64,
    /// How far the scale of the photo's pixels may be from the best line, root mean square, as a share of
    /// the scale: judged in the place of `plane_share` where there is a line.
    pub off_line_share: f64,
    /// The width of the 95 % interval of a scale that goes to Split-Desktop, as a share of the scale.
    pub interval_share: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            // Over a plane the change from top to bottom is linear, whatever the ratio; but a photo
            // in which the far fragments are half the size of the near ones misses the small ones.
            top_bottom_ratio: 2.0,
            // Halfway down, the sides are then about 11 % off the middle.
            left_right_ratio: 1.25,
            // On slopes of rubble (37 degrees) the height in the middle of a triangle can be off by
            // a quarter of its edge or so: 5 % of the scale.
            triangle_share: 0.2,
            // At 30 degrees fragments look half as high as they are wide, and a height that is off
            // moves the corner point by nearly twice as much.
            flattest_angle: 30.0,
            // At usual fields of view the mean edge is about as long as the distance, so that the
            // scale within the photo is about 8 % off that between its edges.
            plane_share: 0.08,
            // The same error as above, measured instead of guessed from four corners.
            off_line_share: 0.08,
            // Sizes are off by as much as the scale: more than that between two blasts would be taken for
            // a difference of the blasts.
            interval_share: 0.05,
        }
    }
}
