//! Recordings in every container, to be read back.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use std::path::Path;

use fragscale_test_data::ros::{Entry, packed_bag, topics};

const RECORDED: i64 = 1_700_000_000_000_000_000;

/// A bag of version 2.0 with one chunk.
pub(super) fn bag(entries: &[Entry], compression: &str) -> Vec<u8> {
    packed_bag(entries, compression, |chunk| match compression {
        "none" => chunk.to_vec(),
        "bz2" => {
            let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            out.write_all(chunk).unwrap();
            out.finish().unwrap()
        }
        _ => {
            let mut out = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
            out.write_all(chunk).unwrap();
            out.finish().0
        }
    })
}

/// The type as ROS 2 has it.
fn ros2(kind: &str) -> String {
    kind.replace('/', "/msg/")
}

/// Written by the crate `mcap`.
pub(super) fn mcap(entries: &[Entry], encoding: &str, options: mcap::WriteOptions) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut out = options.create(&mut file).unwrap();
    for (sequence, entry) in entries.iter().enumerate() {
        let kind = if encoding == "ros1" {
            entry.kind.to_owned()
        } else {
            ros2(entry.kind)
        };
        let schema = out.add_schema(&kind, "ros2msg", b"").unwrap();
        let channel = out
            .add_channel(schema, entry.topic, encoding, &BTreeMap::new())
            .unwrap();
        let header = mcap::records::MessageHeader {
            channel_id: channel,
            sequence: sequence as u32,
            log_time: RECORDED.unsigned_abs(),
            publish_time: RECORDED.unsigned_abs(),
        };
        out.write_to_known_channel(&header, &entry.data).unwrap();
    }
    out.finish().unwrap();
    drop(out);
    file.into_inner()
}

/// With the tables that all versions of rosbag2 have.
pub(super) fn db3(path: &Path, entries: &[Entry], encoding: &str) {
    let file = rusqlite::Connection::open(path).unwrap();
    file.execute_batch(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL);
        CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL);
        BEGIN;",
    )
    .unwrap();
    let topics = topics(entries);
    for (id, (topic, kind)) in topics.iter().enumerate() {
        let row = (id as u32, topic, ros2(kind), encoding);
        file.execute("INSERT INTO topics VALUES (?1, ?2, ?3, ?4)", row)
            .unwrap();
    }
    for entry in entries {
        let id = topics
            .iter()
            .position(|t| *t == (entry.topic, entry.kind))
            .unwrap();
        let row = (id as u32, RECORDED, &entry.data);
        file.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES (?1, ?2, ?3)",
            row,
        )
        .unwrap();
    }
    file.execute_batch("COMMIT").unwrap();
}
