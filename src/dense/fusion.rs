//! Depth maps -> one cloud: places that several photos agree on become a point each.
//!
//! A point is the mean of the photos' places, weighted by how well each knows its depth, as Galliani 2015
//! and Schönberger 2016 fuse; the pixels that went into it make no other point.
//!
//! # How many points
//!
//! The depths of neighbouring pixels rest on nearly the same windows, and more points than a surface needs cost
//! time wherever it is used. So the maps are cut into cells of k by k pixels, k the smallest with which all maps
//! together have at most [`MOST_CELLS`] cells, and a cell makes one point at most: of its pixel with the least
//! cost on which enough photos agree. What went into a point uses up whole cells, so that a place that n
//! photos show has one point, not n. Nothing is drawn at random. Up to 20 megapixels together k is 1.
//!
//! What fewer than three photos have the same (two, where a photo was compared with one alone) makes no point. With two there are
//! half as many points more, and the surface is not nearer to the true one (docs/reconstruct.md).
//!
//! # The standard error
//!
//! A pixel of matching noise moves the inverse depth of photo k by `per_pixel` p_k (geometry: focal
//! lengths and bases), so its depth z_k by z_k^2 p_k. How many pixels the noise has is measured: half of all
//! agreeing pairs of inverse depths differ by less than 0.6745 times its root of sums. A point of n photos
//! then has
//!
//! ```text
//! standard error = noise / sqrt(sum over k of 1 / (z_k^2 p_k)^2)
//! ```
//!
//! along the mean viewing ray, one standard deviation. It takes the photos' depths as independent; they share
//! pixels of each other, so that the true error may be larger by up to the square root of n. Errors of the poses
//! and of the camera are not in it.

use glam::DVec3;
use rayon::prelude::*;

use crate::agreement::{Agreement, center, per_pixel};
use crate::depth_map::DepthMap;
use crate::fault::Fault;
use crate::found_maps::DepthMaps;
use crate::jobs::Progress;
use crate::view::{Photos, View};

/// Other photos that have to agree, where as many were asked.
const LEAST_SUPPORTS: usize = 2;
/// The most cells of all maps together; a few of them make one point.
const MOST_CELLS: u64 = 20_000_000;
/// Every so many pixels are looked at for the noise, or every so many more that there are about as many
/// altogether.
const EVERY: usize = 7;
const LOOKED_AT: u64 = 1_000_000;
/// Cells between two looks whether the work was cancelled.
const AT_ONCE: usize = 100_000;

/// A fused cloud; the lists are as long as each other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fused {
    /// In the world.
    pub points: Vec<DVec3>,
    /// Red, green, blue of the photo that began the point.
    pub colors: Vec<[u8; 3]>,
    /// How many photos' depths went into each.
    pub views: Vec<u8>,
    /// Along the mean viewing ray, in the world's unit; see the module's header.
    pub standard_errors: Vec<f32>,
    /// The matching noise that was found, in pixels of the depth maps.
    pub noise_pixels: f64,
}

impl Fused {
    /// One standard deviation for all points along their viewing rays, in the world's unit: the root mean
    /// square of their standard errors, each as if the depths of its photos erred alike, which is the most that it
    /// can be (the header says why). `None` of no points.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        let each = self.standard_errors.iter().zip(&self.views);
        let squares: f64 = each
            .map(|(error, views)| f64::from(*error).powi(2) * f64::from(*views))
            .sum();
        (!self.points.is_empty()).then(|| (squares / self.points.len() as f64).sqrt())
    }
}

/// A point on its way.
struct Point {
    point: DVec3,
    pixel: usize,
    views: u8,
    /// One over the variance for a noise of one pixel.
    information: f64,
    /// The other photos' cells that went into it.
    used: Vec<(usize, usize)>,
}

/// Fuses the depth maps of all views; colours come from the photos. No points where nothing agrees.
///
/// # Errors
/// Where a photo cannot be read, a map is lost, or the work was cancelled.
pub fn fuse(
    maps: &DepthMaps<'_>,
    photos: &dyn Photos,
    progress: &Progress,
) -> Result<Fused, Fault> {
    let mut side = 1;
    while maps.pixels() / (side * side) > MOST_CELLS {
        side += 1;
    }
    fuse_cells(maps, photos, side as usize, progress)
}

/// The same with cells of so many pixels along each side.
pub(crate) fn fuse_cells(
    maps: &DepthMaps<'_>,
    photos: &dyn Photos,
    side: usize,
    progress: &Progress,
) -> Result<Fused, Fault> {
    let noise = noise(maps, progress)?;
    progress.stage(format!(
        "one cloud from the depths of {} photos",
        maps.len()
    ));
    let mut fused = Fused {
        noise_pixels: noise,
        ..Fused::default()
    };
    let grids: Vec<Grid> = (0..maps.len())
        .map(|which| Grid::of(maps.size(which), side))
        .collect();
    let mut used: Vec<Vec<bool>> = grids
        .iter()
        .map(|grid| vec![false; grid.columns * grid.rows])
        .collect();
    for which in 0..maps.len() {
        progress.advance(which as u64, maps.len() as u64)?;
        let Some(map) = maps.get(which)? else {
            continue;
        };
        let around = Around {
            view: &maps.views[which],
            map: &map,
            agreements: maps.agreements(which)?,
            grids: &grids,
            grid: &grids[which],
            used: &used,
        };
        let cells = used[which].len();
        let mut points: Vec<Point> = Vec::new();
        for begin in (0..cells).step_by(AT_ONCE) {
            progress.advance(which as u64, maps.len() as u64)?;
            let some = (begin..cells.min(begin + AT_ONCE)).into_par_iter();
            let some = some
                .filter(|cell| !used[which][*cell])
                .filter_map(|cell| around.best(cell));
            points.extend(some.collect::<Vec<_>>());
        }
        let photo = photos.photo(which)?;
        for point in points {
            for (other, cell) in &point.used {
                used[*other][*cell] = true;
            }
            let pixel = center(&map, point.pixel) * f64::from(1_u32 << map.halvings.min(31));
            let x = (pixel.x as u32).min(photo.width().saturating_sub(1));
            let y = (pixel.y as u32).min(photo.height().saturating_sub(1));
            fused.points.push(point.point);
            fused.colors.push(photo.get_pixel(x, y).0);
            fused.views.push(point.views);
            let error = noise / point.information.sqrt();
            fused.standard_errors.push(error as f32);
        }
    }
    Ok(fused)
}

