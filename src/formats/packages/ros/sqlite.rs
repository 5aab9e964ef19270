//! rosbag2's SQLite files, `.db3`.
//!
//! Written from rosbag2_storage_sqlite3 (`sqlite_storage.cpp`, README) at the schemas of ROS 2 Crystal
//! to Jazzy, which all have
//!
//! ```text
//! topics    id, name, type, serialization_format, ...
//! messages  id, topic_id, timestamp (ns), data, ...
//! ```
//!
//! and differ in what stands behind. With `compression_mode: MESSAGE` each `data` is a zstd frame of
//! its own. The file is opened read-only and as one that nobody changes, so that it may lie where
//! nothing can be written; what a recorder that was cut off left in `FILE-wal` is not read, and that
//! is said.

use std::fmt::Write;
use std::path::Path;

use rusqlite::{Connection, OpenFlags, Row};

use super::RawMessage;
use super::compression::expanded_message;
use crate::fault::Fault;
use crate::poses::trajectory::Stamp;

const MESSAGES: &str = "SELECT topics.name, topics.type, topics.serialization_format, \
    messages.timestamp, messages.data FROM messages JOIN topics ON messages.topic_id = topics.id \
    ORDER BY messages.id";

/// Hands every message to `take`.
///
/// # Errors
/// Where it is no such file, or damaged.
pub(super) fn read(
    path: &Path,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<Vec<String>, Fault> {
    let damaged = |error: rusqlite::Error| {
        Fault::new(
            format!("SQLite cannot read it as a rosbag2 recording ({error})"),
            "copy the recording again, or mend it with ros2 bag reindex",
        )
    };
    let uri = uri_of(path)?;
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY
        | OpenFlags::SQLITE_OPEN_URI
        | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    crate::files::note_opened(path);
    let file = Connection::open_with_flags(uri, flags).map_err(damaged)?;
    let mut query = file.prepare(MESSAGES).map_err(damaged)?;
    let mut rows = query.query([]).map_err(damaged)?;
    while let Some(row) = rows.next().map_err(damaged)? {
        message(row, take)?;
    }
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    let left = std::fs::metadata(&log).map_or(0, |metadata| metadata.len());
    if left == 0 {
        return Ok(Vec::new());
    }
    Ok(vec![format!(
        "the messages in {} are not read: the recording was cut off; ros2 bag reindex takes them in",
        Path::new(&log).display()
    )])
}

fn message(
    row: &Row<'_>,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let wrong = |error: &dyn std::fmt::Display| {
        Fault::new(
            format!("a message is not as rosbag2 writes it ({error})"),
            "copy the recording again",
        )
    };
    let text = |column| -> Result<&str, Fault> {
        let value = row.get_ref(column).map_err(|error| wrong(&error))?;
        value.as_str().map_err(|error| wrong(&error))
    };
    let time: i64 = row.get(3).map_err(|error| wrong(&error))?;
    let data = row.get_ref(4).map_err(|error| wrong(&error))?;
    let data = data.as_blob().map_err(|error| wrong(&error))?;
    take(RawMessage {
        topic: text(0)?,
        type_name: text(1)?,
        encoding: text(2)?,
        time: Stamp(time),
        data: &expanded_message(data).map_err(|error| wrong(&error))?,
    })
}

/// The file as SQLite's URI, in which `?`, `#` and `%` have meanings.
fn uri_of(path: &Path) -> Result<String, Fault> {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = absolute
        .to_str()
        .ok_or_else(|| Fault::new("its path is not Unicode", "rename its file or folder"))?;
    let mut uri = "file:".to_owned();
    // C:\a is /C:/a in a URI.
    let name = if cfg!(windows) {
        format!("/{}", name.replace('\\', "/"))
    } else {
        name.to_owned()
    };
    for byte in name.bytes() {
        if byte.is_ascii_alphanumeric() || b"/._-:".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            // Writing into a String does not fail.
            let _ = write!(uri, "%{byte:02x}");
        }
    }
    uri.push_str("?immutable=1");
    Ok(uri)
}
