//! A sample of a large LAS or LAZ file in a second or two, before all of it is read: something to look at
//! meanwhile. It decides about nothing else.
//!
//! - COPC (version 1.0, <https://copc.io/copc-specification-1.0.pdf>): the coarse levels of its octree, the
//!   root first, as far as its first page of the hierarchy tells of them.
//! - Other LAZ: the first points of each chunk, which can be read without the rest of it.
//! - LAS: pieces from all over the file.

use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use las::{LazParallelism, PointData, PointDataBuilder, ReaderOptions};
use laz::record::{LayeredPointRecordDecompressor, RecordDecompressor};

use super::claims::check;
use super::{Colors, stated};
use crate::clouds::cloud_file::CloudFile;
use crate::jobs::Progress;

/// A file with fewer points is read so soon that nobody needs a sample.
pub(crate) const SAMPLED_FROM: u64 = 2_000_000;

/// About how many points a sample has.
const POINTS: u64 = 800_000;

/// Pieces of a file without octree, at most: of LAZ the bytes of a whole chunk are read for each.
const PIECES: u64 = 1000;

/// Bytes of an entry of COPC's hierarchy.
const ENTRY: usize = 32;

/// More bytes than this are no first page of a hierarchy.
const LARGEST_PAGE: u64 = 16 << 20;

/// More points than this are no node of an octree.
const LARGEST_NODE: i32 = 10_000_000;

/// A sample of a file's points, with how many it has in all; `None` where it has few, where it is of degrees or
/// its heights are in another unit,
/// where there are none, and where something is wrong with the file: reading it whole will say so.
pub(crate) fn read_sample(
    input: impl Read + Seek + Send + Sync + 'static,
    progress: &Progress,
) -> Option<(CloudFile, u64)> {
    // Nothing outlives the closure that a panic of the decompressor could have left half-done.
    catch_unwind(AssertUnwindSafe(|| sample(input, progress))).ok()?
}

fn sample(
    mut input: impl Read + Seek + Send + Sync + 'static,
    progress: &Progress,
) -> Option<(CloudFile, u64)> {
    let count = check(&mut input).ok()?;
    if count.found != count.stated {
        return None;
    }
    let header = las::Header::new(&mut input).ok()?;
    input.rewind().ok()?;
    let total = header.number_of_points();
    if total < SAMPLED_FROM {
        return None;
    }
    let (stated, heights) = stated(&header);
    if stated.geographic || heights != 1.0 {
        return None;
    }
    let mut taken = Taken::new(&header);
    match header.copc_info_vlr() {
        Some(_) => of_octree(input, &header, &mut taken, progress)?,
        None => of_pieces(input, &header, &mut taken, progress)?,
    }
    let file = taken.file();
    (!file.cloud.points.is_empty()).then_some((file, total))
}

/// The first points of chunks, or of as many pieces.
fn of_pieces(
    input: impl Read + Seek + Send + Sync + 'static,
    header: &las::Header,
    taken: &mut Taken,
    progress: &Progress,
) -> Option<()> {
    let total = header.number_of_points();
    let chunk = match header.point_format().is_compressed {
        true => u64::from(header.laz_vlr().ok()?.chunk_size()),
        false => total.div_ceil(PIECES),
    };
    let chunks = total.div_ceil(chunk.max(1));
    let step = chunks.div_ceil(PIECES);
    let each = (POINTS * step / chunks.max(1)).clamp(1, chunk);
    // One thread decodes the beginning of a chunk; several decode whole ones.
    let options = ReaderOptions::default().with_laz_parallelism(LazParallelism::No);
    let mut reader = las::Reader::with_options(input, options).ok()?;
    let mut portion = PointDataBuilder::new().for_header(header).build();
    for piece in (0..chunks).step_by(usize::try_from(step).ok()?) {
        progress.advance(piece, chunks).ok()?;
        reader.seek(piece * chunk).ok()?;
        reader.fill_points(each, &mut portion).ok()?;
        taken.take(&portion);
    }
    Some(())
}

/// An entry of COPC's hierarchy that has points.
struct Entry {
    level: i32,
    offset: u64,
    points: i32,
}

