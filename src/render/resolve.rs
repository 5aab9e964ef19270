//! Four samples become one pixel (`shaders/resolve.wgsl`).

use wgpu::{BindGroupLayout, Device};

use super::cover::Cover;
use super::shaders;

/// Reads the picture with all its samples.
pub(super) fn resolve(device: &Device, frame: &BindGroupLayout) -> Cover {
    Cover::new(device, frame, shaders::RESOLVE, 1, false)
}
