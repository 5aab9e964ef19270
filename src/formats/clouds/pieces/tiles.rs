//! The tiles of an EPT as pieces: each lies in a cube of its own, 1/2^D of the whole's side, X, Y and Z cubes from the
//! lowest corner.

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::piece::{CloudPiece, LEAST_SAMPLE, Place, sample_of};
use super::{CloudPieces, Source};
use crate::clouds::cloud_file::CloudFile;
use crate::clouds::ept::{Header, REMEDY, Srs, box_of, numbers, of_file, read_tile, tiles};
use crate::clouds::gltf::read_beside;
use crate::fault::Fault;
use crate::files::read_bytes;
use crate::geometry::Bounds;
use crate::surface::CloudFacts;
use crate::text::json::parse;

/// How far a point may be rounded out of its cube, in the cube's side.
const ROUNDING: f64 = 1e-6;

/// The tiles and where they are.
#[derive(Debug)]
pub(super) struct Tiles {
    path: PathBuf,
    keys: Vec<String>,
}

/// Opens it by the path of its `ept.json`.
pub(super) fn open(path: &Path) -> Result<CloudPieces, Fault> {
    let header = read_bytes(path).map_err(|error| error.fault)?;
    let header: Header = parse(&header)?;
    header.check()?;
    let beside = |name: &str| read_beside(path, name);
    let tiles = tiles(&beside)?;
    let cube = header.bounds.map(box_of);
    let of_tile = |key: &str| -> Option<Bounds> {
        let (cube, [level, at @ ..]) = (cube?, numbers(key)?);
        let side = cube.size() / 2_f64.powi(i32::try_from(level).ok()?);
        let low = cube.min + side * DVec3::from(at.map(f64::from));
        Some(Bounds {
            min: low - side * ROUNDING,
            max: low + side * (1.0 + ROUNDING),
        })
    };
    let pieces: Vec<CloudPiece> = (0..)
        .zip(&tiles)
        .map(|(start, tile)| CloudPiece {
            count: tile.count,
            bounds: of_tile(&tile.key),
            place: Place { start, length: 0 },
        })
        .collect();
    let Some(first) = tiles.first() else {
        return Err(Fault::new(
            "it has no points",
            "export points with x, y and z",
        ));
    };
    let count = pieces.iter().map(|piece| piece.count).sum();
    // As much as stands in every tile.
    let CloudFile {
        mut crs,
        geographic,
        mut warnings,
        ..
    } = read_tile(&first.key, &beside)?;
    if let Some(stated) = header.srs.as_ref().and_then(Srs::crs) {
        crs = Some(stated);
    }
    warnings.extend(header.warning(count));
    let source = Tiles {
        path: path.to_owned(),
        keys: tiles.into_iter().map(|tile| tile.key).collect(),
    };
    let facts = match header.conforming {
        Some(bounds) if cube.is_some() => {
            let mut points = Vec::new();
            for piece in &pieces {
                if points.len() >= LEAST_SAMPLE {
                    break;
                }
                points.extend(source.read(piece)?);
            }
            Some(CloudFacts {
                count,
                bounds: box_of(bounds),
                sample: sample_of(&points),
            })
        }
        _ => None,
    };
    let bounds = header.conforming.or(header.bounds).map(box_of);
    let nowhere = Bounds {
        min: DVec3::ZERO,
        max: DVec3::ZERO,
    };
    Ok(CloudPieces {
        file: CloudFile {
            crs,
            geographic,
            warnings,
            ..CloudFile::default()
        },
        count,
        bounds: bounds.unwrap_or(nowhere),
        pieces,
        facts,
        source: Source::Tiles(source),
    })
}

impl Tiles {
    /// The points of a tile.
    pub(super) fn read(&self, piece: &CloudPiece) -> Result<Vec<DVec3>, Fault> {
        let number = usize::try_from(piece.place.start).unwrap_or(usize::MAX);
        let key = self.keys.get(number).map_or("", String::as_str);
        let beside = |name: &str| read_beside(&self.path, name);
        let points = read_tile(key, &beside)?.cloud.points;
        if points.len() as u64 != piece.count {
            let what = format!(
                "its hierarchy promises {} points in it, it holds {}",
                piece.count,
                points.len()
            );
            return Err(of_file(
                &format!("ept-data/{key}.laz"),
                Fault::new(what, REMEDY),
            ));
        }
        Ok(points)
    }
}