/// The nodes of the octree from the top, until there are points enough.
fn of_octree(
    mut input: impl Read + Seek + Send + Sync + 'static,
    header: &las::Header,
    taken: &mut Taken,
    progress: &Progress,
) -> Option<()> {
    let info = header.vlrs().iter().find(|vlr| vlr.is_copc_info())?;
    let number = |at: usize| -> Option<u64> {
        let bytes = info.data.get(at..at + 8)?;
        Some(u64::from_le_bytes(bytes.try_into().ok()?))
    };
    // Behind five floats: where the first page of the hierarchy is, and how long.
    let (offset, size) = (number(40)?, number(48)?);
    let length = input.seek(SeekFrom::End(0)).ok()?;
    if size > LARGEST_PAGE || offset.checked_add(size)? > length {
        return None;
    }
    let mut page = vec![0; usize::try_from(size).ok()?];
    input.seek(SeekFrom::Start(offset)).ok()?;
    input.read_exact(&mut page).ok()?;
    let mut entries: Vec<Entry> = page.chunks_exact(ENTRY).filter_map(entry).collect();
    entries.sort_by_key(|entry| (entry.level, entry.offset));
    let items = header.laz_vlr().ok()?;
    let record = usize::from(header.point_format().len());
    let mut decompressor = LayeredPointRecordDecompressor::new(BufReader::new(input));
    let mut left = i64::try_from(POINTS).ok()?;
    for entry in entries {
        progress.advance(taken.count() as u64, POINTS).ok()?;
        if left <= 0 {
            break;
        }
        left -= i64::from(entry.points);
        let bytes = usize::try_from(entry.points).ok()?.checked_mul(record)?;
        // As large as the chunk says at most: of compressed bytes there are fewer.
        if entry.points > LARGEST_NODE || entry.offset > length {
            return None;
        }
        let mut points = Cursor::new(vec![0; bytes]);
        decompressor
            .get_mut()
            .seek(SeekFrom::Start(entry.offset))
            .ok()?;
        decompressor.reset();
        decompressor.set_fields_from(items.items()).ok()?;
        decompressor.decompress_many(points.get_mut()).ok()?;
        let builder = PointDataBuilder::new().for_header(header);
        taken.take(&builder.build_from_bytes(points.into_inner()).ok()?);
    }
    Some(())
}

/// Level, x, y, z, the chunk's place, its size, its points; `None` without points, and where it leads to
/// another page.
fn entry(bytes: &[u8]) -> Option<Entry> {
    let four = |at: usize| -> Option<i32> {
        Some(i32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?))
    };
    let entry = Entry {
        level: four(0)?,
        offset: u64::from_le_bytes(bytes.get(16..24)?.try_into().ok()?),
        points: four(28)?,
    };
    (entry.points > 0).then_some(entry)
}

/// The points that were taken.
struct Taken {
    points: Vec<DVec3>,
    colors: Colors,
    /// The box that the header states.
    bounds: las::Bounds,
}

impl Taken {
    fn new(header: &las::Header) -> Self {
        Self {
            points: Vec::new(),
            colors: Colors::default(),
            bounds: header.bounds(),
        }
    }

    fn count(&self) -> usize {
        self.points.len()
    }

    fn take(&mut self, portion: &PointData) {
        let coordinates = portion.x().zip(portion.y()).zip(portion.z());
        let points = coordinates.map(|((x, y), z)| DVec3::new(x, y, z));
        self.points.extend(points);
        if let Some(colors) = portion.rgb() {
            self.colors.extend(colors.map(|(r, g, b)| [r, g, b]));
        }
    }

    /// Without what lies where the file says that nothing is: a picture of it would show nothing else.
    fn file(self) -> CloudFile {
        let (min, max) = (self.bounds.min, self.bounds.max);
        let (min, max) = (
            DVec3::new(min.x, min.y, min.z),
            DVec3::new(max.x, max.y, max.z),
        );
        let slack = (max - min).max_element() * 1e-6 + 1e-3;
        let is_inside = |point: &DVec3| {
            point.is_finite() && point.cmpge(min - slack).all() && point.cmple(max + slack).all()
        };
        let mut file = CloudFile::default();
        let mut colors = self.colors.finish();
        colors.resize(
            if colors.is_empty() {
                0
            } else {
                self.points.len()
            },
            [128; 3],
        );
        for (index, point) in self.points.iter().enumerate() {
            if is_inside(point) {
                file.cloud.points.push(*point);
                file.cloud.colors.extend(colors.get(index));
            }
        }
        file
    }
}

#[cfg(test)]
mod tests;
