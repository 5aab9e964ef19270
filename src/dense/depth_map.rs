//! What the search found for one photo.

use crate::camera::Camera;

/// A depth, an orientation and how sure they are, for every pixel of a photo or of a reduced one.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthMap {
    /// The pinhole of the map's size; pixel (u, v) of the photo is (u, v) over the reduction here.
    pub camera: Camera,
    /// How many times the photo was halved.
    pub halvings: u32,
    /// Along the optical axis, in the world's unit, row by row; every pixel has one.
    pub depths: Vec<f32>,
    /// How the inverse depth grows to the right and downwards, per pixel of the map.
    pub slopes: Vec<[f32; 2]>,
    /// What the search minimised, 0 to 2: one minus the correlation, averaged over the best views.
    pub costs: Vec<f32>,
    /// Whether something farther lies within half a window of the search: then the depth may be of what is beside it.
    pub before_farther: Vec<bool>,
    /// How many other views have the same surface there, within [`crate::fuse`]'s limits; 0 where they
    /// were not asked.
    pub supports: Vec<u8>,
    /// 0 to 1: how far to trust the depth, by cost and support. It orders pixels; it is no probability.
    pub confidences: Vec<f32>,
    /// The inverse depth that moves a pixel by one in a typical neighbour: what a pixel of matching noise
    /// does to the inverse depths.
    pub per_pixel: f32,
    /// The photos that it was compared with.
    pub neighbours: Vec<usize>,
}

impl DepthMap {
    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.camera.width as usize
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.camera.height as usize
    }
}
