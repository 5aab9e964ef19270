//! Unpacking what a node sends, and trusting nothing of it.
//!
//! Only the files that were asked for are taken, under their own names, each made anew; a node that packs more is
//! not unpacked further. An archive with any name that leads out of its folder is refused as a whole, and so is one
//! that would unpack to more than it can sensibly hold: [`MOST_TIMES`] times its own size and [`AT_LEAST`] bytes.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use zip::ZipArchive;
use zip::result::ZipError;

use crate::client::unwritten;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::limits::Limits;
use crate::outputs::is_asked_for;
use crate::trouble::Trouble;

/// An archive's contents may be so many times as large as it is. Texts of numbers come to 10.
const MOST_TIMES: u64 = 100;
/// So many bytes any archive may hold.
const AT_LEAST: u64 = 64 << 20;

/// Unpacks what lies at these places of an archive into a folder that is made. Returns how many files came out.
///
/// # Errors
/// Where it is cut off or no archive, holds what it must not, or cannot be written. The folder may be half full then.
pub(crate) fn unzip(
    archive: &Path,
    to: &Path,
    outputs: &[&str],
    limits: &Limits,
    progress: &Progress,
) -> Result<usize, Trouble> {
    let here = |error: io::Error| Trouble::Here(unwritten(to, &error));
    progress.stage("unpacking the results");
    let file = File::open(archive).map_err(|error| Trouble::Here(unwritten(archive, &error)))?;
    let size = file.metadata().map_err(here)?.len();
    let mut archive = ZipArchive::new(io::BufReader::new(file)).map_err(|error| broken(&error))?;
    let most = (size.saturating_mul(MOST_TIMES))
        .max(AT_LEAST)
        .min(limits.unpacked);
    let names: Result<Vec<String>, ZipError> =
        (archive.file_names().map(|name| Ok(name?.into_owned()))).collect();
    let names = names.map_err(|error| broken(&error))?;
    if let Some(name) = names.iter().find(|name| leads_out(name)) {
        let what = format!(
            "its results hold a file that would be written outside of their folder (\"{name}\")"
        );
        return Err(distrusted(what));
    }
    fs::create_dir_all(to).map_err(here)?;
    let mut wanted: Vec<&String> = (names.iter())
        .filter(|name| is_asked_for(name, outputs))
        .collect();
    // Archives are in no order.
    wanted.sort_unstable();
    let mut unpacked = 0;
    for (done, name) in wanted.iter().enumerate() {
        if progress.advance(done as u64, wanted.len() as u64).is_err() {
            return Err(Trouble::Cancelled);
        }
        let mut entry = archive.by_name(name).map_err(|error| broken(&error))?;
        if !entry.is_file() || entry.is_symlink() {
            return Err(distrusted(format!(
                "its results hold {name} as something that is no file"
            )));
        }
        let path = to.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(here)?;
        }
        let mut file =
            File::create_new(&path).map_err(|error| Trouble::Here(unwritten(&path, &error)))?;
        unpacked = copy(&mut entry, (&mut file, &path), unpacked, most, progress)?;
    }
    Ok(wanted.len())
}

/// Copies an entry; `before` bytes have come out of the archive, and `most` may.
fn copy(
    entry: &mut impl Read,
    (to, path): (&mut File, &Path),
    before: u64,
    most: u64,
    progress: &Progress,
) -> Result<u64, Trouble> {
    let mut unpacked = before;
    let mut buffer = vec![0; 1 << 16];
    loop {
        let now = entry
            .read(&mut buffer)
            .map_err(|error| broken(&ZipError::Io(error)))?;
        if now == 0 {
            let written = to.sync_all();
            return written
                .map(|()| unpacked)
                .map_err(|error| Trouble::Here(unwritten(path, &error)));
        }
        unpacked += now as u64;
        if unpacked > most {
            return Err(distrusted(format!(
                "its results would unpack to more than {} MB, which no archive of their size does ({MOST_TIMES} times its own size is allowed, and {} MB in any case)",
                most >> 20,
                AT_LEAST >> 20
            )));
        }
        if progress.is_cancelled() {
            return Err(Trouble::Cancelled);
        }
        let piece = buffer.get(..now).unwrap_or_default();
        to.write_all(piece)
            .map_err(|error| Trouble::Here(unwritten(path, &error)))?;
    }
}

/// What no honest node sends.
fn distrusted(what: String) -> Trouble {
    Trouble::Worthless(Fault::new(what, "do not trust this node"))
}

/// Whether a name is not one below a folder, on any system.
fn leads_out(name: &str) -> bool {
    let is_bad = |c: char| c == '\\' || c == ':' || c.is_control();
    name.starts_with('/') || name.contains(is_bad) || name.split('/').any(|part| part == "..")
}

