//! Which tiles have triangles in some place, where only a part of the sites is here.
//!
//! A tile that may hold a place that is looked at is triangulated with its margin. Where its triangles do not cover
//! it, the convex hull of all sites joins; and of every triangle whose box touches the tile's rectangle the circle is
//! looked into: one that reaches cells that are not here asks for them. Once nothing is asked for, these triangles are
//! those of the whole (each circle is empty of *all* sites), and they cover all of the surface over the rectangle. So
//! each triangle over a place that is looked at is among them, and the tiles that own them are all that are needed.

use std::collections::BTreeSet;

use glam::DVec2;

use super::local::{Local, MARGIN};
use super::{Made, MadeOnce, SIDE, Tile, Tiles, made_of};
use crate::geometry::Bounds;
use crate::surface::SurfaceError;
use crate::surface::sites::Sites;

impl Tiles {
    /// The tiles that own triangles over places where `misses` does not miss, in their order.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn of_part(
        &self,
        sites: &Sites,
        misses: impl Fn(&Bounds) -> bool,
    ) -> Result<Vec<&Tile>, SurfaceError> {
        let heights = (sites.bounds().min.z, sites.bounds().max.z);
        let looked_into = |tile: &&Tile| !misses(&sites.bounds_between(&tile.cells, heights));
        let looked_into: Vec<&Tile> = self.tiles.iter().filter(looked_into).collect();
        let find = |tile: &&Tile| self.owners(sites, tile);
        MadeOnce::make_all(&looked_into, |tile| &tile.owners, find);
        let mut owners: BTreeSet<usize> = BTreeSet::new();
        for tile in &looked_into {
            let found = tile.owners.get(|| find(tile));
            owners.extend(found.as_ref().map_err(Clone::clone)?);
        }
        let owners = owners.into_iter();
        let owners: Vec<&Tile> = owners.filter_map(|number| self.tiles.get(number)).collect();
        let is_here = |tile: &&Tile| sites.want(&sites.widened(&tile.cells, MARGIN));
        Ok(owners.into_iter().filter(is_here).collect())
    }

    /// The numbers of the tiles that own the triangles which reach into one; it is made on the way.
    fn owners(&self, sites: &Sites, tile: &Tile) -> Result<Vec<usize>, SurfaceError> {
        if !sites.want(&sites.widened(&tile.cells, MARGIN)) {
            return Ok(Vec::new());
        }
        let all = sites.bounds();
        let (least, greatest) = (all.min.truncate(), all.max.truncate());
        let (min, max) = sites.corners_of(&tile.cells);
        let into: [DVec2; 2] = [min, max].map(|corner| corner.clamp(least, greatest));
        let mut local = Local::around(sites, &tile.cells)?;
        local.settle(Some(into))?;
        tile.made.get(|| match local.has_own() {
            true => Ok(made_of(&local, sites)),
            false => Ok(Made::default()),
        });
        let (columns, _) = sites.grid_size();
        let tile_columns = columns.div_ceil(SIDE);
        let first = local.first_of_reaching(into).into_iter();
        let mut owners: Vec<usize> = first
            .map(|site| {
                let (row, column) = sites.cell_at(sites.points()[site as usize].truncate());
                row / SIDE * tile_columns + column / SIDE
            })
            .collect();
        owners.sort_unstable();
        owners.dedup();
        Ok(owners)
    }
}
