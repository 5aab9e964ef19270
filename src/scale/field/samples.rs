//! Pixels on a grid over an image, with their rays, and which of them a triangle may lie under.

use std::ops::Range;

use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::scale::ImageKind;

/// Pixels at the middles of equal cells of an image: column i and row j are at
/// ((i + 0.5)·W / columns, (j + 0.5)·H / rows).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldGrid {
    /// Along the image's width, at least 1.
    pub columns: u32,
    /// Along its height, at least 1.
    pub rows: u32,
}

impl FieldGrid {
    /// The grid of the fit (contract, section 7): 64 columns, and as many rows as make cells square,
    /// halves rounded up, at least 2.
    pub fn of_fit(camera: &Camera) -> Self {
        let (w, h) = (u64::from(camera.width), u64::from(camera.height));
        // round(64 h / w), exactly.
        let rows = (128 * h + w) / (2 * w).max(1);
        Self {
            columns: 64,
            rows: u32::try_from(rows.max(2)).unwrap_or(u32::MAX),
        }
    }

    /// Every pixel.
    pub fn of_pixels(camera: &Camera) -> Self {
        Self {
            columns: camera.width.max(1),
            rows: camera.height.max(1),
        }
    }

    /// How many pixels it has.
    pub fn len(self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// Whether it has none.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// Its columns and rows, row by row.
    pub fn cells(self) -> impl Iterator<Item = (u32, u32)> {
        (0..self.rows).flat_map(move |row| (0..self.columns).map(move |column| (column, row)))
    }

    /// The pixel of the image at a column and a row.
    pub fn pixel(self, camera: &Camera, column: u32, row: u32) -> DVec2 {
        let at = |place: u32, size: u32, count: u32| {
            (f64::from(place) + 0.5) * f64::from(size) / f64::from(count)
        };
        DVec2::new(
            at(column, camera.width, self.columns),
            at(row, camera.height, self.rows),
        )
    }
}

/// Some rows of a grid, with the rays of their pixels as points (x, y) of the plane z = 1 in camera
/// axes.
pub(super) struct Samples {
    columns: u32,
    /// Of the grid.
    rows: Range<u32>,
    /// Row by row, NaN where a pixel has no ray forward.
    points: Vec<DVec2>,
    /// Row by row the boxes around the points of so many columns: see [`RUN`].
    runs: Vec<[DVec2; 2]>,
    /// Around all points; `None` where no pixel has a ray forward.
    pub(super) extent: Option<[DVec2; 2]>,
    layout: Layout,
}

/// Columns of a row that have a box around their points: a long thin triangle passes most of its own box by.
const RUN: u32 = 16;

enum Layout {
    /// Of an undistorted image: column and row are affine in the point.
    Affine { camera: Camera, grid: FieldGrid },
    /// Through a lens: bins over the plane that know which pixels' points they hold.
    Listed { bins: Bins },
    /// In one row, bin by bin.
    Scattered { bins: ScatteredBins },
}

impl Samples {
    /// Of some rows of a grid over an image of this kind.
    pub(super) fn new(
        camera: &Camera,
        image: ImageKind,
        grid: FieldGrid,
        rows: Range<u32>,
    ) -> Self {
        let pixels = rows
            .clone()
            .flat_map(|row| (0..grid.columns).map(move |column| grid.pixel(camera, column, row)));
        let (points, layout) = match image {
            ImageKind::Undistorted => {
                let point = |pixel| camera.direction_undistorted(pixel).truncate();
                let camera = camera.clone();
                (pixels.map(point).collect(), Layout::Affine { camera, grid })
            }
            ImageKind::AsShot => {
                let point = |pixel| match camera.direction_as_shot(pixel) {
                    Ok(direction) if direction.z > 0.0 => direction.truncate() / direction.z,
                    _ => DVec2::NAN,
                };
                let points: Vec<DVec2> = pixels.map(point).collect();
                let bins = Bins::new(&points, grid.columns);
                (points, Layout::Listed { bins })
            }
        };
        Self::of(points, grid.columns, rows, layout)
    }

    /// Of single rays, given as points of the plane, without a grid (NaN where there is none), and the
    /// order in which they stand in the one row.
    pub(super) fn scattered(points: &[DVec2]) -> (Self, Vec<usize>) {
        let (bins, order) = ScatteredBins::new(points);
        let sorted: Vec<DVec2> = order.iter().map(|&place| points[place]).collect();
        // No photo has four billion rays.
        let columns = u32::try_from(sorted.len()).unwrap_or(u32::MAX);
        let samples = Self::of(sorted, columns, 0..1, Layout::Scattered { bins });
        (samples, order)
    }

    fn of(points: Vec<DVec2>, columns: u32, rows: Range<u32>, layout: Layout) -> Self {
        let in_runs = points.chunks(columns.max(1) as usize);
        let runs: Vec<[DVec2; 2]> = in_runs
            .flat_map(|row| row.chunks(RUN as usize).map(around))
            .collect();
        let [min, max] = runs.iter().fold(NOTHING, |[min, max], run| {
            [min.min(run[0]), max.max(run[1])]
        });
        Self {
            columns,
            rows,
            points,
            runs,
            extent: (min.cmple(max).all()).then_some([min, max]),
            layout,
        }
    }

