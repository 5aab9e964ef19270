//! The surface: triangles that rays meet.

mod cloud;

pub use cloud::Cloud;
