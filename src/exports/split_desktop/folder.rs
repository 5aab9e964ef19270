//! The folder that is exported to, and what in it is ours.
//!
//! `export.json` lists every file that an export writes, each with the checksum of its contents, and
//! is itself written before the file. So whatever is found in the folder is one of three things: a
//! file as we wrote it (its checksum is in the list), which is kept or replaced; or a file that
//! somebody else put there or changed, which is left alone and makes the export stop before it writes
//! anything; or nothing. For the pictures of a photo the list also keeps what they were made from, so
//! that an export that is started again makes only those that are missing or out of date.
//!
//! The list also says which flight it is of: an export of another one would take its pictures away, so
//! that has to be asked for. A file that the flight was read from is never written over, nor taken
//! away, whatever the list says of it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::list::{Entry, LIST, List, PROGRAM};
use super::whose::FlightOfExport;
use crate::fault::Fault;
use crate::files::{
    FileError, Inputs, cannot_be, is_unfinished, note_kept, sha256_of_bytes, sha256_of_file,
    write_whole,
};
use crate::jobs::Progress;

/// What of others an export may replace, besides its own files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Replace {
    /// Nothing.
    #[default]
    Nothing,
    /// The export of another flight.
    OtherFlight,
    /// That, and files that are in the way.
    Anything,
}

/// A folder that is exported to.
pub(super) struct ExportFolder<'a> {
    folder: PathBuf,
    list: List,
    /// What the flight was read from.
    read: &'a Inputs,
    replace: Replace,
    /// Checksums of the planned files that are there.
    present: BTreeMap<String, String>,
}

