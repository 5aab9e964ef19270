//! The whole triangulation of a cloud in tiles that are made one by one, on as many threads as ask for
//! them.
//!
//! A tile is a block of the sites' grid. It owns the triangles whose first corner (the smallest in the
//! order of the sites) lies in it. To make them, the sites of the block and of a margin around it are
//! triangulated, together with the convex hull of all sites, which settles where the surface ends.
//! A triangle belongs to the whole triangulation if and only if its circumcircle holds no site inside.
//! Where the circle lies within block and margin that is settled; else the sites that are in it are
//! looked up and join. So every triangle is proven, exactly (the predicates are), and none depends on
//! how the cloud was cut.
//!
//! Of four or more sites on one empty circle (a lattice is made of such) any triangulation is Delaunay.
//! For tiles to agree there is one rule: a fan around the first of them, which its tile owns.

mod local;
mod reach;
mod triangulated;

use self::local::Local;
use self::reach::Reach;
use super::SurfaceError;
use super::left_out::Kept;
use super::made_once::MadeOnce;
use super::patches::{TriangleBlock, sort_into_blocks};
use super::sites::{Cells, Sites};
use crate::geometry::Bounds;

/// Cells along a tile's sides; about 8000 sites. Smaller tiles make more of their margins, larger
/// ones more of what nobody asks for.
const SIDE: usize = 64;

/// The triangulation of sites, as far as it was asked for.
#[derive(Debug)]
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    reach: Reach,
}

/// One block of cells.
#[derive(Debug)]
struct Tile {
    cells: Cells,
    made: MadeOnce<Result<Made, SurfaceError>>,
}

/// The triangles that a tile owns.
#[derive(Debug)]
pub(super) struct Made {
    /// Indices of sites, counter-clockwise seen from above, the first corner first; block by block.
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) blocks: Vec<TriangleBlock>,
    /// Around them.
    pub(super) bounds: Option<Bounds>,
    /// Its sites left out in turn, once somebody asked.
    pub(super) left_out: MadeOnce<Vec<Kept>>,
}

impl Tiles {
    /// No triangle is made yet.
    pub(super) fn new(sites: &Sites) -> Self {
        let (columns, rows) = sites.grid_size();
        let starts = |count: usize| (0..count).step_by(SIDE);
        let tiles = starts(rows).flat_map(|row| {
            starts(columns).map(move |column| Tile {
                cells: Cells {
                    columns: column..(column + SIDE).min(columns),
                    rows: row..(row + SIDE).min(rows),
                },
                made: MadeOnce::default(),
            })
        });
        let tiles: Vec<Tile> = tiles.collect();
        let reach = Reach::new(sites, tiles.iter().map(|tile| &tile.cells));
        Self { tiles, reach }
    }

    /// The triangles of all tiles of which any may lie where `misses` does not miss, made on all cores
    /// where they are not made yet.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn seen(
        &self,
        sites: &Sites,
        misses: impl Fn(&Bounds) -> bool,
    ) -> Result<Vec<&Made>, SurfaceError> {
        let Reach {
            over_closed,
            fields,
            ..
        } = &self.reach;
        let seen = self.reach.seen_fields(&misses);
        let is_seen = |field: &u32| seen[*field as usize];
        let wanted = (self.tiles.iter().zip(over_closed).zip(fields))
            .filter(|((_, bounds), fields)| fields.iter().any(is_seen) || !misses(bounds))
            .map(|((tile, _), _)| tile);
        let wanted: Vec<&Tile> = wanted.collect();
        let make = |tile: &&Tile| make(sites, &tile.cells);
        MadeOnce::make_all(&wanted, |tile| &tile.made, make);
        let made = wanted.iter().map(|tile| tile.made.get(|| make(tile)));
        made.map(|made| made.as_ref().map_err(Clone::clone))
            .collect()
    }
}

/// A tile's triangles.
fn make(sites: &Sites, cells: &Cells) -> Result<Made, SurfaceError> {
    let nothing = Made {
        triangles: Vec::new(),
        blocks: Vec::new(),
        bounds: None,
        left_out: MadeOnce::default(),
    };
    let Some(mut local) = Local::new(sites, cells)? else {
        return Ok(nothing);
    };
    local.settle()?;
    // Without the room for those of the margin.
    let mut triangles = local.owned().into_boxed_slice().into_vec();
    let points = sites.points();
    let blocks = sort_into_blocks(&mut triangles, points);
    let corners = triangles
        .iter()
        .flatten()
        .map(|&index| points[index as usize]);
    let bounds = corners.fold(None, |bounds: Option<Bounds>, point| {
        Some(bounds.map_or(
            Bounds {
                min: point,
                max: point,
            },
            |bounds| Bounds {
                min: bounds.min.min(point),
                max: bounds.max.max(point),
            },
        ))
    });
    Ok(Made {
        triangles,
        blocks,
        bounds,
        left_out: MadeOnce::default(),
    })
}

#[cfg(test)]
mod tests;