/// A map's cells.
struct Grid {
    side: usize,
    /// Pixels of a row.
    width: usize,
    height: usize,
    columns: usize,
    rows: usize,
}

impl Grid {
    fn of([width, height]: [usize; 2], side: usize) -> Self {
        Self {
            side,
            width,
            height,
            columns: width.div_ceil(side),
            rows: height.div_ceil(side),
        }
    }

    /// The cell of a pixel, both row by row.
    fn cell(&self, pixel: usize) -> usize {
        let (x, y) = (pixel % self.width, pixel / self.width);
        y / self.side * self.columns + x / self.side
    }

    /// The pixels of a cell.
    fn pixels(&self, cell: usize) -> Vec<usize> {
        let (left, top) = (
            cell % self.columns * self.side,
            cell / self.columns * self.side,
        );
        let (right, below) = (
            self.width.min(left + self.side),
            self.height.min(top + self.side),
        );
        (top..below)
            .flat_map(|y| (left..right).map(move |x| y * self.width + x))
            .collect()
    }
}

/// A map with those that it agrees with.
struct Around<'a> {
    view: &'a View,
    map: &'a DepthMap,
    agreements: Vec<Agreement<'a>>,
    grids: &'a [Grid],
    grid: &'a Grid,
    used: &'a [Vec<bool>],
}

impl Around<'_> {
    /// The point of the cheapest pixel of a cell that has one.
    fn best(&self, cell: usize) -> Option<Point> {
        let mut pixels = self.grid.pixels(cell);
        let costs = &self.map.costs;
        pixels.sort_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        pixels.into_iter().find_map(|pixel| self.point(pixel))
    }

    fn point(&self, at: usize) -> Option<Point> {
        let (view, map) = (self.view, self.map);
        let depth = f64::from(map.depths[at]);
        let direction = map.camera.direction_undistorted(center(map, at));
        let information = |depth: f64, per_pixel: f64| (depth * depth * per_pixel).powi(-2);
        let own = information(depth, per_pixel(map));
        let mut sum = (view.pose.rotation * direction) * depth * own;
        let mut total = own;
        let mut used = Vec::new();
        for agreement in &self.agreements {
            if let Some(seen) = agreement.look(map, at).filter(|seen| seen.is_same) {
                let cell = self.grids[agreement.other].cell(seen.at);
                if self.used[agreement.other][cell] {
                    continue;
                }
                let theirs = information(seen.theirs.recip(), agreement.per_pixel());
                // From the camera's centre: world coordinates may be large.
                sum += (seen.point - view.pose.center) * theirs;
                total += theirs;
                used.push((agreement.other, cell));
            }
        }
        (used.len() >= LEAST_SUPPORTS.min(self.agreements.len().max(1))).then(|| Point {
            point: view.pose.center + sum / total,
            pixel: at,
            views: u8::try_from(used.len() + 1).unwrap_or(u8::MAX),
            information: total,
            used,
        })
    }
}

/// The matching noise in pixels, one standard deviation, from how far agreeing maps are apart.
fn noise(maps: &DepthMaps<'_>, progress: &Progress) -> Result<f64, Fault> {
    progress.stage(format!("how sure the depths of {} photos are", maps.len()));
    // Odd, lest it be a part of the width and all lie in a few columns.
    let every = EVERY.max(usize::try_from(maps.pixels() / LOOKED_AT).unwrap_or(usize::MAX)) | 1;
    let mut apart: Vec<f64> = Vec::new();
    for which in 0..maps.len() {
        progress.advance(which as u64, maps.len() as u64)?;
        let Some(map) = maps.get(which)? else {
            continue;
        };
        for agreement in maps.agreements(which)? {
            let differences = (0..map.depths.len()).step_by(every).filter_map(|at| {
                let seen = agreement.look(&map, at).filter(|seen| seen.is_same)?;
                // Our inverse depth's noise as they see it: dq' = dq z^2 / z'^2.
                let depth = f64::from(map.depths[at]);
                let ours = per_pixel(&map) * (depth * seen.ours).powi(2);
                let one = ours.hypot(agreement.per_pixel());
                Some((seen.theirs - seen.ours).abs() / one)
            });
            apart.extend(differences);
        }
    }
    if apart.is_empty() {
        return Ok(0.0);
    }
    let middle = apart.len() / 2;
    let (_, median, _) = apart.select_nth_unstable_by(middle, f64::total_cmp);
    Ok(*median / 0.6745)
}
