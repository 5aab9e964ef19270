//! What is meant by a folder that holds no flight itself: the one below it, or a choice.

use std::path::PathBuf;

use crate::formats::{Candidate, candidates, detect};

/// The same paths, but for each folder above a single flight or reconstruction that one.
///
/// # Errors
/// With the flights of the first folder that holds several, one or two levels down or in itself: the
/// choice is a person's.
pub fn meant_by(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Vec<Candidate>> {
    let meant = paths.iter().map(|path| {
        if !path.is_dir() || detect(path).is_ok() {
            return Ok(path.clone());
        }
        let mut found = candidates(path);
        match found.len() {
            // `detect` says what is wrong with it.
            0 => Ok(path.clone()),
            1 => Ok(found.remove(0).path),
            _ => Err(found),
        }
    });
    meant.collect()
}
