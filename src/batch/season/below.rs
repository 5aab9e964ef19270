//! The flights below a folder: whatever `opening` would open.

use std::fs;
use std::path::{Path, PathBuf};

use super::Season;
use crate::formats::{Candidate, Kind, Package, UNFINISHED, candidates, detect};
use crate::results::LOCK;

/// No season lies deeper.
const MOST_DEEP: usize = 12;

/// Folders that are looked into.
const MOST_FOLDERS: usize = 50_000;

/// The list of an export.
const EXPORT: &str = "export.json";

/// What lies below a folder.
#[derive(Debug, Default)]
pub(super) struct Below {
    /// Flights, by name.
    pub(super) flights: Vec<PathBuf>,
    /// Folders with nothing of a flight in them, and none below.
    pub(super) without: Vec<PathBuf>,
    /// Folders of photos that could be placed over a cloud, but have none.
    pub(super) photos_alone: Vec<PathBuf>,
}

/// The flights below a folder, or itself where it is one. Results in `to` are none.
pub(super) fn flights(path: &Path, to: &Path) -> Below {
    let mut below = Below::default();
    if !path.is_dir() {
        below.flights.push(path.to_owned());
        return below;
    }
    let mut look = Look {
        to: fs::canonicalize(to).ok(),
        left: MOST_FOLDERS,
    };
    look.look_into(path, 0, &mut below);
    // Itself, it is named already.
    below.without.retain(|folder| folder != path);
    below
}

/// Whether a file is a flight or a reconstruction; a season's own file is none.
pub(super) fn is_flight_file(path: &Path) -> bool {
    match detect(path) {
        Ok(Kind::Flight(_)) => !Season::is_season(path),
        Ok(Kind::Reconstruction(..)) => true,
        _ => false,
    }
}

/// Whether a folder holds the results of a season, by its lock.
pub(super) fn is_results_folder(folder: &Path) -> bool {
    folder.join(LOCK).is_file()
}

struct Look {
    to: Option<PathBuf>,
    /// Folders that may still be looked into.
    left: usize,
}

impl Look {
    fn look_into(&mut self, folder: &Path, depth: usize, below: &mut Below) {
        let is_to = || fs::canonicalize(folder).ok() == self.to && self.to.is_some();
        if depth > MOST_DEEP || self.left == 0 || is_results_folder(folder) || is_to() {
            return;
        }
        self.left -= 1;
        if folder.join(EXPORT).is_file() {
            return;
        }
        // It fails, and says how it goes on.
        if folder.join(UNFINISHED).is_file() {
            below.flights.push(folder.to_owned());
            return;
        }
        match detect(folder) {
            Ok(Kind::Reconstruction(Package::Photos, _)) if !has_cloud(folder) => {
                below.photos_alone.push(folder.to_owned());
            }
            Ok(Kind::Flight(_) | Kind::Reconstruction(..)) => {
                below.flights.push(folder.to_owned());
            }
            _ => {
                let before = (
                    below.flights.len(),
                    below.without.len(),
                    below.photos_alone.len(),
                );
                for inside in folders_in(folder) {
                    self.look_into(&inside, depth + 1, below);
                }
                if below.flights.len() > before.0 {
                    return;
                }
                // Files that lie here, of which none is meant more than another.
                let lies_here = |found: &Candidate| found.path.parent() == Some(folder);
                let is_several = below.photos_alone.len() == before.2
                    && candidates(folder).iter().any(lies_here);
                below.without.truncate(before.1);
                match is_several {
                    // It says which.
                    true => below.flights.push(folder.to_owned()),
                    false => below.without.push(folder.to_owned()),
                }
            }
        }
    }
}

fn has_cloud(folder: &Path) -> bool {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let endings = [
        "las", "laz", "ply", "e57", "pcd", "pts", "ptx", "obj", "stl", "glb", "xyz",
    ];
    let mut found = entries.map(|entry| entry.path()).filter(|path| {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        endings.contains(&ending.to_ascii_lowercase().as_str())
    });
    found.any(|path| matches!(detect(&path), Ok(Kind::Cloud(_))))
}

/// The folders in a folder by name; neither hidden ones nor links, which may lead round in a circle.
fn folders_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        is_folder && !entry.file_name().to_string_lossy().starts_with('.')
    });
    let mut paths: Vec<PathBuf> = folders.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
