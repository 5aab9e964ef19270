//! Photos that are in a folder twice, under two names: a copy overlaps its original wholly and says nothing
//! of depth.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::files::{FileError, read_bytes};

/// The photos seen so far, by the sizes of their files.
#[derive(Default)]
pub(crate) struct Twins(HashMap<u64, Vec<PathBuf>>);

impl Twins {
    /// The photo before this one that has the same bytes.
    ///
    /// # Errors
    /// Where one of the two cannot be read.
    pub(crate) fn same_as(&mut self, path: &Path) -> Result<Option<PathBuf>, FileError> {
        // Who cannot be asked for its size is said to be unreadable elsewhere.
        let size = fs::metadata(path).map_or(0, |file| file.len());
        let before = self.0.entry(size).or_default();
        if !before.is_empty() {
            let bytes = read_bytes(path)?;
            for other in before.iter() {
                if read_bytes(other)? == bytes {
                    return Ok(Some(other.clone()));
                }
            }
        }
        before.push(path.to_owned());
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_bytes_are_found_and_equal_sizes_are_not_enough() {
        let folder = tempfile::tempdir().unwrap();
        let mut twins = Twins::default();
        let mut same_as = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            fs::write(&path, bytes).unwrap();
            let found = twins.same_as(&path).unwrap();
            found.map(|path| path.file_name().unwrap().to_owned())
        };
        assert_eq!(same_as("a.jpg", b"one"), None);
        assert_eq!(same_as("b.jpg", b"two"), None);
        assert_eq!(same_as("c.jpg", b"two"), Some("b.jpg".into()));
        assert_eq!(same_as("d.jpg", b"three"), None);
    }
}
