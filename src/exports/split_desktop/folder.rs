//! The folder that is exported to, and what in it is ours.
//!
//! `export.json` lists every file that an export writes, each with the checksum of its contents, and
//! is itself written before the file. So whatever is found in the folder is one of three things: a
//! file as we wrote it (its checksum is in the list), which is kept or replaced; or a file that
//! somebody else put there or changed, which is left alone and makes the export stop before it writes
//! anything; or nothing. For the pictures of a photo the list also keeps what they were made from, so
//! that an export that is started again makes only those that are missing or out of date.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::checksum;
use crate::exports::atomic::write_whole;
use crate::fault::Fault;
use crate::jobs::Progress;

/// The list's file.
const LIST: &str = "export.json";

/// What went wrong, and with which file; prints as `FILE: what; remedy`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExportError {
    /// Below the folder that was exported to, or the folder.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: Fault,
}

impl ExportError {
    pub(super) fn new(path: &Path, fault: Fault) -> Self {
        Self {
            path: path.to_owned(),
            fault,
        }
    }
}

impl fmt::Display for ExportError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A file name may hold line breaks; the error stays on one line.
        for c in self.path.display().to_string().chars() {
            write!(f, "{}", if c.is_control() { '?' } else { c })?;
        }
        write!(f, ": {}", self.fault)
    }
}

impl std::error::Error for ExportError {}

/// `export.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct List {
    /// Says that the list is ours.
    program: String,
    /// By path below the folder, with slashes.
    files: BTreeMap<String, Entry>,
}

/// A file of ours.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
struct Entry {
    /// Of its contents, when it is written.
    sha256: String,
    /// Of the contents that it is about to replace; both are ours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    replaces: Option<String>,
    /// What it was made from; see [`ExportFolder::is_done`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    made_from: Option<String>,
}

const PROGRAM: &str = "fragscale export for Split-Desktop, format 1";

/// A folder that is exported to.
pub(super) struct ExportFolder {
    folder: PathBuf,
    list: List,
    /// Checksums of the planned files that are there.
    present: BTreeMap<String, String>,
}

impl ExportFolder {
    /// Opens or makes the folder for these files (paths below it, with slashes). Nothing is written
    /// where one of them is there already and is not ours.
    pub(super) fn open(
        folder: &Path,
        planned: &[String],
        progress: &Progress,
    ) -> Result<Self, ExportError> {
        let cannot = |path: &Path, what: &str, e: &io::Error| {
            let what = format!("it cannot be {what} ({e})");
            ExportError::new(path, Fault::new(what, "choose another folder"))
        };
        let list_path = folder.join(LIST);
        let list = match fs::read(&list_path) {
            Ok(bytes) => serde_json::from_slice::<List>(&bytes)
                .ok()
                .filter(|list| list.program == PROGRAM)
                .ok_or_else(|| not_ours(&list_path, "it is no list of an export"))?,
            Err(e) if e.kind() == io::ErrorKind::NotFound => List {
                program: PROGRAM.to_owned(),
                files: BTreeMap::new(),
            },
            Err(e) => return Err(cannot(&list_path, "read", &e)),
        };
        let mut opened = Self {
            folder: folder.to_owned(),
            list,
            present: BTreeMap::new(),
        };
        progress.stage("checking what is there");
        for (done, name) in planned.iter().enumerate() {
            progress
                .advance(done as u64, planned.len() as u64)
                .map_err(|fault| ExportError::new(folder, fault))?;
            if let Some(sum) = opened.check_ours(name, progress)? {
                opened.present.insert(name.clone(), sum);
            }
        }
        for name in planned {
            if let Some((below, _)) = name.rsplit_once('/') {
                let path = folder.join(below);
                fs::create_dir_all(&path).map_err(|e| cannot(&path, "made", &e))?;
            }
        }
        fs::create_dir_all(folder).map_err(|e| cannot(folder, "made", &e))?;
        Ok(opened)
    }

    /// The folder itself.
    pub(super) fn path(&self) -> &Path {
        &self.folder
    }

