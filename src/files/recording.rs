//! Which files are opened on the way, and which are written.
//!
//! A package's project leads to files that nobody named: lists of photos, parts, calibrations. None of
//! them may be written over, and no reader should have to remember to say so: the one door through
//! which files are opened for reading (`formats::open_file`) notes them here, while somebody records.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Who records, each with a number and what was opened and written since it began.
static RECORDINGS: Mutex<Vec<(u64, Recorded)>> = Mutex::new(Vec::new());

/// What somebody has recorded.
#[derive(Debug, Default)]
struct Recorded {
    opened: BTreeSet<PathBuf>,
    written: BTreeSet<PathBuf>,
}

/// Says that a file was opened for reading.
pub fn note_opened(path: &Path) {
    note(path, |recorded| &mut recorded.opened);
}

/// Says that a file was written.
pub(super) fn note_written(path: &Path) {
    note(path, |recorded| &mut recorded.written);
}

/// Says that a file that an earlier run wrote is what would be written now: it counts as written.
pub fn note_kept(path: &Path) {
    note_written(path);
}

fn note(path: &Path, list: fn(&mut Recorded) -> &mut BTreeSet<PathBuf>) {
    let mut recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
    for (_, recorded) in recordings.iter_mut() {
        let files = list(recorded);
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
        recordings.push((number, Recorded::default()));
        Self { number }
    }

    /// What was opened until now, as it was named.
    pub fn files(&self) -> Vec<PathBuf> {
        self.list(|recorded| &recorded.opened)
    }

    /// What was written until now, as it was named.
    pub fn written(&self) -> Vec<PathBuf> {
        self.list(|recorded| &recorded.written)
    }

    fn list(&self, list: fn(&Recorded) -> &BTreeSet<PathBuf>) -> Vec<PathBuf> {
        let recordings = RECORDINGS.lock().unwrap_or_else(PoisonError::into_inner);
        let own = recordings
            .iter()
            .filter(|(number, _)| *number == self.number);
        own.flat_map(|(_, recorded)| list(recorded).iter().cloned())
            .collect()
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
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        crate::files::write_whole(&path, b"x").unwrap();
        assert!(outer.written().contains(&path) && !outer.files().contains(&path));
        note_kept(Path::new(before));
        assert!(outer.written().contains(&PathBuf::from(before)));
    }
}
