//! Recordings of the Robot Operating System: ROS 1 bags, and ROS 2 recordings as a folder, as SQLite
//! or as MCAP.
//!
//! | | recognised by | read by |
//! |---|---|---|
//! | `.bag` | `#ROSBAG V` | `bag.rs` |
//! | `.mcap` | its magic | `mcap.rs` |
//! | `.db3` | SQLite's magic and this ending | `sqlite.rs` |
//! | a rosbag2 folder | `metadata.yaml` in it | its `.mcap` and `.db3` files, one after the other |
//!
//! The messages of all of them are read by `message_bytes.rs` and `messages.rs`, collected in
//! `recording.rs`, and made a flight in `flight.rs`, with poses from `pose_source.rs`. A recording
//! without images or CameraInfo is no flight; `info` prints its poses, and a flight.toml may name it
//! as `[photos] poses`.
//!
//! The world is whatever frame the poses are in (REP 103: metres, z up).
//! Not read: pixels (a photo's file must be exported, by the usual tools under its stamp), point
//! clouds, anything encoded otherwise than by ROS 1 or CDR, and recordings that are compressed as whole
//! files (`.db3.zstd`, `.mcap.zstd`).

mod bag;
mod compression;
mod flight;
mod frames;
mod mcap;
mod message_bytes;
mod messages;
mod parts;
mod pose_source;
mod recording;
#[cfg(feature = "ros")]
mod sqlite;

use std::fs;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

pub use recording::Recording;

use crate::fault::Fault;
use crate::files::{FileError, open_file, unreadable_folder};
use crate::jobs::Progress;
use crate::packages::reconstruction::Project;
use crate::poses::trajectory::Stamp;

/// A message as its recording has it.
struct RawMessage<'a> {
    topic: &'a str,
    /// As written: `geometry_msgs/PoseStamped` or `geometry_msgs/msg/PoseStamped`.
    type_name: &'a str,
    /// `ros1`, `cdr`, or one that is not read.
    encoding: &'a str,
    /// When it was recorded.
    time: Stamp,
    data: &'a [u8],
}

/// What every SQLite file begins with.
const SQLITE: &[u8] = b"SQLite format 3\0";

/// Refuses what this build has no library for.
#[cfg(not(feature = "ros"))]
fn left_out(what: &str) -> Fault {
    Fault::new(
        format!("this fragscale was built without {what}"),
        "build it with its default features, or with the feature ros",
    )
}

/// What rosbag2 puts into a recording's folder.
const METADATA: &str = "metadata.yaml";

/// Whether a file is a recording, by its first bytes and its name in lower case.
pub fn is_recording(start: &[u8], name: &str) -> bool {
    start.starts_with(bag::MAGIC)
        || start.starts_with(&mcap::MAGIC)
        || (start.starts_with(SQLITE) && name.ends_with(".db3"))
        || is_compressed(name)
}

/// Whether a name is that of a recording compressed as a whole.
fn is_compressed(name: &str) -> bool {
    name.ends_with(".db3.zstd") || name.ends_with(".mcap.zstd")
}

/// Whether a folder is a recording of ROS 2.
pub fn is_recording_folder(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = open_file(&path.join(METADATA)).map(|file| file.take(4096).read_to_end(&mut start));
    matches!(read, Ok(Ok(_)))
        && String::from_utf8_lossy(&start).contains("rosbag2_bagfile_information")
}

/// Reads a recording, or a folder of one.
///
/// # Errors
/// With the file that is damaged, or of the whole where it holds no message.
pub fn read(path: &Path, progress: &Progress) -> Result<Recording, FileError> {
    let files = if path.is_dir() {
        files_of(path)?
    } else {
        vec![path.to_owned()]
    };
    let mut recording = Recording::default();
    for file in &files {
        let warnings = read_file(file, &mut recording, progress)
            .map_err(|fault| FileError::new(file, fault))?;
        let several = files.len() > 1;
        recording
            .file_warnings
            .extend(warnings.into_iter().map(|warning| {
                let name = file.file_name().unwrap_or_default().to_string_lossy();
                if several {
                    format!("{name}: {warning}")
                } else {
                    warning
                }
            }));
    }
    if recording.messages() == 0 {
        let warnings = recording.file_warnings.join("; ");
        let what = if warnings.is_empty() {
            "it holds no message".to_owned()
        } else {
            format!("it holds no message: {warnings}")
        };
        return Err(FileError::new(
            path,
            Fault::new(what, "give another recording"),
        ));
    }
    Ok(recording)
}

/// Reads a recording as a flight, with the poses of a topic.
///
/// # Errors
/// As [`read`], and where it is no flight with these poses.
pub fn read_with_topic(
    path: &Path,
    topic: &str,
    progress: &Progress,
) -> Result<Project, FileError> {
    let recording = read(path, progress)?;
    let reconstruction = recording.reconstruction_by(Some(topic));
    reconstruction
        .map(Project::from)
        .map_err(|fault| FileError::new(path, fault))
}

/// The files of a recording of ROS 2, in the order of their names, in which rosbag2 numbers them.
fn files_of(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let fault = |what: String, remedy: &str| FileError::new(folder, Fault::new(what, remedy));
    let entries = fs::read_dir(folder);
    let entries = entries.map_err(|e| FileError::new(folder, unreadable_folder(&e)))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| {
        let name = lower_name(file);
        name.ends_with(".db3") || name.ends_with(".mcap") || is_compressed(&name)
    });
    if files.is_empty() {
        return Err(fault(
            format!("a recording of ROS 2 whose {METADATA} is all that is there"),
            "copy its .db3 or .mcap files as well",
        ));
    }
    // NAME_2 stands in front of NAME_10.
    files.sort_by_cached_key(|file| {
        let name = lower_name(file);
        (name.len(), name)
    });
    Ok(files)
}

fn lower_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().to_ascii_lowercase()
}

fn read_file(
    path: &Path,
    recording: &mut Recording,
    progress: &Progress,
) -> Result<Vec<String>, Fault> {
    if is_compressed(&lower_name(path)) {
        return Err(Fault::new(
            "a recording that is compressed as a whole",
            "expand it first, with zstd -d",
        ));
    }
    let file = open_file(path).map_err(|error| error.fault)?;
    let size = file.metadata().map_or(0, |metadata| metadata.len());
    let mut input = BufReader::with_capacity(1 << 18, file);
    let mut start = Vec::new();
    let unreadable =
        |e: std::io::Error| Fault::new(format!("it cannot be read ({e})"), "check the disk");
    input
        .by_ref()
        .take(16)
        .read_to_end(&mut start)
        .map_err(unreadable)?;
    let mut seen = 0;
    let mut take = |message: RawMessage<'_>| {
        seen += message.data.len() as u64;
        recording.take(&message);
        progress.advance(seen, size)
    };
    if start.starts_with(SQLITE) {
        #[cfg(feature = "ros")]
        return sqlite::read(path, &mut take);
        #[cfg(not(feature = "ros"))]
        return Err(left_out("SQLite"));
    }
    let input = start.as_slice().chain(input);
    if start.starts_with(bag::MAGIC) {
        bag::read(input, &mut take)
    } else if start.starts_with(&mcap::MAGIC) {
        mcap::read(input, &mut take)
    } else {
        Err(Fault::new(
            "it is no recording of ROS",
            "copy it again, or convert it to MCAP",
        ))
    }
}

#[cfg(test)]
#[cfg(feature = "ros")]
mod tests;
