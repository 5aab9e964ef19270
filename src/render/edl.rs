//! Relief, and the background behind the surface (`shaders/edl.wgsl`).

use wgpu::{BindGroupLayout, Device};

use super::cover::Cover;
use super::shaders;

/// Reads the surface's colours and depths, and hands the depths on.
pub(super) fn edl(device: &Device, frame: &BindGroupLayout) -> Cover {
    Cover::new(device, frame, shaders::EDL, 2, true)
}
