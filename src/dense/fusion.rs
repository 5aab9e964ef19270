//! Depth maps -> one cloud: places that several photos agree on become a point each.
//!
//! A point is the mean of the photos' places, weighted by how well each knows its depth, as Galliani 2015
//! and Schönberger 2016 fuse; the pixels that went into it make no other point.
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
use crate::jobs::Progress;
use crate::view::{Photos, View};

/// Other photos that have to agree, where as many were asked.
const LEAST_SUPPORTS: usize = 2;
/// Every so many pixels are looked at for the noise.
const EVERY: usize = 7;

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

/// A point on its way.
struct Point {
    point: DVec3,
    pixel: usize,
    views: u8,
    /// One over the variance for a noise of one pixel.
    information: f64,
    /// The other photos' pixels that went into it.
    used: Vec<(usize, usize)>,
}

/// Fuses the depth maps of all views; colours come from the photos.
///
/// # Errors
/// Where a photo cannot be read, where nothing agrees, or where the work was cancelled.
pub fn fuse(
    views: &[View],
    maps: &[Option<DepthMap>],
    photos: &dyn Photos,
    progress: &Progress,
) -> Result<Fused, Fault> {
    progress.stage("one cloud from all depths");
    let noise = noise(views, maps);
    let mut fused = Fused {
        noise_pixels: noise,
        ..Fused::default()
    };
    let mut used: Vec<Vec<bool>> = maps
        .iter()
        .map(|map| vec![false; map.as_ref().map_or(0, |map| map.depths.len())])
        .collect();
    for (which, map) in maps.iter().enumerate() {
        if let (Some(map), Some(view)) = (map, views.get(which)) {
            let agreements = agreements(views, maps, which);
            let points: Vec<Point> = (0..map.depths.len())
                .into_par_iter()
                .filter(|at| !used[which][*at])
                .filter_map(|at| point(view, map, &agreements, &used, at))
                .collect();
            let photo = photos.photo(which)?;
            for point in points {
                for (other, at) in &point.used {
                    used[*other][*at] = true;
                }
                let pixel = center(map, point.pixel) * f64::from(1_u32 << map.halvings.min(31));
                let x = (pixel.x as u32).min(photo.width().saturating_sub(1));
                let y = (pixel.y as u32).min(photo.height().saturating_sub(1));
                fused.points.push(point.point);
                fused.colors.push(photo.get_pixel(x, y).0);
                fused.views.push(point.views);
                let error = noise / point.information.sqrt();
                fused.standard_errors.push(error as f32);
            }
        }
        progress.advance(which as u64 + 1, maps.len() as u64)?;
    }
    if fused.points.is_empty() {
        return Err(Fault::new(
            "no place has the same depth in several photos",
            "take photos that overlap more, and are sharp",
        ));
    }
    Ok(fused)
}

pub(crate) fn agreements<'a>(
    views: &'a [View],
    maps: &'a [Option<DepthMap>],
    which: usize,
) -> Vec<Agreement<'a>> {
    let neighbours = maps.get(which).and_then(Option::as_ref);
    let neighbours = neighbours.map_or(&[][..], |map| &map.neighbours);
    neighbours
        .iter()
        .filter_map(|other| Agreement::of(views, maps, which, *other))
        .collect()
}

fn point(
    view: &View,
    map: &DepthMap,
    agreements: &[Agreement<'_>],
    used: &[Vec<bool>],
    at: usize,
) -> Option<Point> {
    let depth = f64::from(map.depths[at]);
    let direction = map.camera.direction_undistorted(center(map, at));
    let information = |depth: f64, per_pixel: f64| (depth * depth * per_pixel).powi(-2);
    let own = information(depth, per_pixel(map));
    let mut sum = (view.pose.rotation * direction) * depth * own;
    let mut total = own;
    let mut others = Vec::new();
    for agreement in agreements {
        if let Some(seen) = agreement.look(map, at).filter(|seen| seen.is_same)
            && !used[agreement.other][seen.at]
        {
            let theirs = information(seen.theirs.recip(), agreement.per_pixel());
            // From the camera's centre: world coordinates may be large.
            sum += (seen.point - view.pose.center) * theirs;
            total += theirs;
            others.push((agreement.other, seen.at));
        }
    }
    (others.len() >= LEAST_SUPPORTS.min(agreements.len().max(1))).then(|| Point {
        point: view.pose.center + sum / total,
        pixel: at,
        views: u8::try_from(others.len() + 1).unwrap_or(u8::MAX),
        information: total,
        used: others,
    })
}

/// The matching noise in pixels, one standard deviation, from how far agreeing maps are apart.
fn noise(views: &[View], maps: &[Option<DepthMap>]) -> f64 {
    let mut apart: Vec<f64> = Vec::new();
    for (which, map) in maps.iter().enumerate() {
        let Some(map) = map else { continue };
        for agreement in agreements(views, maps, which) {
            let differences = (0..map.depths.len()).step_by(EVERY).filter_map(|at| {
                let seen = agreement.look(map, at).filter(|seen| seen.is_same)?;
                // Our inverse depth's noise as they see it: dq' = dq z^2 / z'^2.
                let depth = f64::from(map.depths[at]);
                let ours = per_pixel(map) * (depth * seen.ours).powi(2);
                let one = ours.hypot(agreement.per_pixel());
                Some((seen.theirs - seen.ours).abs() / one)
            });
            apart.extend(differences);
        }
    }
    if apart.is_empty() {
        return 0.0;
    }
    let middle = apart.len() / 2;
    let (_, median, _) = apart.select_nth_unstable_by(middle, f64::total_cmp);
    *median / 0.6745
}
