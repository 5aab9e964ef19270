//! What a LAS or LAZ header claims, held against what the file has room for, before anything is
//! allocated for it.
//!
//! Uncompressed records have a fixed length, so their number follows from the file's. In LAZ the
//! chunk table says how long each chunk is; its own length, its chunks' and their numbers of points
//! are looked at here, because the decompressor believes them.

use std::io::{Read, Seek, SeekFrom};

use las::raw;
use laz::LazVlr;
use laz::laszip::ChunkTable;

use crate::fault::Fault;

/// The largest chunk that is decompressed, in bytes of records: writers use 50 000 points.
const LARGEST_CHUNK: u64 = 1 << 30;

const REMEDY: &str = "copy or export it again";

/// How many variable length records a header states, and how many there are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::clouds) struct RecordCount {
    pub(super) stated: u32,
    pub(in crate::clouds) found: u32,
}

impl RecordCount {
    /// What is to be said where there are others than the header states.
    pub(in crate::clouds) fn warning(self) -> Option<String> {
        let Self { stated, found } = self;
        (found != stated).then(|| {
            format!(
                "its header states {stated} variable length records, and there are {found} in front of its points: these are read"
            )
        })
    }
}

/// Checks the claims; leaves the input at its start.
///
/// # Errors
/// Where the file cannot hold what its header says. The number of variable length records alone is
/// none: what lies between header and points tells it, and other programs read such files.
pub(in crate::clouds) fn check(input: &mut (impl Read + Seek)) -> Result<RecordCount, Fault> {
    let unreadable = |e: &dyn std::fmt::Display| {
        Fault::new(format!("it cannot be read as LAS or LAZ ({e})"), REMEDY)
    };
    let length = input.seek(SeekFrom::End(0)).map_err(|e| unreadable(&e))?;
    input.rewind().map_err(|e| unreadable(&e))?;
    let header = raw::Header::read_from(&mut *input).map_err(|e| unreadable(&e))?;
    let records = match &header.large_file {
        Some(large) if header.number_of_point_records == 0 => large.number_of_point_records,
        Some(large) => large
            .number_of_point_records
            .max(header.number_of_point_records.into()),
        None => header.number_of_point_records.into(),
    };
    if let Some(extended) = &header.evlr {
        check_extended(input, extended.start_of_first_evlr, length)?;
    }
    let record = u64::from(header.point_data_record_length);
    let begin = u64::from(header.offset_to_point_data);
    if record == 0 || begin > length {
        return Err(Fault::new(
            "its header places the points beyond its end",
            REMEDY,
        ));
    }
    let count = count_records(input, &header).map_err(|e| unreadable(&e))?;
    // The two highest bits of the point format mark compression.
    if header.point_data_record_format & 0xc0 == 0 {
        let room = (length - begin) / record;
        if records > room {
            return Err(Fault::new(
                format!("its header promises {records} points, but there is room for {room}"),
                REMEDY,
            ));
        }
    } else {
        // Also without a point: the decompressor reads the table all the same.
        check_chunks(input, &header, count.found, record, length)?;
    }
    input.rewind().map_err(|e| unreadable(&e))?;
    Ok(count)
}

/// Who writes the records that matter here: the coordinate system, the compression.
const KNOWN_USERS: [&[u8]; 3] = [b"LASF_Projection", b"LASF_Spec", b"laszip encoded"];

/// Walks the variable length records between the header and the points. Too high a number ends where
/// no whole record fits; behind too low a one only records of known users count, because there may
/// be anything.
fn count_records(
    input: &mut (impl Read + Seek),
    header: &raw::Header,
) -> std::io::Result<RecordCount> {
    let stated = header.number_of_variable_length_records;
    let end = u64::from(header.offset_to_point_data);
    let mut at = u64::from(header.header_size);
    let mut found = 0;
    // Two bytes, a user of 16, a number of two, the length of two, 32 bytes in words.
    while at + 54 <= end {
        let mut head = [0; 22];
        input.seek(SeekFrom::Start(at))?;
        input.read_exact(&mut head)?;
        let user = head.get(2..18).unwrap_or_default();
        let user = user.split(|&b| b == 0).next().unwrap_or_default();
        at += 54 + u64::from(u16::from_le_bytes([head[20], head[21]]));
        if at > end || (found >= stated && !KNOWN_USERS.contains(&user)) {
            break;
        }
        found += 1;
    }
    Ok(RecordCount { stated, found })
}

/// A file whose header states another number of variable length records.
#[derive(Debug)]
pub(in crate::clouds) struct WithCount<R> {
    inner: R,
    /// The next byte.
    at: u64,
    count: [u8; 4],
}

/// Where that number stands in the header.
const COUNT_AT: u64 = 100;

impl<R> WithCount<R> {
    /// `inner` is at its start.
    pub(in crate::clouds) fn new(inner: R, count: u32) -> Self {
        Self {
            inner,
            at: 0,
            count: count.to_le_bytes(),
        }
    }
}

