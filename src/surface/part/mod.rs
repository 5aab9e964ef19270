//! A surface of which only a part is in memory, with the same numbers to the last bit.
//!
//! # Why they are the same
//!
//! What is computed on a triangulated cloud reads the cloud in four ways only: it looks up the sites of cells of a
//! grid, it asks for the convex hull of all, for the box around all, and for a sample of a few thousand points. The
//! last three are known before ([`CloudFacts`], [`HullOfMany`]), and the grid follows from them. So a part of the
//! cloud is the sites of some blocks of the grid's cells, in the order that they have in the whole, and everything
//! works as it does on the whole, as long as no cell is looked into that is not here. Such a look is noted
//! ([`Surface::wanted`](super::Surface::wanted)). *Where nothing is noted, everything that was read is what would
//! have been read of the whole, and what follows is the same.* Else the blocks that were wanted are read and
//! everything is computed anew.
//!
//! For that to end with a small part, nobody may look further than he must, and what he finds may not depend on what
//! he tried on the way:
//!
//! - A triangle is one of the whole triangulation if and only if no site of the whole lies inside its circumcircle.
//!   So of each triangle that counts, the last look into its circle has to find all of it here (`walk`, `tiles`):
//!   circles that hold a site that *is* here are rejected without asking for others.
//! - Of sites on one circle there are several triangulations. Whoever comes upon an on-circle site takes the tiles'
//!   fan, whose apex is the first of all sites on the circle; these are all here, because the closed circle was
//!   looked into. Sites at one place are one site, the highest, and they share a cell.
//! - Triangles are proven one by one, so it does not matter which were tried before, nor on which thread; they are
//!   read from their first corner, and those of a tile stand in the order of their sites: the same products, sums
//!   and draws follow.
//! - Which triangles lie over a place: see `tiles::of_part`. Which vertices a photo shows: those of the blocks whose
//!   box, as high as all of the cloud, the photo may see.
//!
//! What needs all of a cloud (its mesh, the median of all heights under a photo that shows no vertex) says so, too.

use std::collections::BTreeSet;

use glam::DVec3;

use super::hull::hull_of_points;
use super::sites::place::site_place;
use super::sites::{BLOCK, Cells, Grid, Sites};
use super::{Shape, Surface, SurfaceError, SurfaceOptions, Whole, magnitude_of};
use crate::geometry::{Bounds, LocalFrame};

/// What of a whole cloud is known before its points are in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct CloudFacts {
    /// How many points it has.
    pub count: u64,
    /// Around all of them, in the world.
    pub bounds: Bounds,
    /// Some thousand of them from all over the cloud, in the world.
    pub sample: Vec<DVec3>,
}

impl CloudFacts {
    /// Every so many points of a file, from the first on, one is in the sample of its cloud.
    pub fn sample_stride(count: u64) -> u64 {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        super::sites::sample_stride(count) as u64
    }
}

/// The convex hull over (x, y) of points that come in portions.
#[derive(Debug, Clone)]
pub struct HullOfMany {
    frame: LocalFrame,
    /// In the frame.
    hull: Vec<DVec3>,
}

impl HullOfMany {
    /// Of a cloud with this box around it.
    pub fn new(bounds: &Bounds) -> Self {
        Self {
            frame: LocalFrame::near(bounds),
            hull: Vec::new(),
        }
    }

    /// Those of these points (world) that may be corners, in the local frame: to be told to [`Self::take`].
    pub fn corners_of(&self, points: &[DVec3]) -> Vec<DVec3> {
        let local = points.iter().map(|&p| self.frame.local_from_world(p));
        hull_of_points(&local.collect::<Vec<DVec3>>())
    }

    /// Takes the corners of a portion.
    pub fn take(&mut self, corners: &[DVec3]) {
        self.hull.extend(corners);
        self.hull = hull_of_points(&self.hull);
    }

    /// Whether a box (world) lies inside of the hull, clear of its edges: nothing in it is a corner.
    pub fn encloses(&self, bounds: &Bounds) -> bool {
        let (low, high) = (
            self.frame.local_from_world(bounds.min),
            self.frame.local_from_world(bounds.max),
        );
        let room = (high - low).truncate().length() * 1e-9 + 1e-9;
        let corners = [
            (low.x, low.y),
            (high.x, low.y),
            (high.x, high.y),
            (low.x, high.y),
        ];
        let next = self.hull.iter().cycle().skip(1);
        self.hull.len() > 2
            && self.hull.iter().zip(next).all(|(a, b)| {
                let way = (b - a).truncate();
                let least = room * way.length();
                let beside = |&(x, y): &(f64, f64)| {
                    way.perp_dot(glam::DVec2::new(x, y) - a.truncate()) > least
                };
                corners.iter().all(beside)
            })
    }

    /// Whether the frame that it counts in is that of a cloud with this box.
    pub fn is_of(&self, bounds: &Bounds) -> bool {
        self.frame == LocalFrame::near(bounds)
    }
}

/// Where the blocks of a cloud lie that a part of it can hold.
#[derive(Debug, Clone)]
pub struct PartPlan {
    facts: CloudFacts,
    frame: LocalFrame,
    magnitude: f64,
    /// In the frame.
    bounds: Bounds,
    grid: Grid,
    hull: Vec<DVec3>,
}

