//! What may be written over: never a file that was read, and a file that fragscale did not write only
//! where somebody said so. Every file that goes out is written by [`write()`]; the folder of an export,
//! which has a list of its own files, keeps the same rule with that list (`exports::split_desktop`).

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::atomic::write_whole;
use super::input::{FileError, cannot_be};
use super::inputs::Inputs;
use super::marks::{self, Kind, LOOKED_AT};
use crate::fault::Fault;

/// What stands where something is to be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// Nothing, or what nothing is lost of: an empty file, a device, a pipe.
    Free,
    /// A file of the same kind that fragscale wrote.
    Ours,
    /// Any other file.
    Foreign,
    /// This file, which was read.
    Read(PathBuf),
    /// A file in this folder, which was read as a whole.
    ReadFolder(PathBuf),
    /// A folder.
    Folder,
}

/// What stands at `path`, links followed.
pub fn standing(path: &Path, kind: Kind, inputs: &Inputs) -> Standing {
    let metadata = match fs::metadata(path) {
        Ok(metadata) => metadata,
        // Where it cannot be seen it cannot be written either, and that is said then.
        Err(_) => return Standing::Free,
    };
    if metadata.is_dir() {
        return Standing::Folder;
    }
    if !metadata.is_file() {
        return Standing::Free;
    }
    if let Some(read) = inputs.named(path) {
        return Standing::Read(read.to_owned());
    }
    if metadata.len() == 0 {
        return Standing::Free;
    }
    // What cannot be read is nobody's that is known.
    if beginning(path).is_ok_and(|bytes| Kind::of(&bytes) == Some(kind)) {
        return Standing::Ours;
    }
    match inputs.on_the_way(path) {
        Some(read) if read.is_dir() => Standing::ReadFolder(read.to_owned()),
        Some(read) => Standing::Read(read.to_owned()),
        None => Standing::Foreign,
    }
}

/// What of fragscale's results a file is, as "a table of scales"; `None` of any other, and of what cannot be read.
pub fn result_in_words(path: &Path) -> Option<&'static str> {
    let bytes = path.is_file().then(|| beginning(path).ok())?;
    marks::result_in_words(&bytes?)
}

fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    fs::File::open(path)?
        .take(LOOKED_AT)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Whether the folder of a file is there, which nobody is going to make.
///
/// # Errors
/// Where it is not.
pub fn has_folder(path: &Path) -> Result<(), Fault> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty() && !folder.is_dir());
    let Some(folder) = folder else {
        return Ok(());
    };
    let what = match folder.exists() {
        true => format!("it cannot be written: {} is no folder", folder.display()),
        false => format!(
            "it cannot be written: there is no folder {}",
            folder.display()
        ),
    };
    Err(Fault::new(what, "make it, or choose another folder"))
}

/// Whether a file of this kind may be written to `path`. With `force` a file of others may be replaced;
/// one that was read never.
///
/// # Errors
/// Why not.
pub fn may_write(path: &Path, kind: Kind, inputs: &Inputs, force: bool) -> Result<(), Fault> {
    let another = "write to another file";
    match standing(path, kind, inputs) {
        Standing::Free | Standing::Ours => Ok(()),
        Standing::Foreign if force => Ok(()),
        Standing::Foreign => {
            let what = match kind {
                Kind::Flight => "it is there already and is no flight file that fragscale wrote",
                Kind::Result => "it is there already and is no result that fragscale wrote",
            };
            let remedy = "give another name, or say that it may be replaced (--force)";
            Err(Fault::new(what, remedy))
        }
        Standing::Read(read) if read == path => {
            let what = "it is one of the files that were read, and those are never written over";
            Err(Fault::new(what, another))
        }
        Standing::Read(read) => {
            let read = read.display();
            let what =
                format!("it is the file {read}, which was read, and that is never written over");
            Err(Fault::new(what, another))
        }
        Standing::ReadFolder(folder) => {
            let folder = folder.display();
            let what = format!(
                "it lies in {folder}, which was read as a whole, and nothing in it is written over"
            );
            Err(Fault::new(what, another))
        }
        Standing::Folder => Err(Fault::new("it is a folder", "name a file in it")),
    }
}

/// Writes a file whole or not at all, where it may be written: see [`may_write`].
///
/// # Errors
/// Why it may not, or what the system says.
pub fn write(
    path: &Path,
    contents: &[u8],
    kind: Kind,
    inputs: &Inputs,
    force: bool,
) -> Result<(), Fault> {
    has_folder(path)?;
    may_write(path, kind, inputs, force)?;
    write_whole(path, contents).map_err(|error| cannot_be("written", &error))
}

/// Makes a folder, with those that it lies in.
///
/// # Errors
/// Where a file has its name, or what the system says.
pub fn make_folder(folder: &Path) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(|error| {
        let fault = match folder.exists() {
            true => Fault::new("it is no folder", "name a folder"),
            false => cannot_be("made", &error),
        };
        FileError::new(folder, fault)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::FLIGHT_MARK;

    const CSV: &str = "photo,width_px,height_px,top_px_per_cm,note\n";

    #[test]
    fn a_file_is_replaced_where_nothing_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let flight = format!("{FLIGHT_MARK}format = 1\n");
        for (name, text) in [
            ("read.csv", CSV),
            ("opened.csv", CSV),
            ("opened.txt", "x"),
            ("mine.txt", "x"),
            ("ours.csv", CSV),
            ("flight.toml", &flight),
            ("empty", ""),
            ("read empty", ""),
        ] {
            fs::write(at(name), text).unwrap();
        }
        let inputs = Inputs::of([at("read.csv"), at("read empty")])
            .with_opened(&[at("opened.csv"), at("opened.txt")]);
        let may = |name: &str, kind, force| may_write(&at(name), kind, &inputs, force).is_ok();
        for (name, kind, without, with) in [
            ("new", Kind::Result, true, true),
            ("empty", Kind::Result, true, true),
            ("ours.csv", Kind::Result, true, true),
            // A result of an earlier run that was only looked at.
            ("opened.csv", Kind::Result, true, true),
            ("ours.csv", Kind::Flight, false, true),
            ("flight.toml", Kind::Flight, true, true),
            ("flight.toml", Kind::Result, false, true),
            ("mine.txt", Kind::Result, false, true),
            ("opened.txt", Kind::Result, false, false),
            ("read.csv", Kind::Result, false, false),
            ("read empty", Kind::Result, false, false),
            ("", Kind::Result, false, false),
        ] {
            assert_eq!(may(name, kind, false), without, "{name} {kind:?}");
            assert_eq!(may(name, kind, true), with, "{name} {kind:?} --force");
        }
        for (name, why) in [
            ("no/such/a.csv", "there is no folder"),
            ("mine.txt/a.csv", "is no folder"),
        ] {
            let error = has_folder(&at(name)).unwrap_err();
            let folder = at(name).parent().unwrap().display().to_string();
            let error = error.to_string();
            assert!(error.contains(why) && error.contains(&folder), "{error}");
        }
        let error = write(&at("mine.txt"), b"y", Kind::Result, &inputs, false);
        assert!(error.unwrap_err().to_string().contains("--force"));
        assert_eq!(fs::read(at("mine.txt")).unwrap(), b"x");
        write(&at("mine.txt"), b"y", Kind::Result, &inputs, true).unwrap();
        assert_eq!(fs::read(at("mine.txt")).unwrap(), b"y");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_written_through() {
        let inputs = Inputs::of(["/dev/null"]);
        write(Path::new("/dev/null"), b"x", Kind::Result, &inputs, false).unwrap();
    }
}
