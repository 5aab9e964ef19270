//! The vertices of a triangulated cloud, sorted into a grid over (x, y).
//!
//! The grid answers two questions that a local Delaunay triangulation asks: which sites lie near a
//! ray's trace, and does any site lie inside this circle. Building it is a counting sort, a fiftieth
//! of the cost of triangulating everything.
//!
//! Of a cloud that is larger than the memory only a part of the sites is here (`held`).

mod grid;
mod held;
pub(super) mod place;

use std::collections::BTreeSet;
use std::ops::Range;

use glam::{DVec2, DVec3};

pub(super) use self::grid::{Grid, sample_stride};
pub use self::held::Wanted;
pub(super) use self::held::{BLOCK, Held};
use self::place::site_place;
use super::SurfaceError;

use super::hull::{convex_hull, is_line};
use crate::geometry::Bounds;

/// The sites, one for each (x, y), in the local frame of their surface.
#[derive(Debug)]
pub(super) struct Sites {
    /// Grouped by cell, row by row.
    points: Vec<DVec3>,
    /// Of each point, or empty.
    colors: Vec<[u8; 3]>,
    /// Around `points`.
    bounds: Bounds,
    /// The corners of their convex hull over (x, y), counter-clockwise.
    hull: Vec<DVec3>,
    /// The same as indices, in any order.
    hull_indices: Vec<u32>,
    grid: Grid,
    /// Where each cell's points begin, and after the last cell the number of points; of a part the cells that are
    /// here.
    starts: Vec<u32>,
    /// Of a part of the sites: which cells are here.
    part: Option<Held>,
}

/// A block of cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Cells {
    /// Along x.
    pub(super) columns: Range<usize>,
    /// Along y.
    pub(super) rows: Range<usize>,
}

impl Sites {
    /// Sorts points (local frame, all finite) into cells; of points with the same (x, y) the
    /// highest stays, of equally high ones the first. Each takes its colour along, where there are
    /// any.
    ///
    /// # Errors
    /// With fewer than three different (x, y), all on one line, or more points than u32 counts.
    pub(super) fn new(points: Vec<DVec3>, colors: &[[u8; 3]]) -> Result<Self, SurfaceError> {
        let bounds = Bounds::of(&points).ok_or(SurfaceError::TooFewPoints(0))?;
        let sample: Vec<DVec3> = (points.iter().step_by(sample_stride(points.len())))
            .map(|&point| site_place(point))
            .collect();
        let grid = Grid::over(&sample, points.len());
        Self::over(points, colors, bounds, grid)
    }

