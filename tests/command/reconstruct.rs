//! `fragscale reconstruct` from outside: what it refuses, in one line. What comes out of photos that overlap
//! is tested in `src/reconstruct/tests.rs`.

use std::fs;

use crate::common::error_of;

/// The bundled photos do not overlap, as the paper's: that is said, not a model made of nothing.
#[test]
fn photos_without_overlap_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("flight");
    let to = to.to_str().expect("UTF-8");
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let error = error_of(&["reconstruct", photos, "--to", to]);
    assert!(error.contains("show the same"), "{error}");
    assert!(error.contains("overlap by two thirds"), "{error}");
}

#[test]
fn folders_that_are_none_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    fs::create_dir(path("empty")).expect("a folder");
    let error = error_of(&["reconstruct", &path("empty"), "--to", &path("a")]);
    assert!(error.contains("0 of its 0 photos"), "{error}");
    assert!(!folder.path().join("a").exists());
    let error = error_of(&["reconstruct", &path("none"), "--to", &path("a")]);
    assert!(error.contains("cannot be read"), "{error}");
    fs::write(folder.path().join("empty/mine.txt"), "mine").expect("a file");
    let photos = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample/photos");
    let error = error_of(&["reconstruct", photos, "--to", &path("empty")]);
    assert!(error.contains("the folder is not empty"), "{error}");
}
