//! Files that others wrote. One file a format; its header comment is the specification it was
//! written from. Here only: what kind a file is, and which reader takes it.
//!
//! A reader turns bytes into the core's types plus a list of warnings. It knows no path: it returns
//! a [`Fault`](crate::fault::Fault), and the dispatcher puts the file's name in front.

mod input;
mod json;
pub mod odm;
mod odm_cameras;
mod odm_georeference;
mod odm_poses;
mod odm_shots;
pub mod opensfm;
pub mod opensfm_camera;
mod opensfm_tracks;
mod reconstruction;
#[cfg(test)]
mod test_data;

pub use input::{FileError, open_file, read_bytes, read_text, text_from_bytes};
pub use reconstruction::{Observation, PosedPhoto, Reconstruction};
