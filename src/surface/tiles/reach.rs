//! How far the triangles of a tile may reach, before any of them is made: so that nobody makes those
//! that he cannot see.
//!
//! Where sites lie all around a place, the triangles over it are small. Take squares of [`SIDE`] cells
//! and a place in one of them whose neighbours, three to each side, all hold sites: a *closed* square. A
//! triangle over the place has an empty circle around it that holds the place. Were its radius √2 squares
//! or more, it would hold a circle of that radius within 2.83 squares of the place, and in that a whole
//! square, which is not empty. So it is smaller, and the triangle's corners lie within 2.83 squares, in
//! the three squares to each side.
//!
//! Over other, *open* places (at the rim of the cloud, around a hole) triangles may be large, but they do not
//! reach from one hole to another: take a triangle whose first corner lies in an open square and which covers
//! an open place elsewhere, and the line between the two, all of it under the triangle. Where the line passes a
//! closed square, the triangle lies over a closed place and is as small as said above. Else it passes open
//! squares only, so both are in one *field* of open squares that touch each other. So a tile's triangles lie over
//! its closed squares' surroundings, or over the fields that it has squares of.

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
    /// Of each tile: the fields of open squares that it may have triangles over.
    pub(super) fields: Vec<Vec<u32>>,
    /// Around these fields: each with boxes around rows of its squares.
    pub(super) open: Vec<(u32, Bounds)>,
    /// How many fields there are.
    pub(super) field_count: usize,
}

impl Reach {
    /// Which fields are seen where `misses` does not miss.
    pub(super) fn seen_fields(&self, misses: impl Fn(&Bounds) -> bool) -> Vec<bool> {
        let mut seen = vec![false; self.field_count];
        for (field, bounds) in &self.open {
            let seen = &mut seen[*field as usize];
            *seen = *seen || !misses(bounds);
        }
        seen
    }
}

/// The squares.
struct Squares {
    columns: usize,
    rows: usize,
    closed: Vec<bool>,
    /// Of each square that is not closed: its field.
    field: Vec<u32>,
    field_count: usize,
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
        let closed: Vec<bool> = all.map(is_closed).collect();
        let (field, field_count) = fields(&closed, columns, rows);
        Self {
            columns,
            rows,
            closed,
            field,
            field_count,
        }
    }
}

/// The field of each square that is not closed, and how many there are. Squares touch at corners, too.
fn fields(closed: &[bool], columns: usize, rows: usize) -> (Vec<u32>, usize) {
    const NONE: u32 = u32::MAX;
    let mut field = vec![NONE; closed.len()];
    let mut count = 0_u32;
    let mut waiting = Vec::new();
    for first in 0..closed.len() {
        if closed[first] || field[first] != NONE {
            continue;
        }
        field[first] = count;
        waiting.push(first);
        while let Some(square) = waiting.pop() {
            let (column, row) = (square % columns, square / columns);
            for row in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
                for column in column.saturating_sub(1)..=(column + 1).min(columns - 1) {
                    let next = row * columns + column;
                    if !closed[next] && field[next] == NONE {
                        field[next] = count;
                        waiting.push(next);
                    }
                }
            }
        }
        // Each field has a square, and of squares there are fewer.
        count += 1;
    }
    (field, count as usize)
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
        let (mut over_closed, mut fields) = (Vec::new(), Vec::new());
        for tile in tiles {
            let columns = tile.columns.start / SIDE..tile.columns.end.div_ceil(SIDE);
            let rows = tile.rows.start / SIDE..tile.rows.end.div_ceil(SIDE);
            let own = rows.flat_map(|row| {
                let first = row * squares.columns;
                first + columns.start..first + columns.end
            });
            let open = own.filter(|&square| !squares.closed[square]);
            let mut own_fields: Vec<u32> = open.map(|square| squares.field[square]).collect();
            own_fields.sort_unstable();
            own_fields.dedup();
            fields.push(own_fields);
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
                // A run of them touch each other.
                let field = squares.field[row * squares.columns + first];
                open.push((field, sites.bounds_between(&run, all_heights)));
            }
        }
        Self {
            over_closed,
            fields,
            open,
            field_count: squares.field_count,
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
    pub(in crate::surface) fn bounds_between(
        &self,
        cells: &Cells,
        (low, high): (f64, f64),
    ) -> Bounds {
        let (min, max) = self.corners_of(cells);
        let all = self.bounds();
        let clamp = |place: glam::DVec2| place.clamp(all.min.truncate(), all.max.truncate());
        Bounds {
            min: clamp(min).extend(low),
            max: clamp(max).extend(high),
        }
    }
}
