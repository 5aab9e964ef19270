//! How records of LAS and LAZ are stored, and the points in some bytes of them.

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use las::{Transform, Vector};
use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};
use laz::{DecompressionSelection, LazItem};

use crate::fault::Fault;
use crate::geometry::Bounds;

const REMEDY: &str = "copy or export it again";

/// How records are stored.
#[derive(Debug, Clone)]
pub(in crate::clouds) struct Layout {
    pub(super) record: usize,
    transforms: Vector<Transform>,
    /// Of compressed ones; empty of others.
    pub(super) items: Vec<LazItem>,
    /// Whether the fields are compressed in layers of their own (point formats from 6 on).
    is_layered: bool,
}

/// The box that a header states.
pub(in crate::clouds) fn bounds_of(header: &las::Header) -> Bounds {
    let las::Bounds { min, max } = header.bounds();
    Bounds {
        min: DVec3::new(min.x, min.y, min.z),
        max: DVec3::new(max.x, max.y, max.z),
    }
}

impl Layout {
    /// As a header states it.
    pub(in crate::clouds) fn of(header: &las::Header) -> Result<Self, Fault> {
        let format = header.point_format();
        let items = match format.is_compressed {
            true => header.laz_vlr().map_err(damaged_header)?.items().clone(),
            false => Vec::new(),
        };
        Ok(Self {
            record: usize::from(format.len()),
            transforms: *header.transforms(),
            items,
            is_layered: format.is_extended,
        })
    }

    /// The points of these bytes of a file.
    pub(in crate::clouds) fn decode(
        &self,
        bytes: Vec<u8>,
        count: u64,
    ) -> Result<Vec<DVec3>, Fault> {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        let records = match self.items.is_empty() {
            true => bytes,
            // It asserts on damaged data. Nothing outlives the closure that a panic could have left half-done.
            false => catch_unwind(AssertUnwindSafe(|| self.decompress(bytes, count)))
                .unwrap_or_else(|_| Err(std::io::Error::other("its chunk contradicts itself")))
                .map_err(|error| {
                    let what = format!("its compressed points are damaged ({error})");
                    Fault::new(what, REMEDY)
                })?,
        };
        let number = |record: &[u8], at: usize| match record.get(at..at + 4) {
            Some(&[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]),
            // No format has shorter records.
            _ => 0,
        };
        let Vector { x, y, z } = self.transforms;
        let points = records.chunks_exact(self.record.max(12)).take(count);
        let points = points.map(|record| {
            DVec3::new(
                x.direct(number(record, 0)),
                y.direct(number(record, 4)),
                z.direct(number(record, 8)),
            )
        });
        Ok(points.collect())
    }

    fn decompress(&self, bytes: Vec<u8>, count: usize) -> std::io::Result<Vec<u8>> {
        let size = count.checked_mul(self.record);
        let size = size.ok_or_else(|| std::io::Error::other("it is too large"))?;
        let mut records = vec![0; size];
        let damaged = |error: laz::LasZipError| std::io::Error::other(error.to_string());
        let input = Cursor::new(bytes);
        if self.is_layered {
            let mut decompressor = LayeredPointRecordDecompressor::new(input);
            decompressor.set_fields_from(&self.items).map_err(damaged)?;
            decompressor.set_selection(DecompressionSelection::xy_returns_channel().decompress_z());
            decompressor.decompress_many(&mut records)?;
        } else {
            let mut decompressor = SequentialPointRecordDecompressor::new(input);
            decompressor.set_fields_from(&self.items).map_err(damaged)?;
            decompressor.decompress_many(&mut records)?;
        }
        Ok(records)
    }
}

fn damaged_header(error: las::Error) -> Fault {
    Fault::new(format!("it cannot be read as LAS or LAZ ({error})"), REMEDY)
}

/// Some bytes of a file, which may be shorter than that.
pub(in crate::clouds) fn read_at(
    file: &mut (impl Read + Seek),
    start: u64,
    length: u64,
) -> std::io::Result<Vec<u8>> {
    let end = file.seek(SeekFrom::End(0))?;
    if start.checked_add(length).is_none_or(|last| last > end) {
        return Err(std::io::ErrorKind::UnexpectedEof.into());
    }
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = vec![0; usize::try_from(length).map_err(std::io::Error::other)?];
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}
