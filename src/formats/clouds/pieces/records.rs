//! The pieces of LAS, LAZ and COPC files.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;
use laz::laszip::ChunkTable;

use super::layout::{Layout, bounds_of, read_at};
use super::{CloudPiece, CloudPieces, Place, Source, copc};
use crate::clouds::las::{claims, stated};
use crate::fault::Fault;
use crate::files::open_file;

/// Records of an uncompressed file in one piece.
const RUN: u64 = 50_000;

/// How records are stored, and where.
#[derive(Debug)]
pub(in crate::clouds) struct Records {
    file: Mutex<File>,
    layout: Layout,
}

const REMEDY: &str = "copy or export it again";

fn unreadable(error: impl std::fmt::Display) -> Fault {
    Fault::new(format!("it cannot be read as LAS or LAZ ({error})"), REMEDY)
}

/// Opens it; `None` where it is compressed all in one, and where its heights have to be brought to another unit.
pub(super) fn open(path: &Path) -> Result<Option<CloudPieces>, Fault> {
    let mut file = open_file(path).map_err(|error| error.fault)?;
    let mut input = BufReader::new(&mut file);
    let count = claims::check(&mut input)?;
    let header = las::Header::new(claims::WithCount::new(&mut input, count.found));
    let header = header.map_err(unreadable)?;
    let (mut stated, heights) = stated(&header);
    if heights != 1.0 {
        return Ok(None);
    }
    if let Some(warning) = count.warning() {
        stated.warnings.push(warning);
    }
    input.rewind().map_err(unreadable)?;
    let raw = las::raw::Header::read_from(&mut input).map_err(unreadable)?;
    let begin = u64::from(raw.offset_to_point_data);
    let layout = Layout::of(&header)?;
    let total = header.number_of_points();
    let tree = match header.copc_info_vlr() {
        Some(_) => copc::Tree::read(&mut input, &header)?,
        None => None,
    };
    let pieces = match &tree {
        Some(tree) => tree.pieces(),
        None if layout.items.is_empty() => runs(&header, &layout, begin),
        None => match chunks(&mut input, &header, begin)? {
            Some(pieces) => pieces,
            None => return Ok(None),
        },
    };
    let facts = tree
        .map(|tree| tree.facts(&mut input, &header))
        .transpose()?;
    drop(input);
    Ok(Some(CloudPieces {
        file: stated,
        count: total,
        bounds: bounds_of(&header),
        pieces,
        facts,
        source: Source::Records(Records {
            file: Mutex::new(file),
            layout,
        }),
    }))
}

/// Runs of uncompressed records.
fn runs(header: &las::Header, layout: &Layout, begin: u64) -> Vec<CloudPiece> {
    let record = layout.record as u64;
    let total = header.number_of_points();
    let firsts = (0..total).step_by(usize::try_from(RUN).unwrap_or(usize::MAX));
    let run = |first: u64| {
        let count = RUN.min(total - first);
        CloudPiece {
            count,
            bounds: None,
            place: Place {
                start: begin + first * record,
                length: count * record,
            },
        }
    };
    firsts.map(run).collect()
}

/// The compressed chunks, which `claims` has looked at; `None` where all is one.
fn chunks(
    input: &mut (impl Read + Seek),
    header: &las::Header,
    begin: u64,
) -> Result<Option<Vec<CloudPiece>>, Fault> {
    let vlr = header.laz_vlr().map_err(unreadable)?;
    input.seek(SeekFrom::Start(begin)).map_err(unreadable)?;
    let Ok(table) = ChunkTable::read_from(&mut *input, &vlr) else {
        return Ok(None);
    };
    let total = header.number_of_points();
    // Behind the place of the chunk table.
    let (mut start, mut left) = (begin + ChunkTable::OFFSET_SIZE as u64, total);
    let mut pieces = Vec::new();
    for entry in table.as_ref() {
        // The last one is as long as the header says.
        let count = entry.point_count.min(left);
        left -= count;
        if count > 0 {
            let length = entry.byte_count;
            pieces.push(CloudPiece {
                count,
                bounds: None,
                place: Place { start, length },
            });
        }
        start += entry.byte_count;
    }
    match left {
        0 => Ok(Some(pieces)),
        _ => Err(Fault::new(
            format!(
                "its header promises {total} points, its chunks hold {}",
                total - left
            ),
            REMEDY,
        )),
    }
}

impl Records {
    /// The points of a piece.
    pub(super) fn read(&self, piece: &CloudPiece) -> Result<Vec<DVec3>, Fault> {
        let broken = |error: std::io::Error| {
            Fault::new(
                format!("it breaks off, or cannot be read ({error})"),
                REMEDY,
            )
        };
        let Place { start, length } = piece.place;
        let bytes = {
            // What is sought anew each time cannot be left half-done.
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            read_at(&mut *file, start, length).map_err(broken)?
        };
        self.layout.decode(bytes, piece.count)
    }
}
