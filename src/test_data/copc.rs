//! Writes Cloud Optimized Point Clouds (COPC 1.0), for tests and benchmarks: LAZ of point format 6, one chunk a node,
//! the hierarchy behind the points. What is written is what the reader's header says.
//!
//! Coordinates are whole numbers of steps of one size, without an offset.

use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::Path;

use laz::laszip::{ChunkTable, ChunkTableEntry};
use laz::record::{LayeredPointRecordCompressor, RecordCompressor};
use laz::{LazItemRecordBuilder, LazVlr, LazVlrBuilder};
use rayon::prelude::*;

/// Level, x, y, z.
pub type Key = [i32; 4];

/// Bytes of a record of point format 6.
const RECORD: usize = 30;

/// From this level on entries stand in pages of their own.
const OWN_PAGE: i32 = 2;

/// Where the octree lies.
#[derive(Debug, Clone, Copy)]
pub struct Cube {
    /// Its lowest corner.
    pub low: [f64; 3],
    /// Its side.
    pub side: f64,
}

/// A node with its points, in steps.
pub type Node = (Key, Vec<[i32; 3]>);

/// Sorts points (in steps of `scale`) into nodes of about `most` points: a node takes some from all over its cube,
/// and its children the others.
pub fn octree(points: Vec<[i32; 3]>, scale: f64, cube: Cube, most: usize) -> Vec<Node> {
    let mut nodes = Vec::new();
    let mut waiting = vec![([0; 4], points)];
    while let Some((key, points)) = waiting.pop() {
        let [level, at @ ..] = key;
        if points.len() <= most || level > 12 {
            nodes.push((key, points));
            continue;
        }
        let every = points.len() / most + 1;
        let side = cube.side / f64::from(1 << level);
        let mut own = Vec::new();
        let mut below: Vec<Node> = (0..8)
            .map(|child: i32| {
                let bit = |axis: usize| 2 * at[axis] + (child >> axis & 1);
                ([level + 1, bit(0), bit(1), bit(2)], Vec::new())
            })
            .collect();
        for (number, point) in points.into_iter().enumerate() {
            if number % every == 0 {
                own.push(point);
                continue;
            }
            let half = |axis: usize| {
                let middle = cube.low[axis] + side * (f64::from(at[axis]) + 0.5);
                usize::from(f64::from(point[axis]) * scale >= middle)
            };
            below[half(0) | half(1) << 1 | half(2) << 2].1.push(point);
        }
        nodes.push((key, own));
        waiting.extend(below.into_iter().filter(|(_, points)| !points.is_empty()));
    }
    nodes
}

/// Writes one file.
pub struct CopcWriter {
    file: BufWriter<File>,
    scale: f64,
    cube: Cube,
    vlr: LazVlr,
    /// Where the next chunk begins.
    at: u64,
    /// Where the points begin.
    begin: u64,
    table: ChunkTable,
    entries: Vec<(Key, u64, usize, usize)>,
    low: [i32; 3],
    high: [i32; 3],
    count: u64,
}

#[expect(clippy::unwrap_used, reason = "in a test a panic is the report")]
impl CopcWriter {
    /// Begins it.
    ///
    /// # Panics
    /// As everything here: where the file cannot be written.
    pub fn create(path: &Path, scale: f64, cube: Cube) -> Self {
        let items = LazItemRecordBuilder::default_for_point_format_id(6, 0).unwrap();
        let vlr = LazVlrBuilder::new(items).with_variable_chunk_size().build();
        let mut of_laz = Vec::new();
        vlr.write_to(&mut of_laz).unwrap();
        let begin = 375 + 54 + 160 + 54 + of_laz.len() as u64;
        let mut file = BufWriter::with_capacity(1 << 20, File::create(path).unwrap());
        file.write_all(&vec![0; usize::try_from(begin).unwrap() + 8])
            .unwrap();
        Self {
            file,
            scale,
            cube,
            vlr,
            at: begin + 8,
            begin,
            table: ChunkTable::default(),
            entries: Vec::new(),
            low: [i32::MAX; 3],
            high: [i32::MIN; 3],
            count: 0,
        }
    }

    /// Adds nodes, each once.
    pub fn add(&mut self, nodes: &[Node]) {
        let compressed = nodes.par_iter().map(|(_, points)| self.compressed(points));
        let compressed: Vec<Vec<u8>> = compressed.collect();
        for ((key, points), bytes) in nodes.iter().zip(compressed) {
            for point in points {
                for (axis, &at) in point.iter().enumerate().take(3) {
                    self.low[axis] = self.low[axis].min(at);
                    self.high[axis] = self.high[axis].max(at);
                }
            }
            if points.is_empty() {
                self.entries.push((*key, 0, 0, 0));
                continue;
            }
            self.file.write_all(&bytes).unwrap();
            self.table.push(ChunkTableEntry {
                point_count: points.len() as u64,
                byte_count: bytes.len() as u64,
            });
            self.entries
                .push((*key, self.at, bytes.len(), points.len()));
            self.at += bytes.len() as u64;
            self.count += points.len() as u64;
        }
    }

