//! The grid that sites are sorted into: where its cells lie follows from a sample of the points and from how many
//! they are, so that a part of a cloud has the grid of the whole.

use glam::{DVec2, DVec3};

/// How many sites a cell holds on average: fewer cost memory, more cost time in every circle.
const SITES_PER_CELL: f64 = 2.0;

/// So many points of a cloud stand for all where its grid is laid, about.
const SAMPLE: usize = 4096;

/// Every so many points of a cloud one is in the sample that its grid is laid over, the first among them.
pub(in crate::surface) fn sample_stride(count: usize) -> usize {
    (count / SAMPLE).max(1)
}

/// A grid over the bulk of the cloud. Its border cells reach to infinity, so that a few points far
/// out do not make the cells of all others too wide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::surface) struct Grid {
    pub(in crate::surface) min: DVec2,
    pub(in crate::surface) cell: f64,
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
}

impl Grid {
    /// A grid for `count` points, of which every [`sample_stride`]th is in `sample`.
    pub(in crate::surface) fn over(sample: &[DVec3], count: usize) -> Self {
        // The range of all but the outermost 1 % on each side.
        let range = |coordinate: fn(&DVec3) -> f64| {
            let mut sample: Vec<f64> = sample.iter().map(coordinate).collect();
            sample.sort_unstable_by(f64::total_cmp);
            let outer = sample.len() / 100;
            match (sample.get(outer), sample.get(sample.len() - 1 - outer)) {
                (Some(&low), Some(&high)) => (low, high),
                _ => (0.0, 0.0),
            }
        };
        let (x, y) = (range(|p| p.x), range(|p| p.y));
        let (width, height) = (x.1 - x.0, y.1 - y.0);
        let cells = count as f64 / SITES_PER_CELL;
        let longest = width.max(height).max(f64::MIN_POSITIVE);
        // A cloud as narrow as a line still gets cells: along it.
        let area = width.max(longest / cells) * height.max(longest / cells);
        let cell = (area / cells).sqrt().max(longest / 30_000.0);
        let count = |length: f64| (length / cell).ceil().clamp(1.0, 30_000.0) as usize;
        Self {
            min: DVec2::new(x.0, y.0),
            cell,
            columns: count(width),
            rows: count(height),
        }
    }

    pub(in crate::surface) fn column(&self, x: f64) -> usize {
        // `as` saturates: what lies below the grid falls into cell 0.
        (((x - self.min.x) / self.cell) as usize).min(self.columns - 1)
    }

    pub(in crate::surface) fn row(&self, y: f64) -> usize {
        (((y - self.min.y) / self.cell) as usize).min(self.rows - 1)
    }

    /// The distance in y between `y` and a row of cells.
    pub(in crate::surface) fn distance_to_row(&self, y: f64, row: usize) -> f64 {
        let low = if row == 0 {
            f64::NEG_INFINITY
        } else {
            self.min.y + self.cell * row as f64
        };
        let high = if row + 1 == self.rows {
            f64::INFINITY
        } else {
            self.min.y + self.cell * (row + 1) as f64
        };
        (low - y).max(y - high).max(0.0)
    }
}
