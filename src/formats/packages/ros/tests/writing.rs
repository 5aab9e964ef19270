//! Recordings written byte by byte from the specifications, to be read back.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};
use std::path::Path;

/// How a message is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Style {
    Ros1,
    Little,
    Big,
}

/// A message on its way out.
pub(super) struct Out {
    style: Style,
    bytes: Vec<u8>,
}

impl Out {
    pub(super) fn new(style: Style) -> Self {
        let bytes = match style {
            Style::Ros1 => vec![],
            Style::Little => vec![0, 1, 0, 0],
            Style::Big => vec![0, 0, 0, 0],
        };
        Self { style, bytes }
    }

    fn number<const N: usize>(mut self, mut little: [u8; N]) -> Self {
        if self.style != Style::Ros1 {
            while !(self.bytes.len() - 4).is_multiple_of(N) {
                self.bytes.push(0);
            }
        }
        if self.style == Style::Big {
            little.reverse();
        }
        self.bytes.extend(little);
        self
    }

    pub(super) fn byte(self, n: u8) -> Self {
        self.number([n])
    }

    pub(super) fn u16(self, n: u16) -> Self {
        self.number(n.to_le_bytes())
    }

    pub(super) fn u32(self, n: u32) -> Self {
        self.number(n.to_le_bytes())
    }

    pub(super) fn f64s(self, numbers: &[f64]) -> Self {
        numbers
            .iter()
            .fold(self, |out, n| out.number(n.to_le_bytes()))
    }

    pub(super) fn text(mut self, text: &str) -> Self {
        let end: &[u8] = if self.style == Style::Ros1 {
            b""
        } else {
            b"\0"
        };
        self = self.u32((text.len() + end.len()) as u32);
        self.bytes.extend(text.bytes());
        self.bytes.extend(end);
        self
    }

    pub(super) fn header(mut self, ms: u32, frame: &str) -> Self {
        if self.style == Style::Ros1 {
            self = self.u32(99);
        }
        self.u32(1_700_000_000 + ms / 1000)
            .u32(ms % 1000 * 1_000_000)
            .text(frame)
    }

    pub(super) fn done(self) -> Vec<u8> {
        self.bytes
    }
}

/// A message of a topic.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) topic: &'static str,
    /// As ROS 1 has it.
    pub(super) kind: &'static str,
    pub(super) data: Vec<u8>,
}

const RECORDED: i64 = 1_700_000_000_000_000_000;

fn field(name: &str, value: &[u8]) -> Vec<u8> {
    let mut out = ((name.len() + 1 + value.len()) as u32)
        .to_le_bytes()
        .to_vec();
    out.extend(name.bytes());
    out.push(b'=');
    out.extend(value);
    out
}

fn record(header: &[Vec<u8>], data: &[u8]) -> Vec<u8> {
    let header = header.concat();
    let mut out = (header.len() as u32).to_le_bytes().to_vec();
    out.extend(header);
    out.extend((data.len() as u32).to_le_bytes());
    out.extend(data);
    out
}

/// The topics in the order in which they come up.
fn topics(entries: &[Entry]) -> Vec<(&'static str, &'static str)> {
    let mut topics: Vec<(&str, &str)> = Vec::new();
    for entry in entries {
        if !topics.contains(&(entry.topic, entry.kind)) {
            topics.push((entry.topic, entry.kind));
        }
    }
    topics
}

/// A bag of version 2.0 with one chunk.
pub(super) fn bag(entries: &[Entry], compression: &str) -> Vec<u8> {
    let mut chunk = Vec::new();
    let topics = topics(entries);
    for (id, (topic, kind)) in topics.iter().enumerate() {
        let head = [
            field("op", &[7]),
            field("conn", &(id as u32).to_le_bytes()),
            field("topic", topic.as_bytes()),
        ];
        let data = [
            field("topic", topic.as_bytes()),
            field("type", kind.as_bytes()),
            field("md5sum", b"*"),
            field("message_definition", b""),
        ];
        chunk.extend(record(&head, &data.concat()));
    }
    for entry in entries {
        let id = topics
            .iter()
            .position(|t| *t == (entry.topic, entry.kind))
            .unwrap();
        let mut time = 1_700_000_000_u32.to_le_bytes().to_vec();
        time.extend([0; 4]);
        let head = [
            field("op", &[2]),
            field("conn", &(id as u32).to_le_bytes()),
            field("time", &time),
        ];
        chunk.extend(record(&head, &entry.data));
    }
    let packed = match compression {
        "none" => chunk.clone(),
        "bz2" => {
            let mut out = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            out.write_all(&chunk).unwrap();
            out.finish().unwrap()
        }
        _ => {
            let mut out = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
            out.write_all(&chunk).unwrap();
            out.finish().0
        }
    };
    let mut out = b"#ROSBAG V2.0\n".to_vec();
    let head = [
        field("op", &[3]),
        field("index_pos", &[0; 8]),
        field("conn_count", &[0; 4]),
        field("chunk_count", &[0; 4]),
    ];
    out.extend(record(&head, &[b' '; 40]));
    let head = [
        field("op", &[5]),
        field("compression", compression.as_bytes()),
        field("size", &(chunk.len() as u32).to_le_bytes()),
    ];
    out.extend(record(&head, &packed));
    // Index data: passed over.
    out.extend(record(
        &[field("op", &[4]), field("ver", &[1, 0, 0, 0])],
        &[7; 12],
    ));
    out
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
