//! The files that a flight is made of, as a simulation or a reconstruction writes them: poses and clouds.
//! Values go in, bytes or text come out, the same ones on every day.

mod laz;
mod ply;
mod poses_csv;

pub use self::laz::laz;
pub use self::ply::ply;
pub use self::poses_csv::{Orientation, PoseRow, StatedDeviations, poses_csv};

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
