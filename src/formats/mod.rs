//! Files that others wrote. One file a format; its header comment is the specification it was
//! written from. Here only: what kind a file is, and which reader takes it.
//!
//! A reader turns bytes into the core's types plus a list of warnings. It knows no path: it returns
//! a [`Fault`](crate::fault::Fault), and the dispatcher puts the file's name in front.

pub mod colmap;
mod colmap_binary;
mod colmap_models;
mod colmap_text;
mod fields;
mod input;
pub mod nvm;
mod reconstruction;
#[cfg(test)]
mod test_data;

pub use input::{FileError, open_file, read_bytes, read_text, text_from_bytes};
pub use reconstruction::{Observation, PosedPhoto, Reconstruction};
