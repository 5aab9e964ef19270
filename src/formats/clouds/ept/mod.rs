//! Entwine Point Tile (EPT): a cloud cut into the tiles of an octree, as entwine and untwine write it
//! and OpenDroneMap leaves it in `entwine_pointcloud`.
//!
//! Written from the "Entwine Point Tile" specification 1.0 and PDAL's documentation of `readers.ept`:
//!
//! ```text
//! ept.json                       {bounds, dataType, hierarchyType, points, schema, span, srs, version}
//! ept-hierarchy/0-0-0-0.json     {"D-X-Y-Z": count of points, or -1: see ept-hierarchy/D-X-Y-Z.json}
//! ept-data/D-X-Y-Z.laz           the points of one tile
//! ```
//!
//! A point is in one tile only: those of a deeper level add to those above, so all tiles together are
//! the cloud. Of the data types only "laszip" is read; the others ("binary", "zstandard") are refused
//! by name. `srs` names the coordinate system by its codes or as WKT; where it is empty, the tiles' own
//! counts.

use std::collections::HashSet;
use std::io::Cursor;

use glam::DVec3;
use serde::Deserialize;

use crate::clouds::cloud_file::CloudFile;
use crate::clouds::las;
use crate::clouds::pieces::piece::{LEAST_SAMPLE, sample_of};
use crate::fault::Fault;
use crate::geometry::Bounds;
use crate::jobs::Progress;
use crate::surface::CloudFacts;
use crate::text::json::{Object, parse};

/// The name of the file that stands for the whole.
pub(crate) const HEADER: &str = "ept.json";

/// The most tiles that are read: entwine puts some 100 000 points into each.
const MOST_TILES: usize = 1_000_000;

pub(super) const REMEDY: &str = "copy the whole folder, or export the cloud as LAZ";

/// The data type that is read.
const LASZIP: &str = "laszip";

/// Whether a file that begins with `start` is the header of an EPT, by its name in lower case and its
/// keys.
pub(crate) fn is_header(start: &[u8], name: &str) -> bool {
    let text = String::from_utf8_lossy(start);
    let has = |key: &str| text.contains(&format!("\"{key}\""));
    let begins = text.trim_start_matches('\u{feff}').trim_start();
    begins.starts_with('{')
        && name.ends_with(".json")
        && (name == HEADER || (has("dataType") && has("hierarchyType")))
}

/// Why the tiles of this header cannot be read; `None` where they can.
pub(crate) fn refusal(header: &[u8]) -> Option<String> {
    match parse::<Header>(header) {
        Ok(header) => header.check().err().map(|fault| fault.what),
        Err(fault) => Some(fault.what),
    }
}

#[derive(Deserialize)]
pub(super) struct Header {
    #[serde(rename = "dataType")]
    data_type: String,
    #[serde(rename = "hierarchyType")]
    hierarchy_type: Option<String>,
    points: Option<u64>,
    pub(super) srs: Option<Srs>,
    /// The cube of the octree: the lowest and the highest corner.
    pub(super) bounds: Option<[f64; 6]>,
    /// Around its points.
    #[serde(rename = "boundsConforming")]
    pub(super) conforming: Option<[f64; 6]>,
}

#[derive(Deserialize)]
pub(super) struct Srs {
    authority: Option<String>,
    horizontal: Option<Code>,
    vertical: Option<Code>,
    wkt: Option<String>,
}

/// A code of EPSG's, which some write as a number.
#[derive(Deserialize)]
#[serde(untagged)]
enum Code {
    Text(String),
    Number(u32),
}

impl Code {
    fn number(&self) -> Option<u32> {
        match self {
            Self::Text(text) => text.trim().parse().ok(),
            Self::Number(number) => Some(*number),
        }
    }
}

impl Srs {
    /// "EPSG:n", "EPSG:n+m" with the heights', or WKT.
    pub(super) fn crs(&self) -> Option<String> {
        let authority = self.authority.as_deref().unwrap_or("EPSG");
        let number = |code: &Option<Code>| code.as_ref().and_then(Code::number);
        if let Some(horizontal) = number(&self.horizontal)
            && authority.eq_ignore_ascii_case("epsg")
        {
            return Some(match number(&self.vertical) {
                Some(vertical) => format!("EPSG:{horizontal}+{vertical}"),
                None => format!("EPSG:{horizontal}"),
            });
        }
        self.wkt.clone().filter(|wkt| !wkt.trim().is_empty())
    }
}

impl Header {
    /// What is to be said where the tiles hold another number of points.
    pub(super) fn warning(&self, found: u64) -> Option<String> {
        let points = self.points.filter(|&points| points != found)?;
        Some(format!(
            "{HEADER} promises {points} points, its tiles hold {found}"
        ))
    }

    pub(super) fn check(&self) -> Result<(), Fault> {
        if self.data_type != LASZIP {
            let what = format!(
                "its tiles are of the data type \"{}\", and only \"{LASZIP}\" is read",
                self.data_type
            );
            return Err(Fault::new(what, "export the cloud as LAZ"));
        }
        match self.hierarchy_type.as_deref() {
            None | Some("json") => Ok(()),
            Some(other) => {
                let what =
                    format!("its hierarchy is of the type \"{other}\", and only \"json\" is read");
                Err(Fault::new(what, "export the cloud as LAZ"))
            }
        }
    }
}

