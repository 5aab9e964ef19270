//! Opening files: whole bytes, text, and errors that carry the file's name.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use crate::fault::Fault;
use crate::files::note_opened;

/// A fault and the file that it is in; prints as `FILE[:LINE]: what; remedy`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileError {
    /// As the user named it or as it was found below what the user named.
    pub file: PathBuf,
    /// What is wrong inside.
    pub fault: Fault,
}

impl FileError {
    /// A fault of `file`.
    pub fn new(file: &Path, fault: Fault) -> Self {
        Self {
            file: file.to_owned(),
            fault,
        }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A file name may hold line breaks; the error stays on one line.
        let name = self.file.display().to_string();
        for c in name.chars() {
            write!(f, "{}", if c.is_control() { '?' } else { c })?;
        }
        if let Some(line) = self.fault.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.fault)
    }
}

impl std::error::Error for FileError {}

/// A file or folder that cannot be `done` ("read", "written", "made"): the folder it lies in may be full,
/// or not the user's.
pub fn cannot_be(done: &str, error: &std::io::Error) -> Fault {
    let what = format!("it cannot be {done} ({error})");
    Fault::new(what, "check the disk, or choose another folder")
}

/// A folder whose files cannot be listed.
pub fn unreadable_folder(error: &std::io::Error) -> Fault {
    match error.kind() {
        std::io::ErrorKind::NotFound => Fault::new("there is no such folder", "check the path"),
        _ => Fault::new(
            format!("a folder that cannot be read ({error})"),
            "check its permissions",
        ),
    }
}

/// Opens a file for reading; a directory is refused in words.
///
/// # Errors
/// Where it is missing, a directory, or not readable.
pub fn open_file(path: &Path) -> Result<fs::File, FileError> {
    let failed = |e: &std::io::Error| {
        let (what, remedy) = match e.kind() {
            std::io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path"),
            std::io::ErrorKind::PermissionDenied => {
                ("it may not be read".to_owned(), "check its permissions")
            }
            _ => (
                format!("it cannot be read ({e})"),
                "check the path and the disk",
            ),
        };
        FileError::new(path, Fault::new(what, remedy))
    };
    let metadata = fs::metadata(path).map_err(|e| failed(&e))?;
    if metadata.is_dir() {
        return Err(FileError::new(
            path,
            Fault::new(
                "a folder, where a file is needed",
                "name the file inside it",
            ),
        ));
    }
    note_opened(path);
    fs::File::open(path).map_err(|e| failed(&e))
}

/// The whole of a file.
///
/// # Errors
/// Where it cannot be read.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    use std::io::Read;
    let mut bytes = Vec::new();
    open_file(path)?.read_to_end(&mut bytes).map_err(|e| {
        let what = format!("it cannot be read to its end ({e})");
        FileError::new(path, Fault::new(what, "check the disk"))
    })?;
    Ok(bytes)
}

/// The whole of a file that is not larger than `most` bytes: what is larger is none of its `kind` ("mission"), which
/// the remedy names.
///
/// # Errors
/// Where it cannot be read, or is larger.
pub fn read_small(path: &Path, most: u64, kind: &str, remedy: &str) -> Result<Vec<u8>, FileError> {
    use std::io::Read;
    let mut bytes = Vec::new();
    let read = open_file(path)?.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|e| {
        let what = format!("it cannot be read to its end ({e})");
        FileError::new(path, Fault::new(what, "check the disk"))
    })?;
    if bytes.len() as u64 > most {
        let what = format!("it is larger than {} MB, no {kind}", most >> 20);
        return Err(FileError::new(path, Fault::new(what, remedy)));
    }
    Ok(bytes)
}

/// Bytes as text: UTF-8, without the byte order mark that some programs put in front.
///
/// # Errors
/// Where the bytes are not UTF-8, with the line of the first that is not.
pub fn text_from_bytes(bytes: &[u8]) -> Result<&str, Fault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| {
        let good = bytes.get(..e.valid_up_to()).unwrap_or_default();
        let line = 1 + good.iter().filter(|&&b| b == b'\n').count() as u64;
        Fault::at(line, "it is not UTF-8 text", "save it as UTF-8")
    })
}

/// The whole of a text file, without its byte order mark.
///
/// # Errors
/// Where it cannot be read or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let bytes = read_bytes(path)?;
    let text = text_from_bytes(&bytes).map_err(|fault| FileError::new(path, fault))?;
    Ok(text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_drops_the_mark_and_places_the_fault() {
        assert_eq!(text_from_bytes(b"\xef\xbb\xbfa\n"), Ok("a\n"));
        assert_eq!(text_from_bytes(b"a\nb\n\xff").unwrap_err().line, Some(3));
    }

    #[test]
    fn an_error_is_one_line_with_its_place() {
        let error = FileError::new(Path::new("a\nb.csv"), Fault::at(7, "no x", "add it"));
        assert_eq!(error.to_string(), "a?b.csv:7: no x; add it");
    }

    #[test]
    fn folders_and_missing_files_are_named() {
        let folder = read_bytes(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_err();
        assert!(
            folder.to_string().ends_with("name the file inside it"),
            "{folder}"
        );
        assert!(read_text(Path::new("no/such")).is_err());
        let missing = unreadable_folder(&fs::read_dir("no/such").unwrap_err());
        assert_eq!(
            missing.to_string(),
            "there is no such folder; check the path"
        );
        let refused = unreadable_folder(&std::io::ErrorKind::PermissionDenied.into());
        assert_eq!(
            refused.to_string(),
            "a folder that cannot be read (permission denied); check its permissions"
        );
    }
}