    /// How many pixels there are.
    pub(super) fn len(&self) -> usize {
        self.columns as usize * self.rows.len()
    }

    /// The place of a pixel among all, row by row.
    pub(super) fn place(&self, column: u32, row: u32) -> usize {
        (row - self.rows.start) as usize * self.columns as usize + column as usize
    }

    /// The point of a pixel's ray; NaN where it has none.
    pub(super) fn point(&self, column: u32, row: u32) -> DVec2 {
        self.points[self.place(column, row)]
    }

    /// Columns in runs, each with a box around its points in a row and those beside them; empty where none
    /// of them has a ray (then the least is above the greatest).
    pub(super) fn runs(
        &self,
        columns: Range<u32>,
        row: u32,
    ) -> impl Iterator<Item = (Range<u32>, [DVec2; 2])> {
        let in_row = self.columns.div_ceil(RUN);
        let first = (row - self.rows.start) * in_row;
        (columns.start / RUN..columns.end.div_ceil(RUN)).map(move |run| {
            let (start, end) = (
                (run * RUN).max(columns.start),
                (run * RUN + RUN).min(columns.end),
            );
            (start..end, self.runs[(first + run) as usize])
        })
    }

    /// All columns and rows.
    pub(super) fn all(&self) -> (Range<u32>, Range<u32>) {
        (0..self.columns, self.rows.clone())
    }

    /// Whether a pixel's point may lie within the box around these points.
    pub(super) fn any_near(&self, corners: &[DVec2]) -> bool {
        let (columns, rows) = self.near(corners);
        let Layout::Scattered { .. } = &self.layout else {
            return !columns.is_empty() && !rows.is_empty();
        };
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &corner in corners {
            (min, max) = (min.min(corner), max.max(corner));
        }
        // Room for rays that pass an edge by no more than rounding.
        let room = 1e-9 * (DVec2::ONE + min.abs().max(max.abs()));
        let (min, max) = (min - room, max + room);
        let mut near = self.points[columns.start as usize..columns.end as usize].iter();
        near.any(|point| point.cmpge(min).all() && point.cmple(max).all())
    }

    /// Columns and rows that hold every pixel whose point lies within the box around these points.
    pub(super) fn near(&self, corners: &[DVec2]) -> (Range<u32>, Range<u32>) {
        match &self.layout {
            Layout::Affine { camera, grid } => {
                let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
                let cells = DVec2::new(
                    f64::from(grid.columns) / f64::from(camera.width),
                    f64::from(grid.rows) / f64::from(camera.height),
                );
                for corner in corners {
                    // In front of the camera, so there is a pixel.
                    let pixel = camera.pixel_undistorted(corner.extend(1.0));
                    let at = pixel.unwrap_or(DVec2::NAN) * cells - 0.5;
                    (min, max) = (min.min(at), max.max(at));
                }
                // Those from `min` to `max`, with room for rounding. (`as` cuts towards 0, saturates, and
                // makes NaN 0; `ceil` and `floor` are calls.)
                let range = |min: f64, max: f64, all: &Range<u32>| {
                    let (min, max) = (min - 1e-6, max + 1e-6);
                    let cut = min as u32;
                    let from = cut.saturating_add(u32::from(f64::from(cut) < min));
                    let to = if max < 0.0 {
                        0
                    } else {
                        (max as u32).saturating_add(1)
                    };
                    from.max(all.start)..to.min(all.end)
                };
                (
                    range(min.x, max.x, &(0..self.columns)),
                    range(min.y, max.y, &self.rows),
                )
            }
            Layout::Listed { bins } => {
                let (columns, rows) = bins.near(corners);
                let first = self.rows.start;
                (columns, rows.start + first..rows.end + first)
            }
            Layout::Scattered { bins } => (bins.near(corners), self.rows.clone()),
        }
    }
}

/// Bins over the plane: even in x and y, or, where a wide lens puts its rim far out, in their angles.
struct BinGrid {
    is_wide: bool,
    min: DVec2,
    /// Bins a unit of the plane, or a radian.
    density: DVec2,
    size: [usize; 2],
}

/// Points further out than this are a wide lens's: 63 degrees beside the axis.
const WIDE: f64 = 2.0;

impl BinGrid {
    /// So many columns and rows of bins around all points that are finite.
    fn new(points: &[DVec2], size: [usize; 2]) -> Self {
        let seen = || points.iter().copied().filter(|point| point.is_finite());
        let is_wide = seen().any(|point| point.abs().max_element() > WIDE);
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for at in seen().map(|point| even(point, is_wide)) {
            (min, max) = (min.min(at), max.max(at));
        }
        let count = DVec2::new(size[0] as f64, size[1] as f64);
        let density = count / (max - min).max(DVec2::splat(1e-12));
        Self {
            is_wide,
            min,
            density,
            size,
        }
    }

