//! MCAP, the container of newer ROS 2 recordings.
//!
//! Written from the MCAP specification (mcap.dev/spec) and its registry of ROS profiles:
//!
//! ```text
//! 89 'MCAP0\r\n'
//! record ...       u8 op, u64 length, content; numbers little endian, texts with a u32 length
//! ```
//!
//! | op | record | content, as far as used |
//! |---|---|---|
//! | 3 | schema | u16 id, text name, text encoding |
//! | 4 | channel | u16 id, u16 schema, text topic, text message encoding |
//! | 5 | message | u16 channel, u32 sequence, u64 log time, u64 publish time, data |
//! | 6 | chunk | u64 start, u64 end, u64 size, u32 CRC, text compression ("", lz4, zstd), u64 length, records |
//! | 15 | data end | behind it only summaries follow |
//!
//! Message encodings: `cdr` (ROS 2) and `ros1`. Others (json, protobuf, ...) are refused in `recording.rs`.
//! A file that was cut off is read as far as it goes. The crate `mcap` is not used for reading: its
//! count of a chunk's remaining bytes overflows on a damaged file; the tests write with it.

use std::collections::HashMap;
use std::io::Read;

use super::RawMessage;
use super::compression::{expanded, expanded_message};
use super::parts::{Cut, Parts, read_array, read_bytes, skip_bytes};
use crate::fault::Fault;
use crate::poses::trajectory::Stamp;

/// What every file begins with.
pub(super) const MAGIC: [u8; 8] = [0x89, b'M', b'C', b'A', b'P', b'0', b'\r', b'\n'];

const DAMAGED: &str = "copy the recording again, or mend it with mcap recover";

/// Names and encodings so far.
#[derive(Default)]
struct Directory {
    schemas: HashMap<u16, String>,
    channels: HashMap<u16, Channel>,
}

struct Channel {
    topic: String,
    type_name: String,
    encoding: String,
}

/// Hands every message to `take`.
///
/// # Errors
/// Where it is no MCAP or damaged. A file that merely ends too early is said in the returned warnings.
pub(super) fn read(
    mut input: impl Read,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<Vec<String>, Fault> {
    if read_array(&mut input)? != Ok(MAGIC) {
        return Err(Fault::new("it does not begin as MCAP", DAMAGED));
    }
    let mut directory = Directory::default();
    let cut_off = || {
        vec![
            "it ends without its end mark: the recording was cut off; what stands before is read"
                .to_owned(),
        ]
    };
    loop {
        let [op] = match read_array(&mut input)? {
            Ok(op) => op,
            Err(Cut::End | Cut::Inside) => return Ok(cut_off()),
        };
        let Ok(length) = read_array(&mut input)? else {
            return Ok(cut_off());
        };
        let length = u64::from_le_bytes(length);
        match op {
            15 => return Ok(Vec::new()),
            3..=6 => {
                let Ok(data) = read_bytes(&mut input, length)? else {
                    return Ok(cut_off());
                };
                if op == 6 {
                    chunk(&data, &mut directory, take)?;
                } else {
                    directory.record(op, &data, take)?;
                }
            }
            _ => {
                if skip_bytes(&mut input, length)?.is_err() {
                    return Ok(cut_off());
                }
            }
        }
    }
}

fn broken() -> Fault {
    Fault::new("a record is shorter than what it holds", DAMAGED)
}

fn chunk(
    data: &[u8],
    directory: &mut Directory,
    take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let mut parts = Parts::new(data);
    let head = |parts: &mut Parts<'_>| {
        parts.u64()?;
        parts.u64()?;
        let size = parts.u64()?;
        parts.u32()?;
        Some(size)
    };
    let size = head(&mut parts).ok_or_else(broken)?;
    let compression = parts.text().ok_or_else(broken)?;
    let length = parts.u64().ok_or_else(broken)?;
    let records = parts.bytes(length).ok_or_else(broken)?;
    let records = expanded(compression, records, size)?;
    let mut parts = Parts::new(&records);
    while !parts.is_empty() {
        let op = parts.u8().ok_or_else(broken)?;
        let length = parts.u64().ok_or_else(broken)?;
        directory.record(op, parts.bytes(length).ok_or_else(broken)?, take)?;
    }
    Ok(())
}

impl Directory {
    fn record(
        &mut self,
        op: u8,
        data: &[u8],
        take: &mut dyn FnMut(RawMessage<'_>) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut parts = Parts::new(data);
        match op {
            3 => self.schema(&mut parts).ok_or_else(broken),
            4 => self.channel(&mut parts).ok_or_else(broken),
            5 => {
                let (id, time) = message_head(&mut parts).ok_or_else(broken)?;
                let channel = self.channels.get(&id).ok_or_else(|| {
                    Fault::new(
                        format!("a message of the channel {id}, which is not there"),
                        DAMAGED,
                    )
                })?;
                let damaged = |error| {
                    Fault::new(
                        format!(
                            "a message of {} cannot be expanded ({error})",
                            channel.topic
                        ),
                        DAMAGED,
                    )
                };
                take(RawMessage {
                    topic: &channel.topic,
                    type_name: &channel.type_name,
                    encoding: &channel.encoding,
                    time,
                    data: &expanded_message(parts.rest()).map_err(damaged)?,
                })
            }
            _ => Ok(()),
        }
    }

    fn schema(&mut self, parts: &mut Parts<'_>) -> Option<()> {
        let id = parts.u16()?;
        self.schemas.insert(id, parts.text()?.to_owned());
        Some(())
    }

    fn channel(&mut self, parts: &mut Parts<'_>) -> Option<()> {
        let (id, schema) = (parts.u16()?, parts.u16()?);
        let (topic, encoding) = (parts.text()?, parts.text()?);
        let channel = Channel {
            topic: topic.to_owned(),
            type_name: self.schemas.get(&schema).cloned().unwrap_or_default(),
            encoding: encoding.to_owned(),
        };
        self.channels.insert(id, channel);
        Some(())
    }
}

/// The channel and the log time of a message.
fn message_head(parts: &mut Parts<'_>) -> Option<(u16, Stamp)> {
    let channel = parts.u16()?;
    parts.u32()?;
    let time = i64::try_from(parts.u64()?).ok()?;
    parts.u64()?;
    Some((channel, Stamp(time)))
}