impl<'a> ExportFolder<'a> {
    /// Opens or makes the folder for these files (paths below it, with slashes). Nothing is written
    /// where one of them was read, or is there already, is not ours and may not be replaced.
    pub(super) fn open(
        folder: &Path,
        flight: &FlightOfExport,
        read: &'a Inputs,
        replace: Replace,
        planned: &[String],
        progress: &Progress,
    ) -> Result<Self, FileError> {
        let cannot =
            |path: &Path, what: &str, e: &io::Error| FileError::new(path, cannot_be(what, e));
        let list_path = folder.join(LIST);
        let empty = List {
            program: PROGRAM.to_owned(),
            flight: None,
            files: BTreeMap::new(),
        };
        let mut list = match fs::read(&list_path) {
            Ok(bytes) => serde_json::from_slice::<List>(&bytes)
                .ok()
                .filter(|list| list.program == PROGRAM)
                .or_else(|| (replace == Replace::Anything).then_some(empty))
                .ok_or_else(|| not_ours(&list_path, "it is no list of an export"))?,
            Err(e) if e.kind() == io::ErrorKind::NotFound => empty,
            Err(e) => return Err(cannot(&list_path, "read", &e)),
        };
        let before = list.flight.replace(flight.clone());
        if let Some(before) = before.filter(|before| !before.is(flight))
            && replace == Replace::Nothing
        {
            let before = before.in_words();
            let what = format!("it holds the export of another flight, {before}");
            let remedy = "choose another folder, or say that it may be replaced (--force)";
            return Err(FileError::new(folder, Fault::new(what, remedy)));
        }
        let mut opened = Self {
            folder: folder.to_owned(),
            list,
            read,
            replace,
            present: BTreeMap::new(),
        };
        opened.refuse_what_was_read(LIST)?;
        progress.stage("checking what is there");
        for (done, name) in planned.iter().enumerate() {
            progress
                .advance(done as u64, planned.len() as u64)
                .map_err(|fault| FileError::new(folder, fault))?;
            if let Some(sum) = opened.check(name, progress)? {
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
        opened.remove_unfinished(planned);
        Ok(opened)
    }

    /// Takes away what an export that was killed had not finished. Where that fails nothing is lost but
    /// room on the disk.
    fn remove_unfinished(&self, planned: &[String]) {
        let below = planned.iter().filter_map(|name| name.rsplit_once('/'));
        let mut folders: BTreeSet<PathBuf> =
            below.map(|(below, _)| self.folder.join(below)).collect();
        folders.insert(self.folder.clone());
        for folder in folders {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let path = entry.path();
                let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
                if is_file && is_unfinished(&path) && self.read.named(&path).is_none() {
                    let _ = fs::remove_file(path);
                }
            }
        }
    }

    /// A file that the flight was read from stays, whoever wrote it.
    fn refuse_what_was_read(&self, name: &str) -> Result<(), FileError> {
        let path = self.folder.join(name);
        let Some(read) = self.read.named(&path) else {
            return Ok(());
        };
        let read = read.display();
        let what = format!("the flight was read from it ({read}), so it is not written over");
        let remedy = "choose another folder";
        Err(FileError::new(&path, Fault::new(what, remedy)))
    }

    /// The folder itself.
    pub(super) fn path(&self) -> &Path {
        &self.folder
    }

    /// The checksum of a file that is there and ours; `None` where there is none, or one of others
    /// that may be replaced.
    fn check(&self, name: &str, progress: &Progress) -> Result<Option<String>, FileError> {
        self.refuse_what_was_read(name)?;
        let ours = self.check_ours(name, progress);
        if ours.is_err() && self.replace == Replace::Anything {
            let path = self.folder.join(name);
            // A folder stays in the way, and what is part of the reconstruction.
            let is_file = fs::metadata(&path).is_ok_and(|metadata| metadata.is_file());
            if is_file && self.read.on_the_way(&path).is_none() {
                return Ok(None);
            }
        }
        ours
    }

    /// The checksum of a file that is there and ours; `None` where there is none.
    fn check_ours(&self, name: &str, progress: &Progress) -> Result<Option<String>, FileError> {
        let path = self.folder.join(name);
        match fs::symlink_metadata(&path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Ok(metadata) if metadata.is_file() => {}
            _ => return Err(not_ours(&path, "it is there already")),
        }
        let Some(entry) = self.list.files.get(name) else {
            return Err(not_ours(&path, "it is there already"));
        };
        let sum = sha256_of_file(&path, || progress.is_cancelled())
            .map_err(|e| FileError::new(&path, cannot_be("read", &e)))?;
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

    /// Leaves files as they are that are done.
    pub(super) fn keep(&self, names: &[String]) {
        for name in names {
            note_kept(&self.folder.join(name));
        }
    }

    /// Writes files; each is there whole or not at all.
    pub(super) fn write(
        &mut self,
        files: &[(String, Vec<u8>)],
        made_from: Option<&str>,
    ) -> Result<(), FileError> {
        for (name, bytes) in files {
            let entry = Entry {
                sha256: sha256_of_bytes(bytes),
                replaces: self.present.get(name).cloned(),
                made_from: made_from.map(str::to_owned),
            };
            self.list.files.insert(name.clone(), entry);
        }
        self.write_list()?;
        for (name, bytes) in files {
            let entry = self.list.files.get(name);
            let sum = entry.map(|entry| entry.sha256.clone()).unwrap_or_default();
            let path = self.folder.join(name);
            if self.present.get(name) == Some(&sum) {
                note_kept(&path);
            } else {
                let is_new =
                    !self.present.contains_key(name) && fs::symlink_metadata(&path).is_ok();
                if is_new && self.replace != Replace::Anything {
                    return Err(not_ours(&path, "it was put there meanwhile"));
                }
                self.write_file(name, bytes)?;
                self.present.insert(name.clone(), sum);
            }
        }
        Ok(())
    }

    /// Takes away the files of earlier exports that this one does not have, so that the pictures are
    /// those of the sheet; returns their names. A file that was changed since is left where it is.
    pub(super) fn remove_others(
        &mut self,
        planned: &[String],
        progress: &Progress,
    ) -> Result<Vec<String>, FileError> {
        let mut removed = Vec::new();
        let names: Vec<String> = self.list.files.keys().cloned().collect();
        for name in names.into_iter().filter(|name| !planned.contains(name)) {
            // A list from elsewhere could name anything; ours names no file outside.
            let is_inside = name.split('/').all(|part| !["", ".", ".."].contains(&part))
                && !name.contains(['\\', ':']);
            let was_read = self.read.named(&self.folder.join(&name)).is_some();
            if is_inside && !was_read && matches!(self.check_ours(&name, progress), Ok(Some(_))) {
                let path = self.folder.join(&name);
                fs::remove_file(&path).map_err(|e| {
                    let what = format!("the file of an earlier export cannot be removed ({e})");
                    FileError::new(&path, Fault::new(what, "remove it yourself"))
                })?;
                removed.push(name.clone());
            }
            self.list.files.remove(&name);
        }
        for entry in self.list.files.values_mut() {
            entry.replaces = None;
        }
        self.write_list()?;
        Ok(removed)
    }

    fn write_list(&self) -> Result<(), FileError> {
        let text = serde_json::to_string_pretty(&self.list).map_err(|e| {
            let what = format!("the list of files cannot be written ({e})");
            FileError::new(&self.folder, Fault::new(what, "report this"))
        })?;
        self.write_file(LIST, text.as_bytes())
    }

    fn write_file(&self, name: &str, bytes: &[u8]) -> Result<(), FileError> {
        self.refuse_what_was_read(name)?;
        let path = self.folder.join(name);
        write_whole(&path, bytes).map_err(|e| {
            let mut fault = cannot_be("written", &e);
            fault.remedy.push_str("; what is written stays good");
            FileError::new(&path, fault)
        })
    }
}

fn not_ours(path: &Path, what: &str) -> FileError {
    let what = format!("{what} and is not from fragscale, so it is not written over");
    FileError::new(
        path,
        Fault::new(
            what,
            "move it away, or choose another folder (--force replaces it)",
        ),
    )
}

#[cfg(test)]
mod tests;
