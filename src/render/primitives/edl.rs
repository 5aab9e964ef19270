//! Relief, and the background behind the surface (`shaders/edl.wgsl`).

use wgpu::{BindGroupLayout, Device};

use super::cover::Cover;
use super::frame;
use crate::device::pipeline::Shader;

pub(crate) const SHADER: Shader = (
    "edl",
    &[frame::WGSL, include_str!("../../../shaders/edl.wgsl")],
);

/// Reads the surface's colours and depths, and hands the depths on.
pub(crate) fn edl(device: &Device, frame: &BindGroupLayout) -> Cover {
    Cover::new(device, frame, SHADER, 2, true)
}
