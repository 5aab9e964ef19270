//! The folder of unfinished work, in which one run works at a time.

use std::fs::{self, File};
use std::io;
use std::path::Path;

use crate::fault::Fault;
use crate::files::{self, FileError, cannot_be};

const LOCK: &str = "lock";

/// Makes the folder `work` for a run that writes to `to`, and keeps others out as long as what is returned lives.
///
/// # Errors
/// Where the folder cannot be written, or another run works in it.
pub fn lock_work(to: &Path, work: &Path) -> Result<File, FileError> {
    let unwritten = |error: io::Error| FileError::new(work, cannot_be("written", &error));
    fs::create_dir_all(work).map_err(unwritten)?;
    let lock = files::lock(&work.join(LOCK)).map_err(unwritten)?;
    lock.ok_or_else(|| {
        let fault = Fault::new(
            "another run works in this folder",
            "wait until it has ended, or name a new folder",
        );
        FileError::new(to, fault)
    })
}

/// Throws away what lies in it.
///
/// # Errors
/// What the system says.
pub fn empty_work(work: &Path) -> io::Result<()> {
    for entry in fs::read_dir(work)? {
        let path = entry?.path();
        if path.ends_with(LOCK) {
            continue;
        }
        let is_folder = fs::symlink_metadata(&path).is_ok_and(|entry| entry.is_dir());
        match is_folder {
            true => fs::remove_dir_all(&path)?,
            false => fs::remove_file(&path)?,
        }
    }
    Ok(())
}
