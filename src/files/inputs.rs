//! The files that were read, known by identity and not by name: links lead to the same file.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Device and number of a file: hard links share them.
type Identity = (u64, u64);

#[cfg(unix)]
fn identity(metadata: &fs::Metadata) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

/// The standard library tells none there: a second hard link to a file counts as another file.
#[cfg(not(unix))]
fn identity(_: &fs::Metadata) -> Option<Identity> {
    None
}

/// Whether both are there and are one file, through links.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    let mut known = Known::default();
    known.add(a);
    known.find(b).is_some()
}

/// What was read. Nothing is written over it.
#[derive(Debug, Clone, Default)]
pub struct Inputs {
    /// Files that were read as what they are.
    named: Known,
    /// Files that were opened on the way; among them may be results of earlier runs.
    opened: Known,
    /// Folders that were read as a whole, with their links followed.
    folders: Vec<(PathBuf, PathBuf)>,
    /// Files in these folders that were not.
    apart: Vec<PathBuf>,
}

impl Inputs {
    /// These files; of a folder everything that lies in it.
    pub fn of<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Self {
        let mut inputs = Self::default();
        for path in paths {
            inputs.add(path.as_ref());
        }
        inputs
    }

    /// Another file, or a folder with everything that lies in it. What is not there was not read.
    pub fn add(&mut self, path: &Path) {
        if path.is_dir() {
            if let Ok(real) = fs::canonicalize(path) {
                self.folders.push((real, path.to_owned()));
            }
        } else {
            self.named.add(path);
        }
    }

    /// Files that were opened on the way, such as a [`super::Recording`] has them: unlike those that
    /// were named they may be written over where they are results of fragscale.
    #[must_use]
    pub fn with_opened(mut self, paths: &[PathBuf]) -> Self {
        for path in paths {
            self.opened.add(path);
        }
        self
    }

    /// The files below a folder that were opened on the way, as they were named, sorted.
    pub fn opened_below(&self, folder: &Path) -> Vec<PathBuf> {
        let Ok(folder) = fs::canonicalize(folder) else {
            return Vec::new();
        };
        let below = self.opened.by_path.iter();
        let below = below.filter(|(real, _)| real.starts_with(&folder));
        let mut files: Vec<PathBuf> = below.map(|(_, named)| named.clone()).collect();
        files.sort();
        files
    }

    /// All of another list as well.
    pub fn extend(&mut self, other: &Self) {
        self.named.extend(&other.named);
        self.opened.extend(&other.opened);
        self.folders.extend(other.folders.iter().cloned());
        self.apart.extend(other.apart.iter().cloned());
    }

    /// The same without this one: the file that is saved where it was opened.
    #[must_use]
    pub fn without(mut self, path: &Path) -> Self {
        self.named.remove(path);
        self.opened.remove(path);
        self.apart.extend(fs::canonicalize(path));
        self
    }

    /// The file that was read as what it is and is the same as `path`, as it was named.
    pub fn named(&self, path: &Path) -> Option<&Path> {
        self.named.find(path)
    }

    /// The file that was opened on the way and is the same as `path`, or the folder that was read and
    /// has it inside, as it was named.
    pub fn on_the_way(&self, path: &Path) -> Option<&Path> {
        self.opened.find(path).or_else(|| {
            let real = fs::canonicalize(path).ok()?;
            if self.apart.contains(&real) {
                return None;
            }
            let mut folders = self.folders.iter();
            let (_, named) = folders.find(|(folder, _)| real.starts_with(folder))?;
            Some(named)
        })
    }
}

/// Files by what they are, each with the name that it came by. A file is the same by its identity or by
/// its path: an editor that saved it anew gave the same path another file.
#[derive(Debug, Clone, Default)]
struct Known {
    by_identity: HashMap<Identity, Named>,
    by_path: HashMap<PathBuf, PathBuf>,
}

/// How a file was named, and when it was last changed then.
#[derive(Debug, Clone)]
struct Named {
    path: PathBuf,
    changed: Option<SystemTime>,
}

impl Named {
    /// Whether a file that has the identity now is the one that had it. The number of a file that is gone,
    /// because it was replaced by a save, goes to the next one that is made.
    fn is(&self, now: &fs::Metadata) -> bool {
        let there = fs::metadata(&self.path).ok();
        let still_there = there.is_some_and(|there| identity(&there) == identity(now));
        still_there || self.changed == now.modified().ok()
    }
}

impl Known {
    fn add(&mut self, path: &Path) {
        let Ok(metadata) = fs::metadata(path) else {
            return;
        };
        // A terminal or a pipe can be read and written.
        if !metadata.is_file() {
            return;
        }
        if let Some(identity) = identity(&metadata) {
            self.by_identity.entry(identity).or_insert_with(|| Named {
                path: path.to_owned(),
                changed: metadata.modified().ok(),
            });
        }
        if let Ok(real) = fs::canonicalize(path) {
            self.by_path.entry(real).or_insert_with(|| path.to_owned());
        }
    }

