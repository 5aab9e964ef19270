//! Calibrations of cameras, and the lens models that several packages share.

pub(crate) mod camera_file;
pub(crate) mod json_camera;
pub(crate) mod polynomial_fisheye;
