//! The folders in which changes are kept aside: one for each window that runs, and those of windows that ended badly.
//!
//! A window holds a lock on a file in its folder. The system lets go of it however the window ends; so a folder whose lock is
//! free, with changes in it, is of a window that is gone without having been asked about them.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::files::{self, Inputs, Kind};

/// Whose changes lie in a folder; written after all else.
const WHOSE: &str = "kept_aside.json";
/// What is held while a window runs.
const LOCK: &str = "lock";
/// The flight with its changes.
const FLIGHT: &str = "flight.toml";

/// Whose changes were kept aside.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct KeptOf {
    /// The flight's name.
    pub name: String,
    /// Where it is saved, if nobody says otherwise; from the root.
    pub file: PathBuf,
}

impl KeptOf {
    /// Of the flight.toml at `flight`, if that was kept aside.
    pub fn beside(flight: &Path) -> Option<Self> {
        let bytes = fs::read(flight.with_file_name(WHOSE)).ok()?;
        serde_json::from_slice(&bytes).ok()
    }
}

/// A folder that no other window touches.
#[derive(Debug)]
pub(super) struct KeptFolder {
    path: PathBuf,
    /// Locked as long as this lives.
    _lock: File,
}

impl KeptFolder {
    /// A new one in `root`, which is made where it is not there.
    ///
    /// # Errors
    /// What the system says.
    pub(super) fn make(root: &Path) -> io::Result<Self> {
        fs::create_dir_all(root)?;
        let since = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
        let name = format!("{}-{}", since.as_millis(), std::process::id());
        let path = root.join(name);
        fs::create_dir(&path)?;
        let lock = path.join(LOCK);
        files::write(&lock, b"", Kind::Result, &Inputs::default(), false)
            .map_err(io::Error::other)?;
        let lock = File::options().write(true).open(lock)?;
        lock.try_lock().map_err(io::Error::from)?;
        Ok(Self { path, _lock: lock })
    }

    /// Those in `root` that windows left behind with changes in them, the oldest first. What they left without any goes.
    pub(super) fn left_behind(root: &Path) -> Vec<Self> {
        let entries = fs::read_dir(root).into_iter().flatten().flatten();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
        paths.sort_unstable();
        let mut left = Vec::new();
        for path in paths {
            let lock = File::options().write(true).open(path.join(LOCK));
            let Ok(lock) = lock else {
                continue;
            };
            // Where locks are not known, as on some network drives, it may be a window that runs.
            if lock.try_lock().is_err() {
                continue;
            }
            let folder = Self { path, _lock: lock };
            match folder.whose() {
                Some(_) => left.push(folder),
                None => folder.remove(),
            }
        }
        left
    }

    /// Where the flight with its changes is.
    pub(super) fn flight_file(&self) -> PathBuf {
        self.path.join(FLIGHT)
    }

    /// Where it is written whose they are.
    pub(super) fn whose_file(&self) -> PathBuf {
        self.path.join(WHOSE)
    }

    /// Whose changes there are; `None` where they are not whole.
    pub(super) fn whose(&self) -> Option<KeptOf> {
        KeptOf::beside(&self.flight_file())
    }

    /// When they were kept.
    pub(super) fn written(&self) -> Option<SystemTime> {
        fs::metadata(self.whose_file()).ok()?.modified().ok()
    }

    /// Whether it is still there.
    pub(super) fn is_there(&self) -> bool {
        self.path.join(LOCK).is_file()
    }

    /// Takes away by what it is offered, and its flight: the folder itself stays.
    pub(super) fn withdraw(&self) {
        // What cannot be taken away goes with the folder.
        for file in [self.whose_file(), self.flight_file()] {
            let _ = fs::remove_file(file);
        }
    }

    /// Takes it away with all that was kept.
    pub(super) fn remove(&self) {
        // What is left of it where something cannot be taken away is offered to nobody, and goes at the next start.
        let _ = fs::remove_file(self.whose_file());
        let _ = fs::remove_dir_all(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_those_of_windows_that_are_gone_are_left_behind() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path().join("unsaved");
        assert!(KeptFolder::left_behind(&root).is_empty());
        let of = KeptOf {
            name: "Bench 12".to_owned(),
            file: PathBuf::from("/flights/12/flight.toml"),
        };
        let keep = |folder: &KeptFolder| {
            let json = serde_json::to_vec(&of).unwrap();
            fs::write(folder.whose_file(), json).unwrap();
        };
        let runs = KeptFolder::make(&root).unwrap();
        keep(&runs);
        std::thread::sleep(std::time::Duration::from_millis(2));
        let gone = KeptFolder::make(&root).unwrap();
        keep(&gone);
        std::thread::sleep(std::time::Duration::from_millis(2));
        let nothing_kept = KeptFolder::make(&root).unwrap();
        let [gone_path, empty_path] = [&gone, &nothing_kept].map(|folder| folder.path.clone());
        drop((gone, nothing_kept));

        let left = KeptFolder::left_behind(&root);
        let [left] = <[KeptFolder; 1]>::try_from(left).unwrap();
        assert_eq!(left.path, gone_path);
        assert_eq!(left.whose(), Some(of));
        assert!(left.written().is_some() && !empty_path.exists());
        // This window has it now.
        assert!(KeptFolder::left_behind(&root).is_empty());
        left.remove();
        assert!(!gone_path.exists() && runs.is_there());
    }
}
