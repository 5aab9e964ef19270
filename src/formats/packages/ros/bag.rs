//! ROS 1's bags, version 2.0.
//!
//! Written from the ROS wiki ("Bags/Format/2.0"):
//!
//! ```text
//! #ROSBAG V2.0\n
//! record ...       u32 header length, header, u32 data length, data
//! header           u32 field length, name=value ...; the value is bytes, numbers little endian
//! ```
//!
//! | op | record | used |
//! |---|---|---|
//! | 2 | message: conn, time | in chunks, or outside |
//! | 3 | bag header | for its `encryptor` |
//! | 4, 6 | index data, chunk info | not |
//! | 5 | chunk: compression (none, bz2, lz4), size | its data are records again |
//! | 7 | connection: conn, topic; data: type ... | |
//!
//! The file is read from its beginning to its end and its index is not needed: a bag that was cut off
//! (`.bag.active`) is read as far as it goes, with a warning. No length is believed: memory is taken
//! for what the file really holds. The crate `rosbag` is not used for reading, because it panics on an
//! index beyond the end and allocates what a chunk claims (it stands beside this reader in the tests).

use std::collections::HashMap;
use std::io::Read;

use super::RawMessage;
use super::compression::expanded;
use super::message_bytes::ROS1;
use super::parts::{Cut, Parts, read_array, read_bytes, skip_bytes};
use crate::fault::Fault;
use crate::poses::trajectory::Stamp;

/// What every bag begins with.
pub(super) const MAGIC: &[u8] = b"#ROSBAG V";

const DAMAGED: &str = "copy the recording again, or mend it with rosbag reindex";

/// Topic and type of each connection.
type Connections = HashMap<u32, (String, String)>;

/// Hands every message to `take`.
///
/// # Errors
/// Where it is no bag of version 2.0, encrypted or damaged. A file that merely ends too early is said
/// in the returned warnings.
pub(super) fn read(
    mut input: impl Read,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<Vec<String>, Fault> {
    let mut version = [0; 13];
    if input.read_exact(&mut version).is_err() || &version != b"#ROSBAG V2.0\n" {
        let first = String::from_utf8_lossy(&version);
        return Err(Fault::new(
            format!("a bag of another version ('{}')", first.trim_end()),
            "bring it to version 2.0 with rosbag fix",
        ));
    }
    let mut connections = Connections::new();
    loop {
        let header = match next_part(&mut input)? {
            Ok(header) => header,
            Err(Cut::End) => return Ok(Vec::new()),
            Err(Cut::Inside) => return Ok(vec![cut_off()]),
        };
        let header = Fields::parse(&header)?;
        let op = header.op()?;
        if !matches!(op, 2 | 5 | 7) {
            if op == 3 && header.get("encryptor").is_some_and(|name| !name.is_empty()) {
                return Err(Fault::new(
                    "it is encrypted",
                    "decrypt it with rosbag decrypt",
                ));
            }
            let Ok(()) = skip_part(&mut input)? else {
                return Ok(vec![cut_off()]);
            };
            continue;
        }
        let Ok(data) = next_part(&mut input)? else {
            return Ok(vec![cut_off()]);
        };
        if op == 5 {
            let compression = String::from_utf8_lossy(header.needed("compression")?);
            let data = expanded(&compression, &data, header.u32("size")?.into())?;
            let mut records = Parts::new(&data);
            while !records.is_empty() {
                let header = Fields::parse(part(&mut records)?)?;
                record(&header, part(&mut records)?, &mut connections, take)?;
            }
        } else {
            record(&header, &data, &mut connections, take)?;
        }
    }
}

fn cut_off() -> String {
    "it ends in the middle of a record: the recording was cut off; what stands before is read"
        .to_owned()
}

/// A connection or a message; others are passed over.
fn record(
    header: &Fields<'_>,
    data: &[u8],
    connections: &mut Connections,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    match header.op()? {
        7 => {
            let more = Fields::parse(data)?;
            let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
            let connection = (text(header.needed("topic")?), text(more.needed("type")?));
            connections.insert(header.u32("conn")?, connection);
            Ok(())
        }
        2 => {
            let id = header.u32("conn")?;
            let (topic, type_name) = connections.get(&id).ok_or_else(|| {
                Fault::new(
                    format!("a message of the connection {id}, which is not there"),
                    DAMAGED,
                )
            })?;
            let time: [u8; 8] = header.number("time")?;
            let [a, b, c, d, e, f, g, h] = time;
            let (seconds, rest) = (
                u32::from_le_bytes([a, b, c, d]),
                u32::from_le_bytes([e, f, g, h]),
            );
            take(RawMessage {
                topic,
                type_name,
                encoding: ROS1,
                time: Stamp(i64::from(seconds) * 1_000_000_000 + i64::from(rest)),
                data,
            })
        }
        _ => Ok(()),
    }
}

/// Bytes with their length in front.
fn part<'a>(parts: &mut Parts<'a>) -> Result<&'a [u8], Fault> {
    let found = parts.u32().and_then(|length| parts.bytes(length.into()));
    found.ok_or_else(|| Fault::new("a record reaches beyond its chunk or header", DAMAGED))
}

/// The same from the file.
fn next_part(input: &mut impl Read) -> Result<Result<Vec<u8>, Cut>, Fault> {
    match read_array(input)? {
        Ok(length) => read_bytes(input, u32::from_le_bytes(length).into()),
        Err(cut) => Ok(Err(cut)),
    }
}

fn skip_part(input: &mut impl Read) -> Result<Result<(), Cut>, Fault> {
    match read_array(input)? {
        Ok(length) => skip_bytes(input, u32::from_le_bytes(length).into()),
        Err(cut) => Ok(Err(cut)),
    }
}

/// The fields of a record's header.
struct Fields<'a>(Vec<(&'a [u8], &'a [u8])>);

impl<'a> Fields<'a> {
    fn parse(header: &'a [u8]) -> Result<Self, Fault> {
        let mut parts = Parts::new(header);
        let mut fields = Vec::new();
        while !parts.is_empty() {
            let field = part(&mut parts)?;
            let equals = field.iter().position(|&b| b == b'=');
            let pair = equals.and_then(|at| Some((field.get(..at)?, field.get(at + 1..)?)));
            fields.push(
                pair.ok_or_else(|| Fault::new("a record's header is not name=value", DAMAGED))?,
            );
        }
        Ok(Self(fields))
    }

    fn get(&self, name: &str) -> Option<&'a [u8]> {
        let found = self.0.iter().find(|(key, _)| *key == name.as_bytes());
        found.map(|(_, value)| *value)
    }

    fn needed(&self, name: &str) -> Result<&'a [u8], Fault> {
        self.get(name)
            .ok_or_else(|| Fault::new(format!("a record has no {name}"), DAMAGED))
    }

    fn number<const N: usize>(&self, name: &str) -> Result<[u8; N], Fault> {
        self.needed(name)?
            .try_into()
            .map_err(|_| Fault::new(format!("a record's {name} is not {N} bytes long"), DAMAGED))
    }

    fn u32(&self, name: &str) -> Result<u32, Fault> {
        self.number(name).map(u32::from_le_bytes)
    }

    fn op(&self) -> Result<u8, Fault> {
        self.number("op").map(|[op]| op)
    }
}
