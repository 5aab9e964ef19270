//! How far the triangles of a tile may reach, before any of them is made: so that nobody makes those
//! that he cannot see.
//!
//! Where sites lie all around a place, the triangles over it are small. Take squares of [`SIDE`] cells
//! and a place in one of them whose neighbours, three to each side, all hold sites: a *closed* square. A
//! triangle over the place has an empty circle around it that holds the place. Were its radius √2 squares
//! or more, it would hold a circle of that radius within 2.83 squares of the place, and in that a whole
//! square, which is not empty. So it is smaller, and the triangle's corners lie within 2.83 squares, in
//! the three squares to each side. Over other places (at the rim of the cloud, around a hole) triangles of
//! any tile near such places may lie.

use crate::geometry::Bounds;
use crate::surface::sites::{Cells, Sites};

/// Cells along the sides of a square: about 32 sites, so that hardly one in a dense cloud is empty.
const SIDE: usize = 4;

/// Squares around a closed one that hold sites.
const AROUND: usize = 3;

/// How far triangles may reach.
#[derive(Debug)]
pub(super) struct Reach {
    /// Of each tile: around its triangles over closed squares.
    pub(super) over_closed: Vec<Bounds>,
    /// Of each tile: whether it may have triangles over other places.
    pub(super) is_open: Vec<bool>,
    /// Around these places: rows of squares that are not closed.
    pub(super) open: Vec<Bounds>,
}

/// The squares.
struct Squares {
    columns: usize,
    rows: usize,
    closed: Vec<bool>,
}

impl Squares {
    fn new(sites: &Sites) -> Self {
        let (columns, rows) = sites.grid_size();
        let (columns, rows) = (columns.div_ceil(SIDE), rows.div_ceil(SIDE));
        let all = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let holds_sites: Vec<bool> = all
            .clone()
            .map(|(column, row)| {
                // Those at the border have no end: what lies in them may be anywhere.
                let is_inside = column > 0 && row > 0 && column + 1 < columns && row + 1 < rows;
                is_inside
                    && !sites
                        .ranges_of(&cells(column, row, sites))
                        .all(|r| r.is_empty())
            })
            .collect();
        let is_closed = |(column, row): (usize, usize)| {
            column >= AROUND
                && row >= AROUND
                && column + AROUND < columns
                && row + AROUND < rows
                && (row - AROUND..=row + AROUND).all(|row| {
                    let from = row * columns + column - AROUND;
                    holds_sites[from..=from + 2 * AROUND]
                        .iter()
                        .all(|&holds| holds)
                })
        };
        Self {
            columns,
            rows,
            closed: all.map(is_closed).collect(),
        }
    }
}

/// The cells of a square.
fn cells(column: usize, row: usize, sites: &Sites) -> Cells {
    let (columns, rows) = sites.grid_size();
    Cells {
        columns: column * SIDE..((column + 1) * SIDE).min(columns),
        rows: row * SIDE..((row + 1) * SIDE).min(rows),
    }
}

impl Reach {
    /// Of tiles that are these blocks of cells.
    pub(super) fn new<'a>(sites: &Sites, tiles: impl Iterator<Item = &'a Cells>) -> Self {
        let squares = Squares::new(sites);
        let (mut over_closed, mut is_open) = (Vec::new(), Vec::new());
        for tile in tiles {
            let columns = tile.columns.start / SIDE..tile.columns.end.div_ceil(SIDE);
            let mut rows = tile.rows.start / SIDE..tile.rows.end.div_ceil(SIDE);
            let row_is_closed = |row: usize| {
                let first = row * squares.columns;
                squares.closed[first + columns.start..first + columns.end]
                    .iter()
                    .all(|&closed| closed)
            };
            is_open.push(!rows.all(row_is_closed));
            // A triangle over a closed place has all corners in one circle smaller than three squares, one
            // of them in the tile: so neither the place nor a corner lies further out. (Tiles are made of
            // whole squares.)
            let around = sites.widened(tile, AROUND * SIDE);
            over_closed.push(sites.bounds_between(&around, sites.heights_in(&around)));
        }
        let mut open = Vec::new();
        // Their triangles may have corners anywhere.
        let all_heights = (sites.bounds().min.z, sites.bounds().max.z);
        for row in 0..squares.rows {
            let mut column = 0;
            while column < squares.columns {
                let is_closed = |column: usize| squares.closed[row * squares.columns + column];
                if is_closed(column) {
                    column += 1;
                    continue;
                }
                let first = column;
                while column < squares.columns && !is_closed(column) {
                    column += 1;
                }
                let from = cells(first, row, sites);
                let to = cells(column - 1, row, sites);
                let run = Cells {
                    columns: from.columns.start..to.columns.end,
                    rows: from.rows,
                };
                open.push(sites.bounds_between(&run, all_heights));
            }
        }
        Self {
            over_closed,
            is_open,
            open,
        }
    }
}

impl Sites {
    /// The lowest and the highest site in a block of cells; of none the heights of all.
    fn heights_in(&self, cells: &Cells) -> (f64, f64) {
        let points = self.points();
        let heights = self.ranges_of(cells).flat_map(|range| &points[range]);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), site| {
            (low.min(site.z), high.max(site.z))
        });
        match low <= high {
            true => (low, high),
            false => (self.bounds().min.z, self.bounds().max.z),
        }
    }

    /// The box over a block of cells between two heights; at the border it reaches to the last site.
    fn bounds_between(&self, cells: &Cells, (low, high): (f64, f64)) -> Bounds {
        let (min, max) = self.corners_of(cells);
        let all = self.bounds();
        let clamp = |place: glam::DVec2| place.clamp(all.min.truncate(), all.max.truncate());
        Bounds {
            min: clamp(min).extend(low),
            max: clamp(max).extend(high),
        }
    }
}