    /// The same in a grid that is laid already; `bounds` are around all points.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn over(
        points: Vec<DVec3>,
        colors: &[[u8; 3]],
        bounds: Bounds,
        grid: Grid,
    ) -> Result<Self, SurfaceError> {
        let cell_of = |p: &DVec3| grid.row(p.y) * grid.columns + grid.column(p.x);
        let sorted = Sorted::new(points, colors, grid.columns * grid.rows, cell_of)?;
        if sorted.points.len() < 3 {
            return Err(SurfaceError::TooFewPoints(sorted.points.len()));
        }
        let hull = convex_hull(&sorted.points);
        Self::of(sorted, hull, bounds, grid, None)
    }

    /// A part of the sites: those of some blocks of cells, whose points are all in `points` (local frame, in the
    /// order of the file), and the corners of the hull of all. `bounds` are around all.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn of_part(
        mut points: Vec<DVec3>,
        blocks: &BTreeSet<usize>,
        hull: Vec<DVec3>,
        bounds: Bounds,
        grid: Grid,
    ) -> Result<Self, SurfaceError> {
        let block_columns = grid.columns.div_ceil(BLOCK);
        let cell = |p: &DVec3| (grid.row(p.y), grid.column(p.x));
        let is_beside = |&(row, column): &(usize, usize)| {
            !blocks.contains(&(row / BLOCK * block_columns + column / BLOCK))
        };
        let beside = hull.iter().filter(|corner| is_beside(&cell(corner)));
        let single: BTreeSet<(usize, usize)> = beside.clone().map(cell).collect();
        points.extend(beside.copied());
        let held = Held::new(&grid, blocks, &single);
        let place = |p: &DVec3| {
            let (row, column) = cell(p);
            held.place(row, column)
        };
        let sorted = Sorted::new(points, &[], held.cell_count(), place)?;
        Self::of(sorted, hull, bounds, grid, Some(held))
    }

    fn of(
        sorted: Sorted,
        hull: Vec<DVec3>,
        bounds: Bounds,
        grid: Grid,
        part: Option<Held>,
    ) -> Result<Self, SurfaceError> {
        if is_line(&hull) {
            return Err(SurfaceError::OnOneLine);
        }
        let Sorted {
            points,
            colors,
            starts,
        } = sorted;
        let mut sites = Self {
            points,
            colors,
            bounds,
            hull,
            hull_indices: Vec::new(),
            grid,
            starts,
            part,
        };
        let of_hull = sites
            .hull
            .iter()
            .filter_map(|corner| sites.index_of(*corner));
        sites.hull_indices = of_hull.collect();
        Ok(sites)
    }

    /// The index of the site at a point of `points`.
    fn index_of(&self, point: DVec3) -> Option<u32> {
        let (row, column) = (self.grid.row(point.y), self.grid.column(point.x));
        let range = self.start(row, column)..self.start(row, column + 1);
        let place = range.into_iter().find(|&index| self.points[index] == point);
        u32::try_from(place?).ok()
    }

    /// Where the sites of a cell begin; one column beyond the last, where those of its row end.
    fn start(&self, row: usize, column: usize) -> usize {
        let place = match &self.part {
            None => row * self.grid.columns + column,
            Some(held) => held.place(row, column),
        };
        self.starts[place] as usize
    }

    /// Whether only a part of the sites is here.
    pub(super) fn is_part(&self) -> bool {
        self.part.is_some()
    }

    /// What was needed and is not here; of all sites nothing.
    pub(super) fn wanted(&self) -> Wanted {
        self.part.as_ref().map(Held::wanted).unwrap_or_default()
    }

    /// Says that the sites of a block of cells are needed; whether all are here. Where they are not, nothing that
    /// follows from them counts, and triangles over what is missing would ask for far too much.
    pub(super) fn want(&self, cells: &Cells) -> bool {
        self.part.as_ref().is_none_or(|held| held.want(cells))
    }

    /// The same of the cells that a segment passes.
    pub(super) fn want_along(&self, from: DVec2, to: DVec2) -> bool {
        if self.part.is_none() {
            return true;
        }
        let mut has_all = true;
        for cell in self.cells_along(from, to) {
            let (row, column) = (cell / self.grid.columns, cell % self.grid.columns);
            let cells = Cells {
                columns: column..column + 1,
                rows: row..row + 1,
            };
            has_all &= self.want(&cells);
        }
        has_all
    }

    /// Says that all sites are needed, and for what.
    pub(super) fn want_all(&self, why: &'static str) {
        if let Some(held) = &self.part {
            held.want_all(why);
        }
    }

    /// Says that the sites of all cells that a disc touches are needed.
    pub(super) fn want_disc(&self, center: DVec2, radius: f64) {
        if self.part.is_some() {
            self.rows_near(center, radius, |row, columns| {
                self.want(&Cells {
                    columns: columns.0..columns.1 + 1,
                    rows: row..row + 1,
                });
            });
        }
    }

    /// All sites, grouped by cell.
    pub(super) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The colour of each site, in the order of [`Self::points`]; empty where there are none.
    pub(super) fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The box around the sites.
    pub(super) fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The corners of the convex hull over (x, y), counter-clockwise.
    pub(super) fn hull(&self) -> &[DVec3] {
        &self.hull
    }

    /// The indices of these corners, in any order.
    pub(super) fn hull_indices(&self) -> &[u32] {
        &self.hull_indices
    }

    /// The row and the column of the cell at a place.
    pub(super) fn cell_at(&self, place: DVec2) -> (usize, usize) {
        (self.grid.row(place.y), self.grid.column(place.x))
    }

    /// How many columns and rows of cells there are.
    pub(super) fn grid_size(&self) -> (usize, usize) {
        (self.grid.columns, self.grid.rows)
    }

    /// The indices of the sites in a block of cells: a range for each of its rows.
    pub(super) fn ranges_of(&self, cells: &Cells) -> impl Iterator<Item = Range<usize>> {
        let columns = cells.columns.clone();
        cells
            .rows
            .clone()
            .map(move |row| self.start(row, columns.start)..self.start(row, columns.end))
    }

    /// A block with so many cells around it, as far as there are any.
    pub(super) fn widened(&self, cells: &Cells, by: usize) -> Cells {
        let wider = |range: &Range<usize>, count: usize| {
            range.start.saturating_sub(by)..(range.end + by).min(count)
        };
        Cells {
            columns: wider(&cells.columns, self.grid.columns),
            rows: wider(&cells.rows, self.grid.rows),
        }
    }

    /// Whether a disc lies within a block of cells, of which those at the border have no end.
    pub(super) fn holds_disc(&self, cells: &Cells, center: DVec2, radius: f64) -> bool {
        let grid = &self.grid;
        let holds = |range: &Range<usize>, count: usize, min: f64, center: f64| {
            let at = |cell: usize| min + grid.cell * cell as f64;
            (range.start == 0 || center - radius > at(range.start))
                && (range.end == count || center + radius < at(range.end))
        };
        holds(&cells.columns, grid.columns, grid.min.x, center.x)
            && holds(&cells.rows, grid.rows, grid.min.y, center.y)
    }

    /// The places in (x, y) of a block's first and last corner; without end where it is at the border.
    pub(super) fn corners_of(&self, cells: &Cells) -> (DVec2, DVec2) {
        let grid = &self.grid;
        let ends = |range: &Range<usize>, count: usize, min: f64| {
            let at = |cell: usize| min + grid.cell * cell as f64;
            (
                if range.start == 0 {
                    f64::NEG_INFINITY
                } else {
                    at(range.start)
                },
                if range.end == count {
                    f64::INFINITY
                } else {
                    at(range.end)
                },
            )
        };
        let (x, y) = (
            ends(&cells.columns, grid.columns, grid.min.x),
            ends(&cells.rows, grid.rows, grid.min.y),
        );
        (DVec2::new(x.0, y.0), DVec2::new(x.1, y.1))
    }

    /// The sites of one cell, counted row by row.
    pub(super) fn in_cell(&self, cell: usize) -> &[DVec3] {
        let (row, column) = (cell / self.grid.columns, cell % self.grid.columns);
        &self.points[self.start(row, column)..self.start(row, column + 1)]
    }

    /// The cells that a segment in (x, y) passes and their neighbours; now and then one twice.
    pub(super) fn cells_along(&self, from: DVec2, to: DVec2) -> Vec<usize> {
        let grid = &self.grid;
        // Half a cell a step misses no cell by more than a neighbour. A trace far longer than the
        // grid is sampled more coarsely: these cells are a beginning, not the whole answer.
        let most = 4 * (grid.columns + grid.rows);
        let steps = (((to - from).length() / grid.cell * 2.0) as usize).min(most) + 1;
        let mut cells = Vec::new();
        let mut last = None;
        for step in 0..=steps {
            let at = from.lerp(to, step as f64 / steps as f64);
            let (column, row) = (grid.column(at.x), grid.row(at.y));
            if last == Some((column, row)) {
                continue;
            }
            last = Some((column, row));
            for row in row.saturating_sub(1)..=(row + 1).min(grid.rows - 1) {
                for column in column.saturating_sub(1)..=(column + 1).min(grid.columns - 1) {
                    cells.push(row * grid.columns + column);
                }
            }
        }
        cells
    }

    /// Calls `visit` with every site in the cells that a disc touches, and its index.
    pub(super) fn near_disc(&self, center: DVec2, radius: f64, mut visit: impl FnMut(u32, &DVec3)) {
        self.rows_near(center, radius, |row, columns| {
            let from = self.start(row, columns.0);
            let to = self.start(row, columns.1 + 1);
            for (index, point) in (from as u32..).zip(&self.points[from..to]) {
                visit(index, point);
            }
        });
    }

    /// Calls `visit` with each row of cells that a disc touches, and the first and last of its columns there.
    fn rows_near(&self, center: DVec2, radius: f64, mut visit: impl FnMut(usize, (usize, usize))) {
        let grid = &self.grid;
        // Room for the rounding of huge circles, whose middle is far away.
        let radius = radius * (1.0 + 1e-9);
        let rows = grid.row(center.y - radius)..=grid.row(center.y + radius);
        for row in rows {
            let dy = grid.distance_to_row(center.y, row);
            let half = if radius.is_finite() && center.is_finite() {
                (radius * radius - dy * dy).max(0.0).sqrt() + radius * 1e-9
            } else {
                f64::INFINITY
            };
            let columns = match half {
                f64::INFINITY => (0, grid.columns - 1),
                half => (grid.column(center.x - half), grid.column(center.x + half)),
            };
            visit(row, columns);
        }
    }
}

