//! A cloud's file in pieces that can be read one by one, in any order: what is read of a cloud that is larger than
//! the memory.
//!
//! ```text
//! piece    one of them
//! layout   how records are stored
//! records  LAS: runs of records; LAZ: its compressed chunks; where each lies is known once it was read
//! copc     COPC: the nodes of its octree, each with the cube that it lies in
//! tiles    EPT: its tiles, each a file
//! ```
//!
//! Points alone are read, no colours: coordinates are those that `las` decodes, to the last bit.

pub(crate) mod copc;
mod layout;
pub(super) mod piece;
mod records;
mod tiles;

use std::path::Path;

use glam::DVec3;

pub use self::piece::CloudPiece;
use self::piece::Place;
use self::records::Records;
use self::tiles::Tiles;
use crate::clouds::cloud_file::{CloudFile, first_not_finite};
use crate::detect::{CloudFormat, Kind, detect};
use crate::fault::Fault;
use crate::files::FileError;
use crate::geometry::Bounds;
use crate::surface::CloudFacts;

/// A cloud's file in pieces.
#[derive(Debug)]
pub struct CloudPieces {
    /// What it states, without a point.
    pub file: CloudFile,
    /// How many points it has.
    pub count: u64,
    /// The box around them that it states.
    pub bounds: Bounds,
    /// In the order of the file.
    pub pieces: Vec<CloudPiece>,
    /// Of octrees, which know where each piece lies: what of the cloud is known without reading it.
    pub facts: Option<CloudFacts>,
    source: Source,
}

#[derive(Debug)]
enum Source {
    Records(Records),
    Tiles(Tiles),
}

impl CloudPieces {
    /// Opens a file in pieces; `None` where its format has none.
    ///
    /// # Errors
    /// With the file, where what it claims cannot be.
    pub fn open(path: &Path) -> Result<Option<Self>, FileError> {
        let at = |fault| FileError::new(path, fault);
        match detect(path)? {
            Kind::Cloud(CloudFormat::Las) => records::open(path).map_err(at),
            Kind::Cloud(CloudFormat::Ept) => tiles::open(path).map(Some).map_err(at),
            _ => Ok(None),
        }
    }

    /// The points of a piece, in the file's coordinates.
    ///
    /// # Errors
    /// Where it is damaged, or cannot be read.
    pub fn read(&self, piece: &CloudPiece) -> Result<Vec<DVec3>, Fault> {
        let points = match &self.source {
            Source::Records(records) => records.read(piece)?,
            Source::Tiles(tiles) => tiles.read(piece)?,
        };
        match first_not_finite(&points) {
            None => Ok(points),
            Some(index) => Err(Fault::new(
                format!(
                    "a point ({index} of its piece) has a coordinate that is not a finite number"
                ),
                "check the scale and offset in its header",
            )),
        }
    }
}