    /// The checksum of a file that is there and ours; `None` where there is none.
    fn check_ours(&self, name: &str, progress: &Progress) -> Result<Option<String>, ExportError> {
        let path = self.folder.join(name);
        match fs::symlink_metadata(&path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Ok(metadata) if metadata.is_file() => {}
            _ => return Err(not_ours(&path, "it is there already")),
        }
        let Some(entry) = self.list.files.get(name) else {
            return Err(not_ours(&path, "it is there already"));
        };
        let sum = checksum::of_file(&path, progress).map_err(|e| {
            let what = format!("it cannot be read ({e})");
            ExportError::new(&path, Fault::new(what, "choose another folder"))
        })?;
        if sum == entry.sha256 || Some(&sum) == entry.replaces.as_ref() {
            return Ok(Some(sum));
        }
        Err(not_ours(&path, "it was changed since it was exported"))
    }

    /// Whether these files are there, whole, and were made from what `made_from` stands for.
    pub(super) fn is_done(&self, names: &[String], made_from: &str) -> bool {
        names.iter().all(|name| {
            self.list.files.get(name).is_some_and(|entry| {
                entry.made_from.as_deref() == Some(made_from)
                    && self.present.get(name) == Some(&entry.sha256)
            })
        })
    }

    /// Writes files; each is there whole or not at all.
    pub(super) fn write(
        &mut self,
        files: &[(String, Vec<u8>)],
        made_from: Option<&str>,
    ) -> Result<(), ExportError> {
        for (name, bytes) in files {
            let entry = Entry {
                sha256: checksum::of_bytes(bytes),
                replaces: self.present.get(name).cloned(),
                made_from: made_from.map(str::to_owned),
            };
            self.list.files.insert(name.clone(), entry);
        }
        self.write_list()?;
        for (name, bytes) in files {
            let entry = self.list.files.get(name);
            let sum = entry.map(|entry| entry.sha256.clone()).unwrap_or_default();
            if self.present.get(name) != Some(&sum) {
                self.write_file(name, bytes)?;
                self.present.insert(name.clone(), sum);
            }
        }
        Ok(())
    }

    /// Takes away the files of earlier exports that this one does not have, so that the pictures are
    /// those of the sheet. A file that was changed since is left where it is.
    pub(super) fn remove_others(
        &mut self,
        planned: &[String],
        progress: &Progress,
    ) -> Result<(), ExportError> {
        let names: Vec<String> = self.list.files.keys().cloned().collect();
        for name in names.into_iter().filter(|name| !planned.contains(name)) {
            // A list from elsewhere could name anything; ours names no file outside.
            let is_inside = name.split('/').all(|part| !["", ".", ".."].contains(&part))
                && !name.contains(['\\', ':']);
            if is_inside && matches!(self.check_ours(&name, progress), Ok(Some(_))) {
                let path = self.folder.join(&name);
                fs::remove_file(&path).map_err(|e| {
                    let what = format!("the file of an earlier export cannot be removed ({e})");
                    ExportError::new(&path, Fault::new(what, "remove it yourself"))
                })?;
            }
            self.list.files.remove(&name);
        }
        for entry in self.list.files.values_mut() {
            entry.replaces = None;
        }
        self.write_list()
    }

    fn write_list(&self) -> Result<(), ExportError> {
        let text = serde_json::to_string_pretty(&self.list).map_err(|e| {
            let what = format!("the list of files cannot be written ({e})");
            ExportError::new(&self.folder, Fault::new(what, "report this"))
        })?;
        self.write_file(LIST, text.as_bytes())
    }

    fn write_file(&self, name: &str, bytes: &[u8]) -> Result<(), ExportError> {
        let path = self.folder.join(name);
        write_whole(&path, bytes).map_err(|e| {
            let what = format!("it cannot be written ({e})");
            let remedy = "check the disk, or choose another folder; what is written stays good";
            ExportError::new(&path, Fault::new(what, remedy))
        })
    }
}