/// Points grouped by cell, one for each (x, y).
struct Sorted {
    points: Vec<DVec3>,
    colors: Vec<[u8; 3]>,
    /// Where each cell's points begin, and after the last cell the number of points.
    starts: Vec<u32>,
}

impl Sorted {
    /// Of points with the same (x, y) the highest stays, of equally high ones the first. `cell_of` counts the
    /// `cells` from 0.
    ///
    /// # Errors
    /// With more points than u32 counts.
    fn new(
        mut points: Vec<DVec3>,
        colors: &[[u8; 3]],
        cells: usize,
        cell_of: impl Fn(&DVec3) -> usize,
    ) -> Result<Self, SurfaceError> {
        if u32::try_from(points.len()).is_err() {
            return Err(SurfaceError::TooManyPoints(points.len()));
        }
        for point in &mut points {
            *point = site_place(*point);
        }
        // Counting sort.
        let mut starts = vec![0_u32; cells + 1];
        for point in &points {
            starts[cell_of(point) + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        // Freed before the points are sorted: there may be hundreds of millions.
        let mut next = starts.clone();
        let mut order = vec![0_u32; points.len()];
        for (index, point) in (0..).zip(&points) {
            let place = &mut next[cell_of(point)];
            order[*place as usize] = index;
            *place += 1;
        }
        drop(next);

        // Equal (x, y) share a cell: sort each cell, highest first, and keep the first of equals.
        let mut kept = 0;
        for cell in 0..starts.len() - 1 {
            let (from, to) = (starts[cell] as usize, starts[cell + 1] as usize);
            starts[cell] = kept as u32;
            order[from..to].sort_unstable_by(|&i, &j| {
                let (a, b) = (points[i as usize], points[j as usize]);
                (a.x.total_cmp(&b.x))
                    .then(a.y.total_cmp(&b.y))
                    .then(b.z.total_cmp(&a.z))
                    .then(i.cmp(&j))
            });
            let mut last = None;
            for i in from..to {
                let place = points[order[i] as usize].truncate();
                if last != Some(place) {
                    // `kept` <= i: what is overwritten has been looked at.
                    order[kept] = order[i];
                    kept += 1;
                }
                last = Some(place);
            }
        }
        if let Some(end) = starts.last_mut() {
            *end = kept as u32;
        }
        order.truncate(kept);
        let sorted: Vec<DVec3> = order.iter().map(|&i| points[i as usize]).collect();
        drop(points);
        let colors = match colors {
            [] => Vec::new(),
            colors => order.iter().map(|&i| colors[i as usize]).collect(),
        };
        Ok(Self {
            points: sorted,
            colors,
            starts,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_of_equal_places_stays() {
        let mut points = Vec::new();
        for i in 0..1000_u32 {
            let place = f64::from(i % 100);
            points.push(DVec3::new(
                place,
                (place * 7.0) % 13.0,
                f64::from(i * 37 % 1000),
            ));
        }
        let expected = |place: f64| {
            points
                .iter()
                .filter(|p| p.x == place)
                .fold(f64::NEG_INFINITY, |z, p| z.max(p.z))
        };
        let sites = Sites::new(points.clone(), &[]).unwrap();
        assert_eq!(sites.points().len(), 100);
        for site in sites.points() {
            assert_eq!(site.z, expected(site.x), "at {}", site.x);
        }
        let (columns, rows) = sites.grid_size();
        let cells = 0..columns * rows;
        let all: usize = cells.map(|cell| sites.in_cell(cell).len()).sum();
        assert_eq!(all, 100);
    }

    #[test]
    fn minus_zero_is_zero() {
        let points = [(0.0, 1.0), (-0.0, 2.0), (1e-300, 3.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
        assert!(matches!(
            Sites::new(points.to_vec(), &[]),
            Err(SurfaceError::TooFewPoints(1))
        ));
    }

    #[test]
    fn a_disc_finds_what_lies_in_it() {
        // An outlier far out, which must not spoil the grid.
        let mut points = vec![DVec3::new(1e6, -1e6, 0.0)];
        for i in 0..5000 {
            let angle = f64::from(i) * 2.4;
            points.push((DVec2::from_angle(angle) * (f64::from(i) * 0.01)).extend(0.0));
        }
        let sites = Sites::new(points.clone(), &[]).unwrap();
        for (center, radius) in [
            (DVec2::new(3.0, 4.0), 2.0),
            (DVec2::new(-60.0, 0.0), 30.0),
            (DVec2::new(0.0, 0.0), 0.001),
            (DVec2::new(1e6, -1e6), 5.0),
            (DVec2::new(0.0, 0.0), f64::INFINITY),
            (DVec2::new(1e12, 0.0), 1e12),
        ] {
            let inside = |p: &DVec3| p.truncate().distance(center) <= radius;
            let mut found = 0;
            sites.near_disc(center, radius, |_, p| found += usize::from(inside(p)));
            assert_eq!(
                found,
                points.iter().filter(|p| inside(p)).count(),
                "{center} {radius}"
            );
        }
    }
}