impl PartPlan {
    /// Of a cloud.
    ///
    /// # Errors
    /// Where its coordinates are beyond what can be computed with.
    pub fn new(facts: CloudFacts, hull: &HullOfMany) -> Result<Self, SurfaceError> {
        let magnitude = magnitude_of(&facts.bounds)?;
        let frame = LocalFrame::near(&facts.bounds);
        let (bounds, grid) = local_grid(&facts, &frame);
        Ok(Self {
            facts,
            frame,
            magnitude,
            bounds,
            grid,
            hull: hull.hull.clone(),
        })
    }

    /// What is known of the whole.
    pub fn facts(&self) -> &CloudFacts {
        &self.facts
    }

    /// How many blocks there are.
    pub fn block_count(&self) -> usize {
        self.block_columns() * self.grid.rows.div_ceil(BLOCK)
    }

    /// How many of them are in a row.
    pub fn block_columns(&self) -> usize {
        self.grid.columns.div_ceil(BLOCK)
    }

    /// The block that a point (world) lies in.
    pub fn block_of(&self, point: DVec3) -> usize {
        let site = site_place(self.frame.local_from_world(point));
        let (row, column) = (self.grid.row(site.y), self.grid.column(site.x));
        row / BLOCK * self.block_columns() + column / BLOCK
    }

    /// The box (world) over a block, as high as the cloud; at the border it reaches to the last point.
    pub fn bounds_of(&self, block: usize) -> Bounds {
        let block_columns = self.block_columns();
        let (row, column) = (block / block_columns, block % block_columns);
        let ends = |block: usize, count: usize, origin: f64, least: f64, most: f64| {
            let at = |cell: usize| origin + self.grid.cell * cell as f64;
            let low = if block == 0 { least } else { at(block * BLOCK) };
            let high = match (block + 1) * BLOCK {
                end if end >= count => most,
                end => at(end),
            };
            // A cell that is rounded up belongs to what lies next to it.
            let room = self.grid.cell * 1e-6;
            (low - room, high + room)
        };
        let (min, max, grid) = (self.bounds.min, self.bounds.max, &self.grid);
        let x = ends(column, grid.columns, grid.min.x, min.x, max.x);
        let y = ends(row, grid.rows, grid.min.y, min.y, max.y);
        Bounds {
            min: self.frame.world_from_local(DVec3::new(x.0, y.0, min.z)),
            max: self.frame.world_from_local(DVec3::new(x.1, y.1, max.z)),
        }
    }

    /// The blocks whose boxes `misses` does not miss, and those next to them.
    pub fn blocks_around(&self, misses: impl Fn(&Bounds) -> bool) -> BTreeSet<usize> {
        let (columns, rows) = (self.block_columns(), self.grid.rows.div_ceil(BLOCK));
        let mut found = BTreeSet::new();
        for block in 0..self.block_count() {
            if misses(&self.bounds_of(block)) {
                continue;
            }
            let (row, column) = (block / columns, block % columns);
            for row in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
                for column in column.saturating_sub(1)..=(column + 1).min(columns - 1) {
                    found.insert(row * columns + column);
                }
            }
        }
        found
    }

    /// The part of the surface that holds these blocks; `points` (world) are all points of theirs, in the order of
    /// the file, and no others.
    ///
    /// # Errors
    /// As [`Surface::with_options`]; thinning is not for parts.
    pub fn surface(
        &self,
        points: &[DVec3],
        blocks: &BTreeSet<usize>,
        max_edge: Option<f64>,
    ) -> Result<Surface, SurfaceError> {
        let options = SurfaceOptions {
            max_edge,
            thinning: None,
        };
        options.validate()?;
        let local = points
            .iter()
            .map(|&point| self.frame.local_from_world(point));
        let (hull, bounds) = (self.hull.clone(), self.bounds);
        let sites = Sites::of_part(local.collect(), blocks, hull, bounds, self.grid)?;
        let shape = Shape::Cloud(sites);
        let whole = Whole::new(self.frame, self.magnitude, shape, &self.facts.sample);
        Ok(Surface {
            whole: std::sync::Arc::new(whole),
            max_edge: max_edge.unwrap_or(f64::INFINITY),
        })
    }
}

/// The box around all sites in their frame, and their grid.
pub(super) fn local_grid(facts: &CloudFacts, frame: &LocalFrame) -> (Bounds, Grid) {
    let sample = facts.sample.iter();
    let sample: Vec<DVec3> = sample
        .map(|&point| site_place(frame.local_from_world(point)))
        .collect();
    let bounds = Bounds {
        min: frame.local_from_world(facts.bounds.min),
        max: frame.local_from_world(facts.bounds.max),
    };
    let count = usize::try_from(facts.count).unwrap_or(usize::MAX);
    (bounds, Grid::over(&sample, count))
}

/// Says that the sites are needed that lie in boxes (world) which `misses` does not miss.
pub(super) fn want_seen(sites: &Sites, frame: &LocalFrame, misses: impl Fn(&Bounds) -> bool) {
    let (columns, rows) = sites.grid_size();
    let heights = (sites.bounds().min.z, sites.bounds().max.z);
    for row in (0..rows).step_by(BLOCK) {
        for column in (0..columns).step_by(BLOCK) {
            let cells = Cells {
                columns: column..(column + BLOCK).min(columns),
                rows: row..(row + BLOCK).min(rows),
            };
            let local = sites.bounds_between(&cells, heights);
            let bounds = Bounds {
                min: frame.world_from_local(local.min),
                max: frame.world_from_local(local.max),
            };
            if !misses(&bounds) {
                sites.want(&cells);
            }
        }
    }
}

#[cfg(test)]
mod tests;
