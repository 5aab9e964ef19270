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

/// Checks the claims; leaves the input at its start. Returns the number of points.
///
/// # Errors
/// Where the file cannot hold what its header says.
pub(super) fn check(input: &mut (impl Read + Seek)) -> Result<u64, Fault> {
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
        check_chunks(input, &header, record, length)?;
    }
    input.rewind().map_err(|e| unreadable(&e))?;
    Ok(records)
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
    record: u64,
    length: u64,
) -> Result<(), Fault> {
    let damaged = |what: String| Fault::new(format!("its chunk table {what}"), REMEDY);
    let broken = |e: &dyn std::fmt::Display| damaged(format!("cannot be read ({e})"));
    let vlr = laszip_record(input, header)?;
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
fn laszip_record(input: &mut (impl Read + Seek), header: &raw::Header) -> Result<LazVlr, Fault> {
    let broken = |e: &dyn std::fmt::Display| {
        Fault::new(
            format!("its variable length records cannot be read ({e})"),
            REMEDY,
        )
    };
    input
        .seek(SeekFrom::Start(header.header_size.into()))
        .map_err(|e| broken(&e))?;
    for _ in 0..header.number_of_variable_length_records {
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