    fn compressed(&self, points: &[[i32; 3]]) -> Vec<u8> {
        let mut records = Vec::with_capacity(points.len() * RECORD);
        for point in points {
            let mut record = [0; RECORD];
            for (axis, number) in point.iter().enumerate() {
                record[4 * axis..4 * axis + 4].copy_from_slice(&number.to_le_bytes());
            }
            // The first of one return.
            record[14] = 0x11;
            records.extend(record);
        }
        let mut compressor = LayeredPointRecordCompressor::new(Vec::new());
        compressor.set_fields_from(self.vlr.items()).unwrap();
        if !records.is_empty() {
            compressor.compress_many(&records).unwrap();
            compressor.done().unwrap();
        }
        compressor.into_inner()
    }

    /// Writes what stands around the points.
    pub fn finish(mut self) {
        let table = self.at;
        self.table.write_to(&mut self.file, &self.vlr).unwrap();
        let hierarchy = self.file.stream_position().unwrap();
        let pages = self.pages(hierarchy + 60);
        let length: usize = pages.iter().map(Vec::len).sum();
        let mut head = record_head(1000, 60);
        head[20..28].copy_from_slice(&(length as u64).to_le_bytes());
        self.file.write_all(&head).unwrap();
        for page in &pages {
            self.file.write_all(page).unwrap();
        }
        self.file.seek(SeekFrom::Start(0)).unwrap();
        let front = self.front(hierarchy, hierarchy + 60, pages[0].len(), table);
        self.file.write_all(&front).unwrap();
        self.file.flush().unwrap();
    }

    /// The root's page first; each subtree below [`OWN_PAGE`] has one of its own.
    fn pages(&self, start: u64) -> Vec<Vec<u8>> {
        let entry = |key: &Key, place: u64, length: usize, count: i32| {
            let mut bytes: Vec<u8> = key.iter().flat_map(|number| number.to_le_bytes()).collect();
            bytes.extend(place.to_le_bytes());
            bytes.extend(u32::try_from(length).unwrap().to_le_bytes());
            bytes.extend(count.to_le_bytes());
            bytes
        };
        let of = |&(ref key, place, length, count): &(Key, u64, usize, usize)| {
            entry(key, place, length, i32::try_from(count).unwrap())
        };
        let subtree = |&[level, x, y, z]: &Key| {
            (level >= OWN_PAGE).then(|| {
                let up = level - OWN_PAGE;
                [OWN_PAGE, x >> up, y >> up, z >> up]
            })
        };
        let mut below: std::collections::BTreeMap<Key, Vec<u8>> = Default::default();
        let mut root = Vec::new();
        for node in &self.entries {
            match subtree(&node.0) {
                None => root.extend(of(node)),
                Some(key) => below.entry(key).or_default().extend(of(node)),
            }
        }
        let mut place = start + (root.len() + 32 * below.len()) as u64;
        for (key, page) in &below {
            root.extend(entry(key, place, page.len(), -1));
            place += page.len() as u64;
        }
        std::iter::once(root).chain(below.into_values()).collect()
    }

    /// Header and variable length records, and where the chunk table is.
    fn front(&self, evlr: u64, page: u64, page_length: usize, table: u64) -> Vec<u8> {
        let mut header = vec![0; 375];
        let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
        put(0, b"LASF");
        // The coordinate system would be WKT.
        put(6, &[16, 0]);
        put(24, &[1, 4]);
        put(58, b"fragscale test");
        put(94, &375_u16.to_le_bytes());
        put(96, &u32::try_from(self.begin).unwrap().to_le_bytes());
        put(100, &2_u32.to_le_bytes());
        put(104, &[6 | 0x80]);
        put(105, &30_u16.to_le_bytes());
        for axis in 0..3 {
            put(131 + 8 * axis, &self.scale.to_le_bytes());
            let ends = [self.high[axis], self.low[axis]];
            let ends = ends.map(|end| self.scale * f64::from(end) + 0.0);
            put(179 + 16 * axis, &ends[0].to_le_bytes());
            put(187 + 16 * axis, &ends[1].to_le_bytes());
        }
        put(235, &evlr.to_le_bytes());
        put(243, &1_u32.to_le_bytes());
        put(247, &self.count.to_le_bytes());
        put(255, &self.count.to_le_bytes());
        let mut info = Vec::new();
        let half = self.cube.side / 2.0;
        for low in self.cube.low {
            info.extend((low + half).to_le_bytes());
        }
        info.extend(half.to_le_bytes());
        info.extend((self.cube.side / 128.0).to_le_bytes());
        info.extend(page.to_le_bytes());
        info.extend((page_length as u64).to_le_bytes());
        info.resize(160, 0);
        let mut of_laz = Vec::new();
        self.vlr.write_to(&mut of_laz).unwrap();
        let mut front = header;
        for (mut head, data) in [(record_head(1, 54), info), (laz_head(), of_laz)] {
            head[20..22].copy_from_slice(&u16::try_from(data.len()).unwrap().to_le_bytes());
            front.extend(head);
            front.extend(data);
        }
        front.extend(table.to_le_bytes());
        front
    }
}

/// The head of a record of COPC's: two bytes, the user, the number; then lengths and words.
fn record_head(number: u16, length: usize) -> Vec<u8> {
    let mut head = vec![0; length];
    head[2..6].copy_from_slice(b"copc");
    head[18..20].copy_from_slice(&number.to_le_bytes());
    head
}

fn laz_head() -> Vec<u8> {
    let mut head = vec![0; 54];
    head[2..16].copy_from_slice(b"laszip encoded");
    head[18..20].copy_from_slice(&22_204_u16.to_le_bytes());
    head
}
