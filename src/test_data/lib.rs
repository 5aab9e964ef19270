//! Where tests find their files: those of the repository, and the real data beside it, which stay
//! outside of it because their licences differ. Only tests and benchmarks use this crate.

pub mod copc;
pub mod jpeg;
pub mod node_server;
pub mod ros;

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The repository's top folder. Members lie two folders below it, so their own
/// `CARGO_MANIFEST_DIR` does not say it.
pub fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A file of that name in a folder that goes when the first of the two is dropped.
///
/// # Panics
/// Where it cannot be written.
#[expect(clippy::unwrap_used, reason = "in a test a panic is the report")]
pub fn written(name: &str, bytes: impl AsRef<[u8]>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// A file or folder below `../shared/data` (or `FRAGSCALE_TEST_DATA`), or `None` where it is not
/// there: the project's tests must pass without.
///
/// What was left out is written as a line into the file that `FRAGSCALE_LEFT_OUT` names, so that
/// `tests/run` can say at the end how much was not tested: what a passing test prints is not shown.
///
/// # Panics
/// Where it is missing and `FRAGSCALE_REQUIRE_DATA` is 1.
pub fn shared_data(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("FRAGSCALE_TEST_DATA")
        .map_or_else(|| repository().join("../shared/data"), PathBuf::from);
    let found = root.join(path);
    if found.exists() {
        return Some(found);
    }
    assert!(
        std::env::var_os("FRAGSCALE_REQUIRE_DATA").is_none_or(|value| value != "1"),
        "FRAGSCALE_REQUIRE_DATA is 1, and {} is missing",
        found.display()
    );
    left_out("no shared data", path);
    None
}

/// A program on the path, or `None` where it is not installed: the project's tests must pass without. It is
/// left out as [`shared_data`] is, and no test requires it.
pub fn program(name: &str) -> Option<PathBuf> {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let found = std::env::split_paths(&folders).find_map(|folder| {
        let path = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        path.is_file().then_some(path)
    });
    if found.is_none() {
        left_out("not installed", name);
    }
    found
}

/// Says that the test that runs goes without `what`.
#[expect(
    clippy::print_stdout,
    clippy::panic,
    reason = "a test that checks nothing must say so"
)]
fn left_out(why: &str, what: &str) {
    println!("left out: {why} ({what})");
    if let Some(list) = std::env::var_os("FRAGSCALE_LEFT_OUT") {
        let test = std::thread::current().name().unwrap_or("?").to_owned();
        let line = format!("{test}: {what}\n");
        OpenOptions::new()
            .append(true)
            .create(true)
            .open(&list)
            .and_then(|mut list| list.write_all(line.as_bytes()))
            .unwrap_or_else(|e| panic!("{}: {e}", list.display()));
    }
}