    /// Where bins are even.
    fn even(&self, point: DVec2) -> DVec2 {
        even(point, self.is_wide)
    }

    /// The bin of an even place.
    fn bin(&self, even: DVec2) -> [usize; 2] {
        let at = (even - self.min) * self.density;
        // `as` saturates.
        [
            (at.x as usize).min(self.size[0] - 1),
            (at.y as usize).min(self.size[1] - 1),
        ]
    }

    /// The first and the last bin of the box around these points.
    fn around(&self, corners: &[DVec2]) -> ([usize; 2], [usize; 2]) {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &corner in corners {
            (min, max) = (min.min(corner), max.max(corner));
        }
        // Room for rounding.
        let room = DVec2::splat(1e-12);
        (
            self.bin(self.even(min) - room),
            self.bin(self.even(max) + room),
        )
    }
}

/// A point, or its angles.
fn even(point: DVec2, is_wide: bool) -> DVec2 {
    match is_wide {
        true => DVec2::new(point.x.atan(), point.y.atan()),
        false => point,
    }
}

/// Bins that know where in one row the points stand that they hold.
struct ScatteredBins {
    grid: BinGrid,
    /// Row by row the place of each bin's first point, and the count of all.
    starts: Vec<u32>,
}

impl ScatteredBins {
    /// With the order of the points, bin by bin; those that are not finite come last.
    fn new(points: &[DVec2]) -> (Self, Vec<usize>) {
        // About a point in each.
        let side = (points.len() as f64).sqrt().ceil().max(1.0) as usize;
        let grid = BinGrid::new(points, [side, side]);
        let bins: Vec<usize> = points
            .iter()
            .map(|&point| match point.is_finite() {
                true => {
                    let [x, y] = grid.bin(grid.even(point));
                    y * side + x
                }
                false => side * side,
            })
            .collect();
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by_key(|&place| bins[place]);
        let starts = (0..=side * side)
            .map(|bin| order.partition_point(|&place| bins[place] < bin))
            .map(|start| u32::try_from(start).unwrap_or(u32::MAX));
        let starts = starts.collect();
        (Self { grid, starts }, order)
    }

    /// The points of all bins from the first to the last of the box around the corners: more than those in
    /// the box where it has several rows of bins, which that of a triangle hardly has.
    fn near(&self, corners: &[DVec2]) -> Range<u32> {
        let ([x0, y0], [x1, y1]) = self.grid.around(corners);
        let columns = self.grid.size[0];
        self.starts[y0 * columns + x0]..self.starts[y1 * columns + x1 + 1]
    }
}

/// Bins, each with a box around the columns and rows of the pixels whose points it holds.
struct Bins {
    grid: BinGrid,
    /// Row by row: columns and rows, the ends excluded; empty bins are empty.
    held: Vec<[u32; 4]>,
}

const EMPTY: [u32; 4] = [u32::MAX, 0, u32::MAX, 0];

impl Bins {
    fn new(points: &[DVec2], columns: u32) -> Self {
        let columns = columns.max(1) as usize;
        let size = [columns, points.len().div_ceil(columns).max(1)];
        let mut bins = Self {
            grid: BinGrid::new(points, size),
            held: vec![EMPTY; size[0] * size[1]],
        };
        let seen = points.iter().enumerate();
        for (place, &point) in seen.filter(|(_, point)| point.is_finite()) {
            let [x, y] = bins.grid.bin(bins.grid.even(point));
            let (column, row) = ((place % columns) as u32, (place / columns) as u32);
            let held = &mut bins.held[y * size[0] + x];
            *held = [
                held[0].min(column),
                held[1].max(column + 1),
                held[2].min(row),
                held[3].max(row + 1),
            ];
        }
        bins
    }

    fn near(&self, corners: &[DVec2]) -> (Range<u32>, Range<u32>) {
        let ([x0, y0], [x1, y1]) = self.grid.around(corners);
        let columns = self.grid.size[0];
        let mut all = EMPTY;
        for y in y0..=y1 {
            for held in &self.held[y * columns + x0..=y * columns + x1] {
                all = [
                    all[0].min(held[0]),
                    all[1].max(held[1]),
                    all[2].min(held[2]),
                    all[3].max(held[3]),
                ];
            }
        }
        match all[0] < all[1] {
            true => (all[0]..all[1], all[2]..all[3]),
            false => (0..0, 0..0),
        }
    }
}

/// The box of no points.
const NOTHING: [DVec2; 2] = [DVec2::INFINITY, DVec2::NEG_INFINITY];

/// The box around those points that are finite.
fn around(points: &[DVec2]) -> [DVec2; 2] {
    let seen = points.iter().filter(|point| point.is_finite());
    seen.fold(NOTHING, |[min, max], &point| {
        [min.min(point), max.max(point)]
    })
}

/// The ray of a point of the plane, in camera axes.
pub(super) fn ray(point: DVec2) -> DVec3 {
    point.extend(1.0)
}
