//! Which reconstructions may be meant by a path that somebody names.

use std::path::Path;

use crate::candidates::{Candidate, Contents, Found, below, counted, meant_in};
use crate::detect::{Kind, detect};
use crate::packages::Package;

/// The reconstructions that `path` may stand for, with their photos' counts: those of a folder itself,
/// else those in its folders, one and two levels down. A single one is what opening `path` opens,
/// where it lies in the folder itself. Empty where there is none.
///
/// What one of them was made of (OpenSfM's files in an OpenDroneMap project) is not listed beside it.
/// Reads at most some hundred entries of each folder, and counts photos only where that is quick.
pub fn candidates(path: &Path) -> Vec<Candidate> {
    if !path.is_dir() {
        let found = detect(path).ok();
        return counted(found.and_then(of_kind).into_iter().collect());
    }
    let flight = path.join("flight.toml");
    if flight.is_file() {
        return counted(vec![(None, flight)]);
    }
    let found = meant_in(path);
    let found = if found.is_empty() {
        below(path)
    } else {
        found.into_iter().map(|(p, path)| (Some(p), path)).collect()
    };
    counted(found)
}

/// Whether photos lie in a folder itself, and no reconstruction; flights in its folders make no difference.
pub fn is_of_photos(folder: &Path) -> bool {
    matches!(Contents::of(folder).meant[..], [(Package::Photos, _)])
}

fn of_kind(kind: Kind) -> Option<Found> {
    match kind {
        Kind::Flight(path) => Some((None, path)),
        Kind::Reconstruction(package, path) => Some((Some(package), path)),
        _ => None,
    }
}
