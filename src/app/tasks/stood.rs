//! How files stood when they were read for what is on the screen, or saved from it: another window, another program or a
//! person may have changed them since.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::opening::control_file;

/// When a file was last changed, and how long it was; `None` where there was none.
type Stamp = Option<(Option<SystemTime>, u64)>;

/// Files as they stood.
#[derive(Debug, Clone, Default)]
pub struct Stood(HashMap<PathBuf, Stamp>);

fn stamp(path: &Path) -> Stamp {
    let there = fs::metadata(path).ok()?;
    Some((there.modified().ok(), there.len()))
}

impl Stood {
    /// A file as it stands now, or that there is none.
    pub(crate) fn note(&mut self, path: &Path) {
        self.0.insert(path.to_owned(), stamp(path));
    }

    /// Files as they stood when they were noted there.
    pub(crate) fn take(&mut self, noted: Self) {
        self.0.extend(noted.0);
    }

    /// A file that is there, and of which nothing was taken: whatever it holds is no earlier state of what is on the screen.
    pub(crate) fn note_not_taken(&mut self, path: &Path) {
        self.0.insert(path.to_owned(), None);
    }

    /// The same of a flight.toml and of its control points.
    pub(crate) fn note_flight(&mut self, file: &Path) {
        self.note(file);
        self.note(&control_file(file));
    }

    /// Whether it is one of those that were noted.
    pub(crate) fn knows(&self, path: &Path) -> bool {
        self.0.contains_key(path)
    }

    /// All that are not what they were, those that are gone among them.
    pub(crate) fn all_changed(&self) -> Vec<PathBuf> {
        let changed = self.0.iter().filter(|(path, stood)| stamp(path) != **stood);
        let mut changed: Vec<PathBuf> = changed.map(|(path, _)| path.clone()).collect();
        changed.sort();
        changed
    }

    /// The first of these files that is not what it was: of a file that was never noted nothing is known, and in one that is gone
    /// nothing can be lost.
    pub(crate) fn changed<'a>(
        &self,
        mut paths: impl Iterator<Item = &'a Path>,
    ) -> Option<&'a Path> {
        paths.find(|path| {
            let now = stamp(path);
            now.is_some() && self.0.get(*path).is_some_and(|stood| *stood != now)
        })
    }
}

/// That what is on the screen is not of the file any more.
pub(crate) fn changed_in_words(path: &Path) -> String {
    format!(
        "{} was changed since it was read: what is on the screen is of what it was; File > Read again (F5) takes what it is",
        path.display()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_others_change_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b, c] = ["a", "b", "c"].map(|name| folder.path().join(name));
        fs::write(&a, "1").unwrap();
        let mut stood = Stood::default();
        for path in [&a, &b] {
            stood.note(path);
        }
        let all = || [&a, &b, &c].into_iter().map(PathBuf::as_path);
        fs::write(&c, "new").unwrap();
        assert_eq!(stood.changed(all()), None);
        fs::write(&b, "made since").unwrap();
        assert_eq!(stood.changed(all()), Some(b.as_path()));
        stood.note(&b);
        fs::write(&a, "longer").unwrap();
        assert_eq!(stood.changed(all()), Some(a.as_path()));
        fs::remove_file(&a).unwrap();
        assert_eq!(stood.changed(all()), None);
    }
}
