//! What is typed into fields, read.

use std::path::PathBuf;

/// A path as typed, where it is one: without the quotes that file managers put around.
pub(crate) fn typed(path: &str) -> Option<PathBuf> {
    let path = path.trim().trim_matches(['"', '\'']);
    let path = path.strip_prefix("file://").unwrap_or(path);
    (!path.is_empty()).then(|| PathBuf::from(path))
}
