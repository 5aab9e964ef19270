//! Which files are opened on the way.
//!
//! A package's project leads to files that nobody named: lists of photos, parts, calibrations. None of
//! them may be written over, and no reader should have to remember to say so: the one door through
//! which files are opened for reading (`formats::open_file`) notes them here, while somebody records.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Who records, each with a number and what was opened since it began.
static RECORDINGS: Mutex<Vec<(u64, BTreeSet<PathBuf>)>> = Mutex::new(Vec::new());

/// Says that a file was opened for reading.
pub fn note_opened(path: &Path) {
    let mut recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
    for (_, files) in recordings.iter_mut() {
        if !files.contains(path) {
            files.insert(path.to_owned());
        }
    }
}

/// Collects what is opened while it lives, by any thread: readers share their work among several. What
/// another job opens at the same time is among it, which only protects more.
#[derive(Debug)]
pub struct Recording {
    number: u64,
}

impl Recording {
    /// Begins.
    pub fn start() -> Self {
        let mut recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
        let highest = recordings.iter().map(|(number, _)| *number).max();
        let number = highest.map_or(0, |highest| highest + 1);
        recordings.push((number, BTreeSet::new()));
        Self { number }
    }

    /// What was opened until now, as it was named.
    pub fn files(&self) -> Vec<PathBuf> {
        let recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
        let own = recordings
            .iter()
            .filter(|(number, _)| *number == self.number);
        own.flat_map(|(_, files)| files.iter().cloned()).collect()
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        let mut recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
        recordings.retain(|(number, _)| *number != self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_opened_meanwhile_is_known() {
        // Names that no other test opens: the record is of the whole process.
        let [before, first, both] = ["/recording/before", "/recording/first", "/recording/both"];
        note_opened(Path::new(before));
        let outer = Recording::start();
        note_opened(Path::new(first));
        let inner = Recording::start();
        std::thread::scope(|scope| {
            scope.spawn(|| note_opened(Path::new(both)));
        });
        let has = |recording: &Recording, name| recording.files().contains(&PathBuf::from(name));
        assert!(!has(&outer, before) && has(&outer, first) && has(&outer, both));
        assert!(!has(&inner, first) && has(&inner, both));
        drop(inner);
        assert!(has(&outer, both));
    }
}
