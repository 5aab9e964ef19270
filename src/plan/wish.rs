//! What is wished of a plan.

use glam::DVec2;

use super::Pattern;

/// What is wished of a plan. Lengths are in world units, angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// How the photos lie.
    pub pattern: Pattern,
    /// How large the rock is to be in the photos.
    pub size: Size,
    /// How much of its width and of its height a photo shares with the next one, 0 to under 1.
    pub overlap: f64,
    /// The widest gap between photos, in parts of the shorter side of a photo's footprint: the diameter of the
    /// largest circle that no photo shows.
    pub gap: f64,
    /// The camera's axis below the horizon, where the pattern has one for all photos.
    pub tilt: f64,
    /// How far a photo's axis may lie from the normal of the ground, of the slope pattern.
    pub off_normal: f64,
    /// The gimbal's lowest and highest pitch, -90 straight down.
    pub gimbal: [f64; 2],
    /// How near the drone may come to the surface.
    pub clearance: f64,
    /// Where the drone takes off and lands, if that is known: the ground is looked at as far as there.
    pub take_off: Option<DVec2>,
}

/// How large the rock is to be in the photos.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// This scale, and how far it may be off anywhere in a photo: pixels per world unit.
    Scale {
        /// In the middle of what 98 of 100 of a photo's pixels have.
        pixels: f64,
        /// On both sides of it, for 98 of 100 pixels.
        within: Option<f64>,
    },
    /// Photos from so far: above the highest of the area, where one height is for all; else from the ground.
    Distance(f64),
}