impl<R: Read> Read for WithCount<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.inner.read(buffer)?;
        if self.at < COUNT_AT + 4 {
            for (byte, place) in buffer.iter_mut().take(read).zip(self.at..) {
                let index = place.checked_sub(COUNT_AT).map(usize::try_from);
                if let Some(Ok(index)) = index
                    && let Some(counted) = self.count.get(index)
                {
                    *byte = *counted;
                }
            }
        }
        self.at += read as u64;
        Ok(read)
    }
}

impl<R: Seek> Seek for WithCount<R> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.at = self.inner.seek(to)?;
        Ok(self.at)
    }
}

/// The first extended variable length record, which begins at `start`: las takes the memory that it
/// claims, and reads no other.
fn check_extended(input: &mut (impl Read + Seek), start: u64, length: u64) -> Result<(), Fault> {
    let beyond = || {
        Fault::new(
            "its extended variable length records reach beyond its end",
            REMEDY,
        )
    };
    // Two bytes, a user of 16, a number of two; the length; 32 bytes in words.
    if start.saturating_add(60) > length {
        return Err(beyond());
    }
    let mut bytes = [0; 8];
    input
        .seek(SeekFrom::Start(start + 20))
        .and_then(|_| input.read_exact(&mut bytes))
        .map_err(|_| beyond())?;
    if u64::from_le_bytes(bytes) > length - start - 60 {
        return Err(beyond());
    }
    Ok(())
}

fn check_chunks(
    input: &mut (impl Read + Seek),
    header: &raw::Header,
    variable_records: u32,
    record: u64,
    length: u64,
) -> Result<(), Fault> {
    let damaged = |what: String| Fault::new(format!("its chunk table {what}"), REMEDY);
    let broken = |e: &dyn std::fmt::Display| damaged(format!("cannot be read ({e})"));
    let vlr = laszip_record(input, header, variable_records)?;
    let begin = u64::from(header.offset_to_point_data);

    // Where the table is stands in front of the points, or at the end of a file that was written
    // to a pipe.
    let mut place = 0;
    for from in [SeekFrom::Start(begin), SeekFrom::End(-8)] {
        let mut bytes = [0; 8];
        input.seek(from).map_err(|e| broken(&e))?;
        input.read_exact(&mut bytes).map_err(|e| broken(&e))?;
        place = u64::try_from(i64::from_le_bytes(bytes)).unwrap_or(0);
        if place > begin {
            break;
        }
    }
    if place <= begin || place.saturating_add(8) > length {
        return Err(damaged("lies beyond the end of the file".to_owned()));
    }
    // A version, then the number of chunks, each of which takes at least a byte.
    let mut bytes = [0; 4];
    input
        .seek(SeekFrom::Start(place + 4))
        .map_err(|e| broken(&e))?;
    input.read_exact(&mut bytes).map_err(|e| broken(&e))?;
    let chunks = u64::from(u32::from_le_bytes(bytes));
    if chunks > length {
        return Err(damaged(format!(
            "promises {chunks} chunks in a file of {length} bytes"
        )));
    }
    input.seek(SeekFrom::Start(begin)).map_err(|e| broken(&e))?;
    let table = ChunkTable::read_from(&mut *input, &vlr).map_err(|e| broken(&e))?;
    let mut total = 0_u64;
    for entry in table.as_ref() {
        total = total.saturating_add(entry.byte_count);
        if entry.point_count.saturating_mul(record) > LARGEST_CHUNK {
            return Err(damaged(format!(
                "has a chunk of {} points",
                entry.point_count
            )));
        }
    }
    if total > length {
        return Err(damaged(format!(
            "promises {total} bytes in a file of {length}"
        )));
    }
    Ok(())
}

/// LASzip's variable length record, found by walking all of them.
fn laszip_record(
    input: &mut (impl Read + Seek),
    header: &raw::Header,
    count: u32,
) -> Result<LazVlr, Fault> {
    let broken = |e: &dyn std::fmt::Display| {
        Fault::new(
            format!("its variable length records cannot be read ({e})"),
            REMEDY,
        )
    };
    input
        .seek(SeekFrom::Start(header.header_size.into()))
        .map_err(|e| broken(&e))?;
    for _ in 0..count {
        let record = raw::Vlr::read_from(&mut *input, false).map_err(|e| broken(&e))?;
        let user = record.user_id.split(|&b| b == 0).next().unwrap_or_default();
        if user == LazVlr::USER_ID.as_bytes() && record.record_id == LazVlr::RECORD_ID {
            return LazVlr::read_from(record.data.as_slice()).map_err(|e| broken(&e));
        }
    }
    Err(Fault::new(
        "it is compressed, but says not how (no LASzip record)",
        REMEDY,
    ))
}
