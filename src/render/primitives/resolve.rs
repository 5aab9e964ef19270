//! Four samples become one pixel (`shaders/resolve.wgsl`).

use wgpu::{BindGroupLayout, Device};

use super::cover::Cover;
use super::frame;
use crate::device::pipeline::Shader;

pub(crate) const SHADER: Shader = (
    "resolve",
    &[frame::WGSL, include_str!("../../../shaders/resolve.wgsl")],
);

/// Reads the picture with all its samples.
pub(crate) fn resolve(device: &Device, frame: &BindGroupLayout) -> Cover {
    Cover::new(device, frame, SHADER, 1, false)
}
