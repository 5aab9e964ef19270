//! The folder that a run on a node works in: `DIR/unfinished` holds what a second run goes on with, until the
//! flight is whole.
//!
//! ```text
//! photos.txt   what was sent, and with which options: another run of the same goes on
//! task.json    which task of which node it is; never the token
//! arrived.txt  the files that the node has said it has, before it was told to begin
//! log.txt      the node's messages
//! all.zip      the results, while they come
//! odm/         the same, while they are unpacked
//! placed       they are about to be moved to their place
//! lock         held by the run that works here
//! ```

use std::collections::HashSet;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::client::unwritten;
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind};
use crate::formats::UNFINISHED;
use crate::options::difference;
use crate::reconstruct::{empty_work, lock_work};

/// A task that a run has begun.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Remembered {
    pub(crate) node: String,
    pub(crate) uuid: String,
    /// Whether the node has said that it has everything: until then it knows no task of that name.
    #[serde(default)]
    pub(crate) committed: bool,
}

/// The folder of a run.
pub(crate) struct Place {
    /// What is to be a flight.
    pub(crate) to: PathBuf,
    /// `DIR/unfinished`.
    pub(crate) work: PathBuf,
    /// Whether this run made the folder of the flight.
    is_new: bool,
    /// The photos, which are never written over.
    read: Inputs,
    /// Held as long as the run works.
    lock: File,
}

const TASK: &str = "task.json";
const ARRIVED: &str = "arrived.txt";
const PLACED: &str = "placed";
pub(crate) const LOG: &str = "log.txt";
pub(crate) const ARCHIVE: &str = "all.zip";
pub(crate) const ODM: &str = "odm";

impl Place {
    /// Takes the folder for a run of `told`. Unfinished work of something else is thrown away; the task that it
    /// had on a node is returned first, that of the same photos second.
    ///
    /// # Errors
    /// Where the folder cannot be written, another run works in it, or the node has a task of the same photos that was
    /// begun with other options: nobody forgets one in order to begin anew.
    pub(crate) fn take(
        to: &Path,
        photos: &Path,
        told: &str,
    ) -> Result<(Self, Option<Remembered>, Option<Remembered>), FileError> {
        let of = to.join(UNFINISHED);
        let work = of.parent().unwrap_or(to).to_owned();
        let is_new = !to.exists();
        let lock = lock_work(to, &work)?;
        let place = Self {
            to: to.to_owned(),
            work,
            is_new,
            read: Inputs::of([photos]),
            lock,
        };
        let before = place.remembered();
        let told_before = fs::read_to_string(&of).unwrap_or_default();
        if told_before == told {
            return Ok((place, None, before));
        }
        if let Some(task) = &before
            && let Some(difference) = other_options(&told_before, told)
        {
            let what = format!("the task that the node works on was asked {difference}");
            let remedy = format!(
                "give the same options, or remove {} (and the task {} on the node) to begin anew",
                place.work.display(),
                task.uuid
            );
            return Err(FileError::new(to, Fault::new(what, remedy)));
        }
        empty_work(&place.work).map_err(|error| unwritten(&place.work, &error))?;
        place.write("photos.txt", told.as_bytes())?;
        Ok((place, before, None))
    }

