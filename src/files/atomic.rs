//! Files that are there whole or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::recording::note_written;

/// How the name of a file or folder that is not finished begins and ends.
const UNFINISHED_NAME: (&str, &str) = (".fragscale-", ".part");

/// The temporary file or folder that is being written, so that an interrupt can take it away.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Writes a file: first beside its place, then moved there in one step. An existing file is replaced
/// or, on any error, left as it was.
///
/// # Errors
/// What the system says, for instance that the folder is missing or the disk is full.
pub fn write_whole(path: &Path, contents: &[u8]) -> io::Result<()> {
    note_written(path);
    // A device or a pipe cannot be replaced by a file.
    if fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir()) {
        return fs::OpenOptions::new()
            .write(true)
            .open(path)?
            .write_all(contents);
    }
    // Through a link, so that the file behind it is replaced and not the link.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut file = tempfile::Builder::new()
        .prefix(UNFINISHED_NAME.0)
        .suffix(UNFINISHED_NAME.1)
        .tempfile_in(folder)?;
    set_unfinished(Some(file.path().to_owned()));
    let result = file.write_all(contents).and_then(|()| {
        keep_permissions(path, file.as_file())?;
        file.as_file().sync_all()
    });
    let result = result.and_then(|()| file.persist(path).map(|_| ()).map_err(|e| e.error));
    set_unfinished(None);
    result
}

/// Makes a folder with everything in it: `fill` writes into a folder beside its place, which is
/// moved there in one step when it is complete, and taken away on any error.
///
/// # Errors
/// What `fill` says, or the system; and where the folder is there already and not empty.
pub fn make_folder_whole<E: From<io::Error>>(
    path: &Path,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    if fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(io::Error::from(io::ErrorKind::DirectoryNotEmpty).into());
    }
    let parent = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let part = tempfile::Builder::new()
        .prefix(UNFINISHED_NAME.0)
        .suffix(UNFINISHED_NAME.1)
        .tempdir_in(parent)?;
    set_unfinished(Some(part.path().to_owned()));
    let result = fill(part.path()).and_then(|()| {
        // An empty folder in its place is replaced.
        match fs::remove_dir(path) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => return Err(e.into()),
            _ => {}
        }
        open_to_others(part.path()).map_err(E::from)?;
        fs::rename(part.path(), path).map_err(E::from)
    });
    set_unfinished(None);
    result
}

/// Whether a file is named like one that fragscale has not finished: a killed process leaves it.
pub fn is_unfinished(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with(UNFINISHED_NAME.0) && name.ends_with(UNFINISHED_NAME.1)
}

/// Takes away what an interrupted write would leave.
pub fn remove_unfinished() {
    let unfinished = UNFINISHED
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take();
    if let Some(path) = unfinished {
        // The program is about to end; there is nobody to tell.
        let _ = fs::remove_file(&path).or_else(|_| fs::remove_dir_all(&path));
    }
}

fn set_unfinished(path: Option<PathBuf>) {
    *UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner) = path;
}

/// A temporary file is private; the file in its place has the permissions of the one that it
/// replaces, or those that a new file usually has.
#[cfg(unix)]
fn keep_permissions(path: &Path, file: &fs::File) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let permissions = match fs::metadata(path) {
        Ok(metadata) => metadata.permissions(),
        Err(_) => fs::Permissions::from_mode(0o644),
    };
    file.set_permissions(permissions)
}

/// A temporary folder is private, too.
#[cfg(unix)]
fn open_to_others(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(folder, fs::Permissions::from_mode(0o755))
}

#[cfg(not(unix))]
fn open_to_others(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(not(unix))]
fn keep_permissions(_: &Path, _: &fs::File) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_whole_files_and_leaves_nothing_beside() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scales.csv");
        write_whole(&path, b"first").unwrap();
        write_whole(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_is_there_whole_or_not_at_all() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("flight");
        let fill = |part: &Path| fs::write(part.join("a"), b"x");
        make_folder_whole(&folder, fill).unwrap();
        assert_eq!(fs::read(folder.join("a")).unwrap(), b"x");
        // It is not written over.
        assert!(make_folder_whole(&folder, fill).is_err());
        let other = parent.path().join("other");
        fs::create_dir(&other).unwrap();
        let half = |part: &Path| {
            fs::write(part.join("a"), b"x")?;
            Err(io::Error::other("no more"))
        };
        assert!(make_folder_whole(&other, half).is_err());
        assert_eq!(fs::read_dir(&other).unwrap().count(), 0);
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 2);
        make_folder_whole(&other, fill).unwrap();
    }

    #[test]
    fn an_error_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        assert!(write_whole(&folder.path().join("no/such/folder.csv"), b"x").is_err());
        // A folder in its place.
        assert!(write_whole(folder.path(), b"x").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
