//! Which sites of a cloud are here, where only a part of it is, and which others somebody asked for.
//!
//! A part has the grid of the whole, and its sites stand in the order that they have in the whole: what reads
//! only cells whose sites are here reads what it would read of the whole. Whoever needs a cell that is not here
//! says so with `want`, and what it computes then does not count: it is computed anew when the cells are here.
//! So an answer of a part of which nothing was wanted is that of the whole, to the last bit.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::Cells;
use super::grid::Grid;

/// Cells along the sides of a block: sites are here or not by whole blocks.
pub(in crate::surface) const BLOCK: usize = 64;

/// What was asked for and is not here.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Wanted {
    /// Blocks, by their numbers.
    pub blocks: BTreeSet<usize>,
    /// What needs all of the cloud, in words.
    pub all: Option<&'static str>,
}

impl Wanted {
    /// Whether nothing was.
    pub fn is_nothing(&self) -> bool {
        self.blocks.is_empty() && self.all.is_none()
    }
}

/// Neighbouring cells of one row with sites here.
#[derive(Debug, Clone)]
struct Run {
    columns: Range<usize>,
    /// The place of its first cell among all cells that are here, row by row.
    first: usize,
}

/// Which cells' sites are here.
#[derive(Debug)]
pub(in crate::surface) struct Held {
    /// How many columns of blocks there are.
    block_columns: usize,
    /// Of each block, row by row.
    is_held: Vec<bool>,
    runs: Vec<Run>,
    /// Where in `runs` those of each row begin, and after the last row how many there are.
    of_row: Vec<usize>,
    /// How many cells are here.
    cells: usize,
    wanted: Mutex<Wanted>,
}

impl Held {
    /// These blocks are here, and of other cells (row, column) single sites.
    pub(in crate::surface) fn new(
        grid: &Grid,
        blocks: &BTreeSet<usize>,
        single: &BTreeSet<(usize, usize)>,
    ) -> Self {
        let (block_columns, block_rows) = (grid.columns.div_ceil(BLOCK), grid.rows.div_ceil(BLOCK));
        let mut is_held = vec![false; block_columns * block_rows];
        for &block in blocks {
            if let Some(is_held) = is_held.get_mut(block) {
                *is_held = true;
            }
        }
        let (mut runs, mut of_row, mut cells) = (Vec::new(), Vec::with_capacity(grid.rows + 1), 0);
        for row in 0..grid.rows {
            of_row.push(runs.len());
            let first_block = row / BLOCK * block_columns;
            let of_blocks = (0..block_columns).filter(|column| is_held[first_block + column]);
            let of_blocks =
                of_blocks.map(|column| column * BLOCK..((column + 1) * BLOCK).min(grid.columns));
            let others = single
                .range((row, 0)..(row + 1, 0))
                .map(|&(_, column)| column..column + 1);
            let mut columns: Vec<Range<usize>> = of_blocks.chain(others).collect();
            columns.sort_unstable_by_key(|columns| columns.start);
            for columns in columns {
                let first = cells;
                cells += columns.len();
                runs.push(Run { columns, first });
            }
        }
        of_row.push(runs.len());
        Self {
            block_columns,
            is_held,
            runs,
            of_row,
            cells,
            wanted: Mutex::default(),
        }
    }

    /// How many cells are here.
    pub(super) fn cell_count(&self) -> usize {
        self.cells
    }

    /// The place of a cell among those that are here; where it is not, that of the next one.
    pub(super) fn place(&self, row: usize, column: usize) -> usize {
        let (from, to) = (self.of_row[row], self.of_row[row + 1]);
        let runs = &self.runs[from..to];
        let next = from + runs.partition_point(|run| run.columns.end <= column);
        match self.runs.get(next) {
            Some(run) if next < to => run.first + column.saturating_sub(run.columns.start),
            Some(run) => run.first,
            None => self.cells,
        }
    }

    /// Says that the sites of a block of cells are needed, where they are not here; whether all are.
    pub(super) fn want(&self, cells: &Cells) -> bool {
        if cells.columns.is_empty() || cells.rows.is_empty() {
            return true;
        }
        let mut has_all = true;
        let rows = cells.rows.start / BLOCK..cells.rows.end.div_ceil(BLOCK);
        for row in rows {
            let first = row * self.block_columns;
            let columns = cells.columns.start / BLOCK..cells.columns.end.div_ceil(BLOCK);
            let missing: Vec<usize> = columns
                .map(|column| first + column)
                .filter(|&block| self.is_held.get(block) == Some(&false))
                .collect();
            if !missing.is_empty() {
                self.locked().blocks.extend(missing);
                has_all = false;
            }
        }
        has_all
    }

    /// Says that all sites are needed, and for what.
    pub(super) fn want_all(&self, why: &'static str) {
        self.locked().all.get_or_insert(why);
    }

    /// What was needed and is not here.
    pub(super) fn wanted(&self) -> Wanted {
        self.locked().clone()
    }

    fn locked(&self) -> std::sync::MutexGuard<'_, Wanted> {
        // Of a set nothing can be left half-done.
        self.wanted.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
