//! What is meant by a folder that holds no flight itself: the one below it, or a choice.

use std::path::PathBuf;

use crate::formats::{Candidate, candidates, detect, is_of_photos};

/// The same paths, but for each folder above a single flight or reconstruction that one. Beside others a folder of
/// pictures is that of their photos, whatever lies in its folders.
///
/// # Errors
/// With the flights of the first folder that holds several, one or two levels down or in itself: the
/// choice is a person's.
pub fn meant_by(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Vec<Candidate>> {
    let meant = paths.iter().map(|path| {
        let are_theirs = || paths.len() > 1 && is_of_photos(path);
        if !path.is_dir() || detect(path).is_ok() || are_theirs() {
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

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::Dropped;

    /// A folder of screenshots above a flight stands for the flight; dropped with one, for its photos.
    #[test]
    fn pictures_above_a_flight_are_photos_only_beside_one() {
        let folder = tempfile::tempdir().unwrap();
        let flight = folder.path().join("may/flight.toml");
        fs::create_dir(folder.path().join("may")).unwrap();
        fs::write(&flight, "format = 1\n").unwrap();
        fs::write(folder.path().join("Screenshot 1.png"), "x").unwrap();
        let root = folder.path().to_owned();
        let meant = |paths: &[PathBuf]| meant_by(paths).unwrap();
        assert_eq!(
            meant(std::slice::from_ref(&root)),
            std::slice::from_ref(&flight)
        );
        let both = [flight.clone(), root.clone()];
        assert_eq!(meant(&both), both);
        let dropped = Dropped::sort(&both).unwrap();
        assert_eq!(dropped.flight, Some(flight));
        assert_eq!(dropped.options.photos, Some(root));
    }
}