    /// A file of unfinished work.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.work.join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        let path = self.file(name);
        let written = files::write(&path, bytes, Kind::Result, &self.read, true);
        written.map_err(|fault| FileError::new(&path, fault))
    }

    /// A file of unfinished work that is written as it comes, begun anew.
    pub(crate) fn create(&self, name: &str) -> Result<(File, PathBuf), FileError> {
        let path = self.file(name);
        match File::create(&path) {
            Ok(file) => Ok((file, path)),
            Err(error) => Err(unwritten(&path, &error)),
        }
    }

    /// Takes results away that are none, or not whole.
    pub(crate) fn throw_away(&self, name: &str) {
        let path = self.file(name);
        // What is left over is thrown away by the next run.
        let _ = match path.is_dir() {
            true => fs::remove_dir_all(&path),
            false => fs::remove_file(&path),
        };
    }

    /// A folder of unfinished work that is not there.
    pub(crate) fn fresh(&self, name: &str) -> Result<PathBuf, FileError> {
        let path = self.file(name);
        if path.exists() {
            fs::remove_dir_all(&path).map_err(|error| unwritten(&path, &error))?;
        }
        Ok(path)
    }

    /// Moves unfinished work to its place in the flight, by other names. What a run of ours put there, that ended
    /// before the flight was whole, is taken away.
    ///
    /// # Errors
    /// Where something of somebody else is there.
    pub(crate) fn put(&self, names: &[(&str, &str)]) -> Result<(), FileError> {
        let is_ours = self.file(PLACED).exists();
        for (_, name) in names {
            let path = self.to.join(name);
            if !is_ours && path.exists() {
                let fault = Fault::new("it is there already", "name a new folder for the flight");
                return Err(FileError::new(&path, fault));
            }
        }
        self.write(PLACED, b"")?;
        for (from, name) in names {
            let path = self.to.join(name);
            let removed = match path.is_dir() {
                true => fs::remove_dir_all(&path),
                false if path.exists() => fs::remove_file(&path),
                false => Ok(()),
            };
            let moved = removed.and_then(|()| fs::rename(self.file(from), &path));
            moved.map_err(|error| unwritten(&path, &error))?;
        }
        Ok(())
    }

    /// Writes a file of the flight.
    pub(crate) fn write_flight(&self, path: &Path, bytes: &[u8]) -> Result<(), FileError> {
        let written = files::write(path, bytes, Kind::Flight, &self.read, false);
        written.map_err(|fault| FileError::new(path, fault))
    }

    /// The task that was begun here.
    pub(crate) fn remembered(&self) -> Option<Remembered> {
        let bytes = fs::read(self.file(TASK)).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    /// Remembers a task.
    pub(crate) fn remember(&self, task: &Remembered) -> Result<(), FileError> {
        let text = serde_json::to_vec(task).unwrap_or_default();
        self.write(TASK, &text)
    }

    /// Forgets it: a second run begins anew.
    pub(crate) fn forget(&self) {
        // What is left of it is found out to be gone by the next run.
        let _ = fs::remove_file(self.file(ARRIVED));
        let _ = fs::remove_file(self.file(TASK));
    }

    /// Which files of the remembered task the node has.
    ///
    /// # Errors
    /// Where that cannot be written down.
    pub(crate) fn arrived(&self) -> Result<ArrivedFiles, FileError> {
        let path = self.file(ARRIVED);
        let text = fs::read_to_string(&path).unwrap_or_default();
        // A last line that was cut off names no file.
        let lines = text
            .split_inclusive('\n')
            .filter_map(|line| line.strip_suffix('\n'));
        let before = lines.map(str::to_owned).collect();
        let opened = OpenOptions::new().append(true).create(true).open(&path);
        let file = opened.map_err(|error| unwritten(&path, &error))?;
        Ok(ArrivedFiles {
            before,
            file: Mutex::new(file),
        })
    }

    /// Throws the node's messages away: nobody asks why a task ended that they cancelled.
    pub(crate) fn forget_log(&self) {
        let _ = fs::remove_file(self.file(LOG));
    }

    /// Whether a second run has something to go on with, or to read.
    fn is_of_use(&self) -> bool {
        let has_messages = fs::metadata(self.file(LOG)).is_ok_and(|log| log.len() > 0);
        has_messages || self.file(TASK).exists()
    }

    /// Ends a run that came to nothing: an empty folder is nothing that anybody wants.
    pub(crate) fn leave(self) {
        if self.is_of_use() {
            return;
        }
        self.finish();
    }

    /// Takes the unfinished work away; and the folder itself, where this run made it and nothing else lies in it.
    pub(crate) fn finish(self) {
        drop(self.lock);
        // What is left over harms nobody.
        let _ = fs::remove_dir_all(&self.work);
        if self.is_new {
            // Only an empty one goes.
            let _ = fs::remove_dir(&self.to);
        }
    }
}

/// What is told of a run: its node, its options, and all that is sent.
pub(crate) fn told(node: &str, options: &str, sent: &str) -> String {
    format!("NodeODM at {node}\n{options}\n{sent}")
}

/// How the options of two runs differ that are the same otherwise.
fn other_options(before: &str, now: &str) -> Option<String> {
    let parts = |text: &str| -> Option<[String; 3]> {
        let (node, rest) = text.split_once('\n')?;
        let (options, sent) = rest.split_once('\n')?;
        Some([node.to_owned(), options.to_owned(), sent.to_owned()])
    };
    let [node, options, sent] = parts(before)?;
    let [node_now, options_now, sent_now] = parts(now)?;
    (node == node_now && sent == sent_now)
        .then(|| difference(&options, &options_now))
        .flatten()
}

/// The files that a node has said it has, written down as it says so.
pub(crate) struct ArrivedFiles {
    before: HashSet<String>,
    file: Mutex<File>,
}

impl ArrivedFiles {
    /// Whether a run before this one sent it.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.before.contains(name)
    }

    /// The node has it.
    pub(crate) fn add(&self, name: &str) {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        // What is not written down is sent twice, which the counting of photos finds.
        let _ = file.write_all(format!("{name}\n").as_bytes());
    }
}

/// The node's messages, as they come.
pub(crate) struct Log {
    file: File,
    path: PathBuf,
    /// How many bytes it has.
    size: u64,
    /// The last lines.
    pub(crate) last: Vec<String>,
}

/// Messages of weeks.
const LONGEST_LOG: u64 = 256 << 20;
/// So many lines are looked at where a task has failed.
const LAST: usize = 20;

impl Log {
    /// Begins it anew.
    pub(crate) fn begin(place: &Place) -> Result<Self, FileError> {
        let (file, path) = place.create(LOG)?;
        Ok(Self {
            file,
            path,
            size: 0,
            last: Vec::new(),
        })
    }

    /// Adds a line.
    pub(crate) fn add(&mut self, line: &str) -> Result<(), FileError> {
        self.last.push(line.to_owned());
        if self.last.len() > LAST {
            self.last.remove(0);
        }
        self.size += line.len() as u64 + 1;
        if self.size > LONGEST_LOG {
            return Ok(());
        }
        let written = writeln!(self.file, "{line}");
        written.map_err(|error| unwritten(&self.path, &error))
    }

    /// Where it lies.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}