fn not_ours(path: &Path, what: &str) -> ExportError {
    let what = format!("{what} and is not from fragscale, so it is not written over");
    ExportError::new(
        path,
        Fault::new(what, "move it away, or choose another folder"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn open(folder: &Path, planned: &[&str]) -> Result<ExportFolder, ExportError> {
        let planned: Vec<String> = planned.iter().map(|&name| name.to_owned()).collect();
        ExportFolder::open(folder, &planned, &Progress::default())
    }

    fn file(name: &str, text: &str) -> (String, Vec<u8>) {
        (name.to_owned(), text.as_bytes().to_vec())
    }

    #[test]
    fn what_is_done_is_known_again() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("new/export");
        let name = ["photos/a.jpg".to_owned()];
        let mut first = open(&folder, &["photos/a.jpg"]).unwrap();
        assert!(!first.is_done(&name, "x"));
        first
            .write(&[file("photos/a.jpg", "one")], Some("x"))
            .unwrap();
        let again = open(&folder, &["photos/a.jpg"]).unwrap();
        assert!(again.is_done(&name, "x") && !again.is_done(&name, "y"));
        fs::remove_file(folder.join("photos/a.jpg")).unwrap();
        assert!(
            !open(&folder, &["photos/a.jpg"])
                .unwrap()
                .is_done(&name, "x")
        );
    }

    #[test]
    fn files_of_others_are_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scales.csv"), "mine").unwrap();
        let error = open(folder.path(), &["photos/a.jpg", "scales.csv"])
            .err()
            .unwrap();
        assert!(
            error
                .to_string()
                .contains("scales.csv: it is there already"),
            "{error}"
        );
        // Nothing was made.
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        // Others beside ours do not matter.
        open(folder.path(), &["a.txt"])
            .unwrap()
            .write(&[file("a.txt", "1")], None)
            .unwrap();
        fs::write(folder.path().join("a.txt"), "edited").unwrap();
        let error = open(folder.path(), &["a.txt"]).err().unwrap();
        assert!(error.to_string().contains("was changed"), "{error}");
        fs::write(folder.path().join("export.json"), "{}").unwrap();
        assert!(open(folder.path(), &["b.txt"]).is_err());
        assert_eq!(fs::read(folder.path().join("scales.csv")).unwrap(), b"mine");
    }

    #[test]
    fn an_interrupt_between_the_list_and_the_file_can_be_gone_on_from() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        open(folder.path(), &["a.txt"])
            .unwrap()
            .write(&[file("a.txt", "old")], None)
            .unwrap();
        let mut second = open(folder.path(), &["a.txt"]).unwrap();
        second.write(&[file("a.txt", "new")], None).unwrap();
        // As if the file had not been replaced yet.
        fs::write(&path, "old").unwrap();
        let mut third = open(folder.path(), &["a.txt"]).unwrap();
        third.write(&[file("a.txt", "new")], None).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn only_our_own_left_overs_go() {
        let folder = tempfile::tempdir().unwrap();
        let mut export = open(folder.path(), &["a.txt", "b.txt", "c.txt"]).unwrap();
        export
            .write(
                &[file("a.txt", "a"), file("b.txt", "b"), file("c.txt", "c")],
                None,
            )
            .unwrap();
        fs::write(folder.path().join("b.txt"), "edited").unwrap();
        fs::write(folder.path().join("d.txt"), "foreign").unwrap();
        let planned = ["c.txt".to_owned()];
        let mut export = open(folder.path(), &["c.txt"]).unwrap();
        export
            .remove_others(&planned, &Progress::default())
            .unwrap();
        let there = |name| folder.path().join(name).exists();
        assert!(!there("a.txt") && there("b.txt") && there("c.txt") && there("d.txt"));
        // A list that names what is outside takes nothing away there.
        let outside = tempfile::tempdir().unwrap();
        let victim = outside.path().join("v");
        fs::write(&victim, "v").unwrap();
        let name = victim.to_str().unwrap().to_owned();
        export.list.files.insert(
            name,
            Entry {
                sha256: checksum::of_bytes(b"v"),
                ..Entry::default()
            },
        );
        export
            .remove_others(&planned, &Progress::default())
            .unwrap();
        assert!(victim.exists());
    }
}
