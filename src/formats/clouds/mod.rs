//! Points and triangles.

pub(crate) mod cloud_file;
pub(crate) mod e57;
pub(crate) mod ept;
mod geo_keys;
pub(crate) mod geotiff;
pub(crate) mod gltf;
pub(crate) mod las;
pub(crate) mod leica;
pub(crate) mod obj;
pub(crate) mod pcd;
pub(crate) mod pieces;
pub(crate) mod ply;
pub(crate) mod stl;
pub(crate) mod xyz;

pub use cloud_file::CloudFile;
pub use pieces::{CloudPiece, CloudPieces};
