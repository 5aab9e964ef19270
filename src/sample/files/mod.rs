//! The files of a sample flight. One file a format; its header comment says what it writes and from
//! which specification. Values go in, bytes or text come out: no paths, no clock, no randomness, so
//! the same values are the same bytes on every day and every machine.

pub mod calibration;
mod exif;
pub mod flight;
pub mod label;
pub mod photo;
pub mod photo_metadata;
pub mod reference;
mod xmp;

/// Reading back what was written, for the tests of the writers.
#[cfg(test)]
mod read_back {
    use std::path::PathBuf;

    /// A file of that name in a folder that goes when the first of the two is dropped.
    pub(super) fn written(name: &str, bytes: impl AsRef<[u8]>) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        (folder, path)
    }
}