    fn find(&self, path: &Path) -> Option<&Path> {
        let same = fs::metadata(path).ok().and_then(|now| {
            let named = self.by_identity.get(&identity(&now)?)?;
            named.is(&now).then_some(&named.path)
        });
        let found = same.or_else(|| self.by_path.get(&fs::canonicalize(path).ok()?));
        found.map(PathBuf::as_path)
    }

    fn remove(&mut self, path: &Path) {
        let identity_of = |path: &Path| fs::metadata(path).ok().as_ref().and_then(identity);
        if let Some(identity) = identity_of(path) {
            self.by_identity.remove(&identity);
            // Its other names are paths to the same file.
            self.by_path
                .retain(|real, _| identity_of(real) != Some(identity));
        }
        if let Ok(real) = fs::canonicalize(path) {
            self.by_path.remove(&real);
        }
    }

    fn extend(&mut self, other: &Self) {
        for (identity, path) in &other.by_identity {
            self.by_identity
                .entry(*identity)
                .or_insert_with(|| path.clone());
        }
        for (real, path) in &other.by_path {
            self.by_path
                .entry(real.clone())
                .or_insert_with(|| path.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_opened_below_a_folder_is_listed() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("below")).unwrap();
        let files = [at("below/a.json"), at("b.laz"), at("LICENSE")];
        for file in &files {
            fs::write(file, "x").unwrap();
        }
        let inputs = Inputs::of([folder.path()]).with_opened(&files[..2]);
        assert_eq!(
            inputs.opened_below(folder.path()),
            [at("b.laz"), at("below/a.json")]
        );
        assert_eq!(inputs.opened_below(&at("below")), [at("below/a.json")]);
    }

    #[test]
    fn a_file_is_known_by_any_of_its_names() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("below")).unwrap();
        fs::write(at("a"), "x").unwrap();
        fs::write(at("copy"), "x").unwrap();
        fs::hard_link(at("a"), at("hard")).unwrap();
        let mut names = vec![at("a"), at("below/../a"), at("./a")];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", at("soft")).unwrap();
            std::os::unix::fs::symlink(at("soft"), at("below/soft")).unwrap();
            names.extend([at("soft"), at("below/soft"), at("hard")]);
        }
        let inputs = Inputs::of([at("a")]);
        for name in names {
            assert_eq!(inputs.named(&name), Some(at("a").as_path()), "{name:?}");
            assert!(is_same_file(&name, &at("a")));
            assert_eq!(inputs.clone().without(&name).named(&at("a")), None);
        }
        for name in ["copy", "new", "below"] {
            assert_eq!(inputs.named(&at(name)), None);
        }
        assert!(!is_same_file(&at("new"), &at("new")), "it is not there");
        // Another file that has got the number of one that is gone: another time tells it, where no name
        // is left that leads to the old one.
        #[cfg(unix)]
        {
            let old = Inputs::of([at("copy")]);
            fs::rename(at("copy"), at("reused")).unwrap();
            assert!(old.named(&at("reused")).is_some(), "moved, and the same");
            let reused = fs::File::options().write(true).open(at("reused")).unwrap();
            let later = SystemTime::now() + std::time::Duration::from_secs(5);
            reused.set_modified(later).unwrap();
            assert_eq!(old.named(&at("reused")), None);
            fs::rename(at("reused"), at("copy")).unwrap();
            assert!(old.named(&at("copy")).is_some(), "by its path");
        }
        // Saved anew by an editor: another file in its place.
        fs::rename(at("copy"), at("a")).unwrap();
        assert!(inputs.named(&at("a")).is_some());
    }

    #[test]
    fn a_folder_has_what_lies_in_it() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir_all(at("model/deep")).unwrap();
        for name in ["model/a", "model/deep/b", "beside", "model2"] {
            fs::write(at(name), "x").unwrap();
        }
        let inputs = Inputs::of([at("model")]).with_opened(&[at("beside")]);
        for name in ["model/a", "model/deep/b", "beside", "model/../beside"] {
            assert!(inputs.on_the_way(&at(name)).is_some(), "{name}");
            assert_eq!(inputs.named(&at(name)), None);
        }
        // A flight.toml in the folder of its own reconstruction can be saved.
        let saved = inputs.clone().without(&at("model/a"));
        assert_eq!(saved.on_the_way(&at("model/a")), None);
        assert!(saved.on_the_way(&at("model/deep/b")).is_some());
        for name in ["model2", "model/new"] {
            assert_eq!(inputs.on_the_way(&at(name)), None);
        }
    }
}
