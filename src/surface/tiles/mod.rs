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
//!
//! Which tiles have triangles in some place is known before any is made where all sites are here (`reach`). Of a part
//! of the sites it is not; there (`of_part`) a tile that is looked into is triangulated until every triangle that
//! reaches into it is proven, whoever owns it, and those who do are made.

mod local;
mod of_part;
mod reach;
mod triangulated;

use self::local::Local;
use self::reach::Reach;
use super::SurfaceError;
use super::left_out::Kept;
use super::made_once::MadeOnce;
use super::sites::{BLOCK, Cells, Sites};
use super::triangle_blocks::{TriangleBlock, sort_into_blocks};
use crate::geometry::Bounds;

/// Cells along a tile's sides; about 8000 sites. Smaller tiles make more of their margins, larger
/// ones more of what nobody asks for.
const SIDE: usize = BLOCK;

/// The triangulation of sites, as far as it was asked for.
#[derive(Debug)]
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    /// Of a part of the sites it is not known.
    reach: Option<Reach>,
}

/// One block of cells.
#[derive(Debug)]
struct Tile {
    cells: Cells,
    made: MadeOnce<Result<Made, SurfaceError>>,
    /// Of a part of the sites: the tiles that own the triangles which reach into this one.
    owners: MadeOnce<Result<Vec<usize>, SurfaceError>>,
}

/// The triangles that a tile owns.
#[derive(Debug, Default)]
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
                owners: MadeOnce::default(),
            })
        });
        let tiles: Vec<Tile> = tiles.collect();
        let reach =
            (!sites.is_part()).then(|| Reach::new(sites, tiles.iter().map(|tile| &tile.cells)));
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
        let wanted: Vec<&Tile> = match &self.reach {
            None => self.of_part(sites, &misses)?,
            Some(reach) => {
                let Reach {
                    over_closed,
                    fields,
                    ..
                } = reach;
                let seen = reach.seen_fields(&misses);
                let is_seen = |field: &u32| seen[*field as usize];
                (self.tiles.iter().zip(over_closed).zip(fields))
                    .filter(|((_, bounds), fields)| fields.iter().any(is_seen) || !misses(bounds))
                    .map(|((tile, _), _)| tile)
                    .collect()
            }
        };
        let make = |tile: &&Tile| make(sites, &tile.cells);
        MadeOnce::make_all(&wanted, |tile| &tile.made, make);
        let made = wanted.iter().map(|tile| tile.made.get(|| make(tile)));
        made.map(|made| made.as_ref().map_err(Clone::clone))
            .collect()
    }
}

/// A tile's triangles.
fn make(sites: &Sites, cells: &Cells) -> Result<Made, SurfaceError> {
    let Some(mut local) = Local::new(sites, cells)? else {
        return Ok(Made::default());
    };
    local.settle(None)?;
    Ok(made_of(&local, sites))
}

/// The triangles that a tile owns of its settled surroundings.
fn made_of(local: &Local<'_>, sites: &Sites) -> Made {
    // Without the room for those of the margin.
    let mut triangles = local.owned().into_boxed_slice().into_vec();
    // In one order, whatever they were made of.
    triangles.sort_unstable();
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
    Made {
        triangles,
        blocks,
        bounds,
        left_out: MadeOnce::default(),
    }
}

#[cfg(test)]
mod tests;