/// Reads all tiles as one cloud. `header` is the text of `ept.json`, `beside` reads a file by its path
/// below the same folder.
///
/// # Errors
/// Where the data type is another one, a file is missing or damaged (with its name), or there is no
/// point.
pub(crate) fn read(
    header: &[u8],
    beside: &dyn Fn(&str) -> Result<Vec<u8>, Fault>,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let header: Header = parse(header)?;
    header.check()?;
    let tiles = tiles(beside)?;
    let mut whole = CloudFile::default();
    let mut coarse = 0;
    for (done, tile) in tiles.iter().enumerate() {
        progress.advance(done as u64, tiles.len() as u64)?;
        add(&mut whole, read_tile(&tile.key, beside)?);
        if coarse < LEAST_SAMPLE {
            coarse = whole.cloud.points.len();
        }
    }
    let found = whole.cloud.points.len() as u64;
    whole.warnings.extend(header.warning(found));
    if let Some(crs) = header.srs.as_ref().and_then(Srs::crs) {
        whole.crs = Some(crs);
    }
    whole.expect_points()?;
    let sample = whole.cloud.points.get(..coarse).unwrap_or_default();
    whole.facts = header.conforming.map(|bounds| CloudFacts {
        count: found,
        bounds: box_of(bounds),
        sample: sample_of(sample),
    });
    Ok(whole)
}

/// The points of a tile.
pub(super) fn read_tile(
    key: &str,
    beside: &dyn Fn(&str) -> Result<Vec<u8>, Fault>,
) -> Result<CloudFile, Fault> {
    let name = format!("ept-data/{key}.laz");
    let bytes = beside(&name).map_err(|fault| of_file(&name, fault))?;
    // The fraction is that of the whole, and each tile's reading would count from its own start.
    let of_tile = Progress::default();
    las::read(Cursor::new(bytes), &of_tile).map_err(|fault| of_file(&name, fault))
}

pub(super) fn box_of([x, y, z, to_x, to_y, to_z]: [f64; 6]) -> Bounds {
    Bounds {
        min: DVec3::new(x, y, z),
        max: DVec3::new(to_x, to_y, to_z),
    }
}

/// Adds the points of a tile to those of the tiles before.
fn add(whole: &mut CloudFile, part: CloudFile) {
    let colors = part.cloud.colors;
    if colors.is_empty() {
        for point in part.cloud.points {
            whole.push(point, None);
        }
    } else {
        for (point, color) in part.cloud.points.into_iter().zip(colors) {
            whole.push(point, Some(color));
        }
    }
    whole.crs = whole.crs.take().or(part.crs);
    whole.geographic |= part.geographic;
    for warning in part.warnings {
        if !whole.warnings.contains(&warning) {
            whole.warnings.push(warning);
        }
    }
}

/// A tile with points.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Tile {
    level: u32,
    pub(super) key: String,
    pub(super) count: u64,
}

/// All tiles with points, coarse ones first.
pub(super) fn tiles(beside: &dyn Fn(&str) -> Result<Vec<u8>, Fault>) -> Result<Vec<Tile>, Fault> {
    let root = "0-0-0-0".to_owned();
    let mut seen = HashSet::from([root.clone()]);
    let mut open = vec![root];
    let mut tiles = Vec::new();
    while let Some(next) = open.pop() {
        let name = format!("ept-hierarchy/{next}.json");
        let bytes = beside(&name).map_err(|fault| of_file(&name, fault))?;
        let counts: Object<i64> = parse(&bytes).map_err(|fault| of_file(&name, fault))?;
        for (key, count) in counts.0 {
            let level = level(&key).ok_or_else(|| {
                let what = format!("{name}: \"{key}\" is no key of a tile");
                Fault::new(what, REMEDY)
            })?;
            if let Ok(count) = u64::try_from(count) {
                if count > 0 {
                    tiles.push(Tile { level, key, count });
                }
            } else if count == -1 && seen.insert(key.clone()) {
                open.push(key);
            }
            if tiles.len() + seen.len() > MOST_TILES {
                let what = format!("it has more than {MOST_TILES} tiles");
                return Err(Fault::new(what, "thin the cloud and export it as LAZ"));
            }
        }
    }
    tiles.sort();
    // A key may stand in the file that refers to its own as well.
    tiles.dedup_by(|b, a| a.key == b.key);
    Ok(tiles)
}

/// The level of a key D-X-Y-Z, if it is one: keys become names of files.
fn level(key: &str) -> Option<u32> {
    numbers(key).map(|[level, ..]| level)
}

pub(super) fn numbers(key: &str) -> Option<[u32; 4]> {
    let numbers: Option<Vec<u32>> = key
        .split('-')
        .map(|number| {
            let plain = number.bytes().all(|byte| byte.is_ascii_digit());
            number.parse().ok().filter(|_| plain)
        })
        .collect();
    numbers?.try_into().ok()
}

/// A fault of one of its files.
pub(super) fn of_file(name: &str, fault: Fault) -> Fault {
    let place = fault
        .line
        .map(|line| format!(":{line}"))
        .unwrap_or_default();
    Fault::new(format!("{name}{place}: {}", fault.what), REMEDY)
}

#[cfg(test)]
pub(crate) mod tests;