fn broken(error: &ZipError) -> Trouble {
    let what = format!("its results are cut off or no zip archive ({error})");
    Trouble::Final(Fault::new(
        what,
        "start it once more: they are fetched again",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outputs::outputs;
    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = ZipWriter::new(io::Cursor::new(Vec::new()));
        for (name, bytes) in files {
            writer
                .start_file(*name, SimpleFileOptions::default())
                .unwrap();
            writer.write_all(bytes).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    fn unzipped(bytes: &[u8]) -> (tempfile::TempDir, Result<usize, String>) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("all.zip");
        fs::write(&path, bytes).unwrap();
        let done = unzip(
            &path,
            &folder.path().join("in/odm"),
            &outputs("[]"),
            &Limits::default(),
            &Progress::default(),
        );
        let done = done.map_err(|trouble| match trouble {
            Trouble::Final(fault) | Trouble::Worthless(fault) => fault.what,
            other => format!("{other:?}"),
        });
        (folder, done)
    }

    /// The result of NodeODM's test mode: 96 entries, of which six were asked for.
    #[test]
    fn what_was_asked_for_is_taken() {
        let Some(path) = fragscale_test_data::shared_data("nodeodm/test_mode_default_all.zip")
        else {
            return;
        };
        let (folder, done) = unzipped(&fs::read(path).unwrap());
        assert_eq!(done, Ok(6));
        let odm = folder.path().join("in/odm");
        assert_eq!(
            fs::metadata(odm.join("odm_georeferencing/odm_georeferenced_model.laz"))
                .unwrap()
                .len(),
            594
        );
        assert_eq!(
            fs::metadata(odm.join("odm_report/shots.geojson"))
                .unwrap()
                .len(),
            5573
        );
        assert!(!odm.join("odm_orthophoto").exists() && !odm.join("task_output.txt").exists());
    }

    #[test]
    fn nothing_is_written_outside() {
        for name in [
            "../evil.txt",
            "/evil.txt",
            "opensfm/../../evil.txt",
            "..\\evil.txt",
            "C:evil.txt",
            "a/..",
            "a\nb",
        ] {
            let (folder, done) = unzipped(&archive(&[("images.json", b"[]"), (name, b"evil")]));
            let error = done.unwrap_err();
            assert!(error.contains("outside of their folder"), "{name}: {error}");
            // Not even what came before it.
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        }
        for name in ["a/b.txt", "a..b", "..a/b", "a/...", "ä b.txt"] {
            assert!(!leads_out(name), "{name}");
        }
    }

    /// A link in place of a file that was asked for, behind which the next would be written.
    #[test]
    fn a_link_is_no_file() {
        let mut writer = ZipWriter::new(io::Cursor::new(Vec::new()));
        writer
            .add_symlink("images.json", "/etc/passwd", SimpleFileOptions::default())
            .unwrap();
        let (_folder, done) = unzipped(&writer.finish().unwrap().into_inner());
        assert!(done.unwrap_err().contains("no file"));
    }

    #[test]
    fn a_bomb_is_refused() {
        let zeros = vec![0; (AT_LEAST + 1) as usize];
        let bomb = archive(&[("opensfm/reconstruction.json", &zeros)]);
        assert!(bomb.len() < 200_000);
        let (_folder, done) = unzipped(&bomb);
        let error = done.unwrap_err();
        assert!(error.contains("unpack to more than 64 MB"), "{error}");
        // The most that is allowed.
        let (_folder, done) = unzipped(&archive(&[("opensfm/reconstruction.json", &zeros[1..])]));
        assert_eq!(done, Ok(1));
    }

    #[test]
    fn what_is_cut_off_is_refused() {
        let whole = archive(&[
            ("images.json", b"[{\"filename\": \"a.jpg\"}]"),
            ("cameras.json", b"{}"),
        ]);
        for length in 0..whole.len() {
            let (_folder, done) = unzipped(&whole[..length]);
            assert!(done.unwrap_err().contains("cut off or no zip"), "{length}");
        }
        // A byte of a file that is another one.
        let stored =
            SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
        let mut writer = ZipWriter::new(io::Cursor::new(Vec::new()));
        writer.start_file("images.json", stored).unwrap();
        writer.write_all(b"[{\"filename\"").unwrap();
        let mut other = writer.finish().unwrap().into_inner();
        assert_eq!(unzipped(&other).1, Ok(1));
        let at = other
            .windows(4)
            .position(|bytes| bytes == b"[{\"f")
            .unwrap();
        other[at] ^= 1;
        assert!(unzipped(&other).1.is_err());
        assert!(unzipped(b"<html>").1.is_err());
    }
}
