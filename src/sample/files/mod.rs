//! The files of a sample flight. One file a format; its header comment says what it writes and from
//! which specification. Values go in, bytes or text come out: no paths, no clock, no randomness, so
//! the same values are the same bytes on every day and every machine.

pub mod calibration;
mod exif;
pub mod flight;
pub mod photo;
pub mod photo_metadata;
pub mod reference;
mod xmp;
