//! Cloud Optimized Point Cloud: a LAZ file whose chunks are the nodes of an octree (COPC 1.0,
//! <https://copc.io/copc-specification-1.0.pdf>).
//!
//! - The first variable length record ("copc", 1): the cube (its middle and half of its side), the spacing, then where
//!   the first page of the hierarchy is and how long.
//! - A page has entries of 32 bytes: level, x, y, z (i32), the place (u64) and the size (i32) of a chunk, how many points
//!   it has (i32). -1 points: the entry leads to another page.
//! - Node (level, x, y, z) lies in the cube of 1/2^level of the side, x, y and z cubes from the lowest corner. A point is
//!   in one node only: deeper nodes add to those above.

use std::collections::HashSet;
use std::io::{Read, Seek};

use glam::DVec3;

use super::layout::{Layout, bounds_of, read_at};
use super::piece::{CloudPiece, LEAST_SAMPLE, Place, sample_of};
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::surface::CloudFacts;

/// Bytes of an entry.
const ENTRY: usize = 32;

/// More nodes than this are none of a real file: 100 000 points a node make 200 thousand million.
const MOST_NODES: usize = 2_000_000;

/// The largest node that is decompressed, in bytes of records.
const LARGEST_NODE: u64 = 1 << 30;

const REMEDY: &str = "copy or export it again";

/// The octree of a file.
#[derive(Debug)]
pub(in crate::clouds) struct Tree {
    /// In the order of their chunks in the file.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    level: u32,
    at: [i32; 3],
    piece_start: u64,
    piece_length: u64,
    count: u64,
    bounds: Bounds,
}

fn damaged(what: &str) -> Fault {
    Fault::new(format!("the hierarchy of its octree {what}"), REMEDY)
}

impl Tree {
    /// Reads all pages of the hierarchy; `None` where the octree does not have all points of the file.
    ///
    /// # Errors
    /// Where a page claims what cannot be.
    pub(in crate::clouds) fn read(
        input: &mut (impl Read + Seek),
        header: &las::Header,
    ) -> Result<Option<Self>, Fault> {
        let Some(info) = header.vlrs().iter().find(|vlr| vlr.is_copc_info()) else {
            return Ok(None);
        };
        let eight = |at: usize| -> Option<[u8; 8]> { info.data.get(at..at + 8)?.try_into().ok() };
        let float = |at: usize| eight(at).map(f64::from_le_bytes);
        let number = |at: usize| eight(at).map(u64::from_le_bytes);
        let stated = (|| {
            let middle = DVec3::new(float(0)?, float(8)?, float(16)?);
            Some((middle, float(24)?, number(40)?, number(48)?))
        })();
        let Some((middle, half, page, size)) = stated else {
            return Err(damaged("is not described"));
        };
        let cube = (middle - half, 2.0 * half);
        let record = u64::from(header.point_format().len());
        // A point may be rounded into the cube beside it.
        let transforms = header.transforms();
        let room = DVec3::new(transforms.x.scale, transforms.y.scale, transforms.z.scale).abs();
        let mut nodes = Vec::new();
        let mut seen = HashSet::from([page]);
        let mut pages = vec![(page, size)];
        while let Some((page, size)) = pages.pop() {
            let bytes = read_at(input, page, size)
                .map_err(|_| damaged("reaches beyond the end of the file"))?;
            for entry in bytes.chunks_exact(ENTRY) {
                let four = |at: usize| match entry.get(at..at + 4) {
                    Some(&[a, b, c, d]) => i32::from_le_bytes([a, b, c, d]),
                    _ => 0,
                };
                let place = entry.get(16..24).and_then(|place| place.try_into().ok());
                let place = u64::from_le_bytes(place.unwrap_or_default());
                let length = u64::try_from(four(24)).map_err(|_| damaged("has a negative size"))?;
                let Ok(count) = u64::try_from(four(28)) else {
                    if seen.insert(place) {
                        pages.push((place, length));
                    }
                    continue;
                };
                if count == 0 {
                    continue;
                }
                if count.saturating_mul(record) > LARGEST_NODE {
                    return Err(damaged(&format!("has a node of {count} points")));
                }
                let level = u32::try_from(four(0)).ok().filter(|&level| level < 31);
                let level = level.ok_or_else(|| damaged("has a level that cannot be"))?;
                let at = [four(4), four(8), four(12)];
                let side = cube.1 / f64::from(1_u32 << level);
                let low = cube.0 + DVec3::from(at.map(f64::from)) * side;
                let bounds = Bounds {
                    min: low - room,
                    max: low + side + room,
                };
                nodes.push(Node {
                    level,
                    at,
                    piece_start: place,
                    piece_length: length,
                    count,
                    bounds,
                });
                if nodes.len() > MOST_NODES {
                    return Err(damaged(&format!("has more than {MOST_NODES} nodes")));
                }
            }
        }
        nodes.sort_by_key(|node| node.piece_start);
        let found: u64 = nodes.iter().map(|node| node.count).sum();
        Ok((found == header.number_of_points()).then_some(Self { nodes }))
    }

    /// Its nodes as pieces.
    pub(super) fn pieces(&self) -> Vec<CloudPiece> {
        let piece = |node: &Node| CloudPiece {
            count: node.count,
            bounds: Some(node.bounds),
            place: Place {
                start: node.piece_start,
                length: node.piece_length,
            },
        };
        self.nodes.iter().map(piece).collect()
    }

    /// What is known of the cloud: the box that the header states, a sample of its coarsest nodes.
    ///
    /// # Errors
    /// Where a node is damaged.
    pub(in crate::clouds) fn facts(
        &self,
        input: &mut (impl Read + Seek),
        header: &las::Header,
    ) -> Result<CloudFacts, Fault> {
        let layout = Layout::of(header)?;
        let mut coarse: Vec<&Node> = self.nodes.iter().collect();
        coarse.sort_by_key(|node| (node.level, node.at));
        let mut points = Vec::new();
        for node in coarse {
            if points.len() >= LEAST_SAMPLE {
                break;
            }
            let bytes = read_at(input, node.piece_start, node.piece_length)
                .map_err(|_| damaged("places a node beyond the end of the file"))?;
            points.extend(layout.decode(bytes, node.count)?);
        }
        Ok(CloudFacts {
            count: header.number_of_points(),
            bounds: bounds_of(header),
            sample: sample_of(&points),
        })
    }
}
