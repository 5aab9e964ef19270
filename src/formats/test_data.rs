//! Where the real data for tests lies: outside the repository, because its licences differ.

use std::path::{Path, PathBuf};

/// A file or folder below `../shared/data` (or `FRAGSCALE_TEST_DATA`), or `None`, said on the
/// terminal, where it is not there: the project's tests must pass without.
#[expect(
    clippy::print_stdout,
    reason = "a test that checks nothing must say so"
)]
pub(crate) fn shared_data(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("FRAGSCALE_TEST_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data"),
        PathBuf::from,
    );
    let found = root.join(path);
    if found.exists() {
        return Some(found);
    }
    println!("left out: no shared data ({path})");
    None
}
