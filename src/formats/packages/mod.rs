//! Cameras and posed photos as photogrammetry packages and recordings hold them.

pub(crate) mod blocks_exchange;
pub(crate) mod bundler;
pub(crate) mod colmap;
pub(crate) mod drone_photos;
pub(crate) mod json_packages;
pub(crate) mod meshroom;
pub(crate) mod metashape;
pub(crate) mod middlebury;
pub(crate) mod nerfstudio;
pub(crate) mod nvm;
pub(crate) mod odm;
pub(crate) mod open3d;
pub(crate) mod opensfm;
pub(crate) mod opf;
pub(crate) mod package;
pub(crate) mod pix4d;
pub(crate) mod realitycapture;
pub(crate) mod reconstruction;
pub mod ros;
