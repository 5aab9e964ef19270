//! Readers that are told by a file's name or first bytes are given a file.

use std::fs;
use std::path::PathBuf;

use fragscale::jobs::Progress;
use fragscale::opening::info;
use tempfile::TempDir;

/// A folder with that one file in it.
///
/// # Panics
/// Where it cannot be written.
pub fn file(name: &str, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder to write to");
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("room to write");
    (folder, path)
}

/// What `fragscale info` does with a file of that name.
///
/// # Panics
/// Where it cannot be written, and where the reader does.
pub fn read(name: &str, bytes: &[u8]) {
    let (_folder, path) = file(name, bytes);
    let _ = info(&path, &Progress::default());
}
