//! Where depth maps lie while nobody looks at them: a survey's do not fit in memory together, and what was
//! found is not to be found again after an interruption.

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use crate::fault::Fault;
use crate::files::{self, Inputs, Kind};

/// A place for bytes by name.
pub trait Shelf: Sync {
    /// What was put there; `None` where nothing was.
    fn get(&self, name: &str) -> Option<Vec<u8>>;

    /// Puts something there, over what was there before.
    ///
    /// # Errors
    /// Where there is no room.
    fn put(&self, name: &str, bytes: Vec<u8>) -> Result<(), Fault>;

    /// Takes away what nobody needs any more.
    fn discard(&self, name: &str);
}

/// A shelf in memory: for few photos, and for tests.
#[derive(Debug, Default)]
pub struct InMemory(Mutex<HashMap<String, Vec<u8>>>);

impl Shelf for InMemory {
    fn get(&self, name: &str) -> Option<Vec<u8>> {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.get(name).cloned()
    }

    fn put(&self, name: &str, bytes: Vec<u8>) -> Result<(), Fault> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.insert(name.to_owned(), bytes);
        Ok(())
    }

    fn discard(&self, name: &str) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.remove(name);
    }
}

/// A folder, which exists: a file a name. A file is there whole or not at all, also when the program is killed.
#[derive(Debug, Clone)]
pub struct InFolder(PathBuf);

impl InFolder {
    /// That folder.
    #[must_use]
    pub fn new(folder: PathBuf) -> Self {
        Self(folder)
    }
}

impl Shelf for InFolder {
    fn get(&self, name: &str) -> Option<Vec<u8>> {
        fs::read(self.0.join(name)).ok()
    }

    fn put(&self, name: &str, bytes: Vec<u8>) -> Result<(), Fault> {
        // The folder is the shelf's own: nothing that was read lies in it.
        files::write(
            &self.0.join(name),
            &bytes,
            Kind::Result,
            &Inputs::default(),
            true,
        )
    }

    fn discard(&self, name: &str) {
        // What stays costs room, nothing else.
        let _ = fs::remove_file(self.0.join(name));
    }
}

/// What was looked at last, up to so many bytes.
pub(crate) struct Recent<T> {
    most: usize,
    /// The latest is the last.
    held: Mutex<Vec<(usize, usize, Arc<T>)>>,
}

impl<T> Recent<T> {
    pub(crate) fn new(most: usize) -> Self {
        Self {
            most,
            held: Mutex::new(Vec::new()),
        }
    }

    pub(crate) fn get(&self, which: usize) -> Option<Arc<T>> {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        let place = held.iter().position(|(own, ..)| *own == which)?;
        let found = held.remove(place);
        let of_it = Arc::clone(&found.2);
        held.push(found);
        Some(of_it)
    }

    /// Holds `one` of so many bytes, and lets go of those that were not looked at for the longest time.
    pub(crate) fn hold(&self, which: usize, bytes: usize, one: Arc<T>) {
        let mut held = self.held.lock().unwrap_or_else(PoisonError::into_inner);
        held.push((which, bytes, one));
        let mut sum: usize = held.iter().map(|(_, bytes, _)| bytes).sum();
        while sum > self.most && !held.is_empty() {
            sum -= held.remove(0).1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_put_is_there_until_it_is_discarded() {
        let folder = tempfile::tempdir().unwrap();
        let in_folder = InFolder::new(folder.path().to_owned());
        let in_memory = InMemory::default();
        let shelves: [&dyn Shelf; 2] = [&in_folder, &in_memory];
        for shelf in shelves {
            assert_eq!(shelf.get("a"), None);
            shelf.put("a", vec![1]).unwrap();
            shelf.put("a", vec![1, 2]).unwrap();
            assert_eq!(shelf.get("a"), Some(vec![1, 2]));
            shelf.discard("a");
            assert_eq!(shelf.get("a"), None);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let gone = InFolder::new(folder.path().join("none"));
        assert!(gone.put("a", vec![1]).is_err());
    }

    #[test]
    fn the_oldest_goes_first() {
        let recent = Recent::new(20);
        recent.hold(1, 10, Arc::new('a'));
        recent.hold(2, 10, Arc::new('b'));
        assert!(recent.get(1).is_some());
        recent.hold(3, 10, Arc::new('c'));
        assert_eq!(recent.get(2), None);
        assert_eq!(recent.get(1).as_deref(), Some(&'a'));
        recent.hold(4, 100, Arc::new('d'));
        assert_eq!((recent.get(4), recent.get(1)), (None, None));
    }
}
